#include "bench/rl/training_scene.h"

#include <filesystem>
#include <string>

#include "assets/semantic_model.h"
#include "core/files.h"
#include "core/progress.h"
#include "workflows/library/library.h"

namespace simwright {
namespace {

constexpr const char* kProgram = R"(def compute_reward(env):
    handle = env.get_pose_by_link_name("microwave", "handle_0")
    gripper = env.get_robot_gripper_pose()
    reach = torch.norm(gripper - handle, dim=-1)
    state = env.get_state_by_joint_name("microwave", "door_joint")
    limits = env.get_limits_by_joint_name("microwave", "door_joint")
    moved = (state - limits["lower"]) / (limits["upper"] - limits["lower"])
    reward = 2.0 * torch.clamp(moved, max=1.0) - reach
    success = moved >= 0.7
    return reward, success
)";

void Place(const std::string& kind, const Eigen::Vector3d& position, bool fixed,
           const std::filesystem::path& folder, skills::SkillSubtask* scene) {
  workflows::LibraryOptions options;
  options.kind = kind;
  options.seed = 2;
  options.check = false;
  core::Progress progress;
  const auto made = workflows::MakeLibrary(options, folder, &progress);
  assets::SemanticModel model = assets::ReadSemanticModel(made.front().folder);
  model.name = kind;
  scene->assets.push_back(std::move(model));
  tasks::AssetPlacement placement;
  placement.asset = kind;
  placement.fixed = fixed;
  placement.world_from_asset.translation() = position;
  scene->subtask.start.placements.push_back(placement);
}

}  // namespace

skills::SkillSubtask MicrowaveAndCup() {
  const core::TemporaryFolder folder;
  skills::SkillSubtask scene;
  scene.subtask.name = "open_microwave";
  scene.subtask.program = kProgram;
  Place("microwave", {0.675, 0.2, 0.0}, true, folder.path(), &scene);
  Place("cup", {0.45, -0.25, 0.0}, false, folder.path(), &scene);
  return scene;
}

}  // namespace simwright
