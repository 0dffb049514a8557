// URDFs from anywhere: core::Error, or a model whose joints fit its links and that tasks can be
// made for, nothing else.
#include <cstdint>
#include <cstdlib>

#include "assets/joint_poses.h"
#include "assets/urdf_reader.h"
#include "core/error.h"
#include "core/parallel.h"
#include "tasks/rules/rule_tasks.h"
#include "tasks/world_state.h"
#include "temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const simwright::fuzz::TemporaryFile file("input.urdf");
  try {
    const simwright::assets::UrdfModel model = simwright::assets::ReadUrdf(file.Write(data, size));
    if (model.links.size() != model.joints.size() + 1) std::abort();
    if (simwright::assets::LinkPosesAtZero(model).size() != model.links.size()) std::abort();
    simwright::core::SetThreadCount(1);
    simwright::assets::SemanticModel named;
    named.name = "thing";
    named.model = model;
    const auto scene = simwright::tasks::MakeWorldModel({named});
    for (const auto& task : simwright::tasks::GenerateTasksByRules(scene, {1, 1}).tasks) {
      if (!task.valid()) std::abort();
    }
  } catch (const simwright::core::Error&) {
  }
  return 0;
}
