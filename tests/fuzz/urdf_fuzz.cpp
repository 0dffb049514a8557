// URDFs from anywhere: core::Error or a model whose joints fit its links, nothing else.
#include <cstdint>
#include <cstdlib>

#include "assets/joint_poses.h"
#include "assets/urdf_reader.h"
#include "core/error.h"
#include "temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const simwright::fuzz::TemporaryFile file("input.urdf");
  try {
    const simwright::assets::UrdfModel model = simwright::assets::ReadUrdf(file.Write(data, size));
    if (model.links.size() != model.joints.size() + 1) std::abort();
    if (simwright::assets::LinkPosesAtZero(model).size() != model.links.size()) std::abort();
  } catch (const simwright::core::Error&) {
  }
  return 0;
}
