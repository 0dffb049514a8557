#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "twin/table_scene.h"

namespace simwright::twin {

inline constexpr std::int16_t kBackgroundLabel = -1, kTableLabel = -2;

// A photo-like picture of a table with what each pixel shows.
struct TablePicture {
  core::Image color;                // RGB, sRGB
  std::vector<std::int16_t> label;  // (height x width) index of the object, or one of the above
  std::vector<float> depth;         // (height x width) m along the optical axis, 0: background
};

// The rays of a picture. Those of a pixel's samples are spread evenly among each other.
struct TablePictureRays {
  int samples = 3;  // squared is the number of rays a pixel, 1 to 4
  int sky = 4;      // a sample, towards the sky
  int sun = 2;      // a sample, towards the sun
};

// Renders a scene: sky light with ambient occlusion, a sun with soft shadows, highlights. The label
// and depth of a pixel are those of most of its samples, and of the first of these.
TablePicture RenderTable(const TableScene& scene, const TableSceneSources& sources,
                         const TablePictureRays& rays, std::uint64_t seed);

}  // namespace simwright::twin
