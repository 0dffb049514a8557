// Steps four episodes of "pick it up" with the scripted expert: step_environment ASSET_FOLDER
#include <cstdio>
#include <numeric>

#include <simwright/assets/semantic_model.h>
#include <simwright/core/error.h>
#include <simwright/robot/panda_model.h>
#include <simwright/skills/skill_environment.h>

namespace skills = simwright::skills;

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    skills::SkillSubtask scene;
    scene.assets = {simwright::assets::ReadSemanticModel(argv[1])};
    const std::string name = scene.assets[0].name;
    scene.subtask.name = "pick_up_" + name;
    scene.subtask.program =
        "def compute_reward(env):\n"
        "    position = env.get_position('" +
        name +
        "')\n"
        "    missing = torch.norm(env.get_goal_pose() - position, dim=-1)\n"
        "    grasped = env.check_grasped('" +
        name +
        "')\n"
        "    return -missing, torch.logical_and(grasped, missing <= 0.03)\n";
    simwright::tasks::AssetPlacement placement;
    placement.asset = name;
    placement.world_from_asset.translation() = Eigen::Vector3d(0.5, 0.0, 0.0);
    scene.subtask.start.placements = {placement};
    scene.subtask.goal = Eigen::Vector3d(0.5, 0.0, 0.2);
    const auto skill = skills::MakeSkill(simwright::robot::Panda(false), {scene});
    skills::SkillEnvironment environment(skill, 4);
    simwright::rl::Rows observations, actions(4, environment.action_size());
    simwright::rl::StepBatch batch;
    environment.Reset(1, &observations);
    int ended = 0, succeeded = 0;
    for (int step = 0; step < 400 && ended < 4; ++step) {
      environment.Demonstrate(&actions);
      environment.Step(actions, &batch);
      for (int i = 0; i < 4; ++i) {
        const bool end = batch.terminated[i] != 0 || batch.truncated[i] != 0;
        ended += end;
        succeeded += end && batch.success[i] != 0;
      }
    }
    std::printf("%d observations, %d actions; %d of %d episodes succeeded\n",
                environment.observation_size(), environment.action_size(), succeeded, ended);
    return succeeded > 0 ? 0 : 1;
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
