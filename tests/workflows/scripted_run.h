#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/files.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "skills/observation.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_rollout.h"
#include "workflows/tasks/task_making.h"

namespace simwright::workflows {

// The folder of a run whose policies were not trained but written down: networks that know what to
// do with a block. They see and act as trained ones do.

constexpr const char* kBlock = R"(<robot name="block"><link name="base">
  <visual><origin xyz="0 0 0.04"/><geometry><box size="0.05 0.05 0.08"/></geometry>
    <material name="red"><color rgba="0.8 0.2 0.15 1"/></material></visual>
  <collision><origin xyz="0 0 0.04"/><geometry><box size="0.05 0.05 0.08"/></geometry></collision>
  <inertial><origin xyz="0 0 0.04"/><mass value="0.2"/>
    <inertia ixx="1.48e-4" iyy="1.48e-4" izz="8.3e-5" ixy="0" ixz="0" iyz="0"/></inertial>
</link></robot>
)";

// f(x) = k |x| + exp(-k |x|) - 1, the smooth distance that two ELUs make of one number.
constexpr float kSteep = 20.0f;

// A network of three layers: the distances of three of its inputs, from `first` on, then two gates
// over their sums, then an action of 7 numbers.
class GatedPolicy {
 public:
  GatedPolicy(int inputs, int first, int silencer) {
    distances_.weights = Eigen::MatrixXf::Zero(inputs, 7);
    distances_.bias = Eigen::RowVectorXf::Zero(7);
    for (int i = 0; i < 3; ++i) {
      distances_.weights(first + i, 2 * i) = kSteep;
      distances_.weights(first + i, 2 * i + 1) = -kSteep;
    }
    if (silencer >= 0) distances_.weights(silencer, 6) = 1.0f;
    gates_.weights = Eigen::MatrixXf::Zero(7, 2);
    gates_.bias = Eigen::RowVectorXf::Zero(2);
    action_.weights = Eigen::MatrixXf::Zero(2, 7);
    action_.bias = Eigen::RowVectorXf::Zero(7);
  }

  // Gate `g` is -1 while the first `axes` distances sum to less than `threshold`, or the silencing
  // input is 1, and rises far above it beyond.
  void SetGate(int g, int axes, float steepness, float threshold) {
    gates_.weights.block(0, g, 2 * axes, 1).setConstant(steepness);
    gates_.weights(6, g) = -1000.0f;
    gates_.bias[g] = -steepness * threshold;
  }
  // Action `a` is `scale` times (gate + shift).
  void SetAction(int a, int g, float scale, float shift) {
    action_.weights(g, a) = scale;
    action_.bias[a] = scale * shift;
  }

  rl::Policy Make() const {
    const auto inputs = static_cast<int>(distances_.weights.rows());
    return {rl::ObservationScale(inputs),
            rl::Mlp({distances_, gates_, action_}, rl::Activation::kElu),
            Eigen::RowVectorXf::Constant(7, 0.1f)};
  }

 private:
  rl::Mlp::Layer distances_, gates_, action_;
};

// The observation's layout (rl/observation.cpp): the tool's pose in the target's frame follows the
// arm's positions and speeds, in tenths of a metre; 22 numbers later comes a flag that the target
// is the destination; the displacement to the destination precedes the last action.
inline rl::Policy PickPolicy(int observation, int joints) {
  GatedPolicy policy(observation, 2 * joints, 2 * joints + 22);
  policy.SetGate(0, 2, 2.0f, 3.0f);  // beside the object: stay above it
  policy.SetAction(2, 0, -0.6f, 1.0f);
  policy.SetGate(1, 3, 4.0f, 2.5f);  // not at the object: fingers open
  policy.SetAction(6, 1, 1.0f, 0.0f);
  return policy.Make();
}

inline rl::Policy PutDownPolicy(int observation) {
  GatedPolicy policy(observation, observation - 10, -1);
  policy.SetGate(1, 3, 4.0f, 2.0f);  // not at the destination: fingers closed
  policy.SetAction(6, 1, -1.0f, 0.0f);
  return policy.Make();
}

// Makes the block, its tasks and a run of `task` below `folder`; returns the run's folder.
inline std::filesystem::path WriteScriptedRun(const std::filesystem::path& folder,
                                              const std::string& task) {
  const std::filesystem::path assets = folder / "assets" / "block";
  std::filesystem::create_directories(assets);
  core::WriteFile(assets / "block.urdf", kBlock);
  TasksRequest request;
  request.assets = {assets.string()};
  request.output = folder / "tasks.json";
  request.force = true;
  core::Progress silent;
  const TasksReport made = MakeTasks(request, &silent);
  SkillRun run;
  run.folder = folder / task;
  run.set = ChooseTasks(made.set, {task}, "tasks.json");
  WriteRun(run);
  for (const RunSkill& skill : PrepareSkills(run)) {
    const skills::SkillVariant& variant = skill.skill->variants.front();
    const int observation = skills::Observer(*skill.skill, variant).size();
    const rl::Policy policy = variant.starts_held
                                  ? PutDownPolicy(observation)
                                  : PickPolicy(observation, skill.skill->robot->arm.size());
    std::filesystem::create_directories(skill.folder);
    rl::WritePolicy(policy, skill.folder / rl::kPolicyFile);
  }
  return run.folder;
}

// A run that picks up the block, one that also puts it down elsewhere, and a folder per test.
class ScriptedRuns : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new core::TemporaryFolder;
    WriteScriptedRun(shared_->path(), "pick_up_block");
    WriteScriptedRun(shared_->path(), "move_block");
  }
  static void TearDownTestSuite() { delete shared_; }

  static std::string Pick() { return (shared_->path() / "pick_up_block").string(); }
  static std::string Move() { return (shared_->path() / "move_block").string(); }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  inline static core::TemporaryFolder* shared_ = nullptr;
  core::TemporaryFolder folder_;
};

}  // namespace simwright::workflows
