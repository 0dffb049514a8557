#include "twin/detector_example.h"

#include <cmath>

#include "twin/table_camera.h"
#include "twin/table_picture.h"

namespace simwright::twin {

std::array<float, 4> CameraNumbers(const core::Camera& camera) {
  const TableCamera numbers = TableCameraOf(camera);
  return {static_cast<float>(numbers.elevation), static_cast<float>(numbers.roll),
          static_cast<float>(std::log(numbers.focal)),
          static_cast<float>(std::log(numbers.height))};
}

DetectorExample MakeDetectorExample(const TableSceneSources& sources,
                                    const TableSceneOptions& options, std::uint64_t seed) {
  core::Rng rng = core::StreamRng(seed, 0x7ab1e);
  const TableScene scene = SampleTableScene(sources, options, &rng);
  const TablePicture picture = RenderTable(scene, sources, {2, 1, 1}, seed);
  DetectorExample example;
  example.picture = picture.color.pixels;
  example.object.reserve(picture.label.size());
  for (const std::int16_t label : picture.label) {
    example.object.push_back(label >= 0 ? static_cast<std::uint8_t>(label + 1) : std::uint8_t{0});
  }
  example.camera = CameraNumbers(scene.camera);
  return example;
}

}  // namespace simwright::twin
