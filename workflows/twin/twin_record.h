#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera.h"

namespace simwright::workflows {

// The origin of an object's asset.
enum class TwinSource {
  kFitted,     // a kind of the library, fitted to the photo
  kRetrieved,  // an asset of the user
  kLifted      // reconstructed from the photo
};

// An object of a twin as twin.json holds it.
struct TwinObject {
  std::string name;  // its asset folder, below the twin's folder assets/
  TwinSource source = TwinSource::kFitted;
  std::string kind;  // of the library: "mug"; of a retrieved one, the name of the user's asset
  std::string category;
  bool articulated = false;
  std::map<std::string, double> joints;  // positions in the photo, rad or m; others are 0
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();  // settled
  Eigen::Vector3d size{0, 0, 0};                                        // m
  double confidence = 0.0;                                              // [0, 1]
  double outline_iou = 0.0;                                             // with the photo
  // One standard deviation: m in the plane, rad, and of the logarithm of the size.
  double position_error = 0.0, yaw_error = 0.0, size_error = 0.0;
  double settled = 0.0;      // m that physics moved it
  Eigen::AlignedBox2d box;   // pixels of the photo
  std::vector<int> seen_in;  // the photos that show it, from 0, if there are several; its box and
                             // its paint are of one of them
};

// The scene of a photo: metres, z up, the table is z = 0, the camera looks towards +y.
struct TwinRecord {
  std::string photo;  // file name
  core::Camera camera;
  double log_scale_error = 0.0;  // of all lengths together
  std::vector<TwinObject> objects;
  bool stands = false;       // no object moves in physics
  double penetration = 0.0;  // m, the deepest
};

// Returns twin.json (docs/formats.md), a JSON file of poses with more members.
std::string TwinJson(const TwinRecord& record);

// Reads the record of a twin's folder. Throws core::Error if it is missing or damaged, a number is
// not finite, or an asset lies outside of the folder.
TwinRecord ReadTwin(const std::filesystem::path& folder);

}  // namespace simwright::workflows
