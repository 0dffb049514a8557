#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/camera.h"

namespace simwright::assets {

// Reads cameras, keyed by the file names of their photos, from JSON:
//   {"cameras": [{"photo": "a.jpg", "width": 640, "height": 480, "fx": 600, "fy": 600,
//                 "cx": 320, "cy": 240, "world_from_camera": [[r, r, r, x], [r, r, r, y],
//                 [r, r, r, z], [0, 0, 0, 1]]}, ...]}
// Lengths are in pixels and metres. The world's z axis points up; a camera looks along its +z, with
// x right and y down (OpenCV). Throws core::Error, naming the camera and the value, for a missing
// or non-finite value or an invalid rotation.
std::map<std::string, core::Camera> ReadCameraFile(const std::filesystem::path& path);

// Writes cameras in that form, keyed by the file names of their photos.
void WriteCameraFile(const std::map<std::string, core::Camera>& cameras,
                     const std::filesystem::path& path);

}  // namespace simwright::assets
