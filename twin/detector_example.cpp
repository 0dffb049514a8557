#include "twin/detector_example.h"

#include "twin/table_picture.h"

namespace simwright::twin {

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
  return example;
}

}  // namespace simwright::twin
