#pragma once

#include <string>
#include <vector>

#include "core/random.h"
#include "rl/policy.h"
#include "robot/joint_trajectory.h"
#include "transfer/transfer_world.h"
#include "workflows/skills/skill_metadata.h"
#include "workflows/skills/skill_run.h"

namespace simwright::transfer {

// A motion of a task: what a controller tracks, and when its subtasks begin and end.
struct TransferMotion {
  robot::JointTrajectory trajectory;
  std::vector<workflows::SubtaskTimes> times;  // by subtask
  std::string start;                           // skills::StartText, of the arm and the gripper
  std::string where;                           // names it in messages
};

// A task of a run, to be tried in other worlds than its own. Constant; thread-safe.
class TransferTask {
 public:
  // Prepares the run's task, without randomization. Throws core::Error if the run has several
  // tasks, and wherever workflows::PrepareSkills does.
  explicit TransferTask(const workflows::SkillRun& run);

  const workflows::SkillRun& run() const { return run_; }
  const tasks::Task& task() const { return run_.set.tasks.front(); }
  // Returns the task's own skills: objects exactly where it describes them.
  const std::vector<workflows::RunSkill>& skills() const { return skills_; }
  // Returns the world that the task describes.
  const TransferWorld& described() const { return described_; }

  // Returns true if the robot, driven by the positions of `motion` alone, does all subtasks in
  // `world`. Each is judged by its own reward program, as exported motions are. Throws core::Error
  // as workflows::ReplayTrajectoryFrom does, and if an object cannot be simulated.
  bool Replays(const TransferWorld& world, const TransferMotion& motion) const;
  // Returns true if the policies, by subtask (null: the scripted expert), do so; they observe where
  // the objects of `world` are.
  bool Acts(const TransferWorld& world, const std::vector<const rl::Policy*>& policies,
            core::Rng& rng) const;

 private:
  std::vector<workflows::RunSkill> SkillsIn(const TransferWorld& world,
                                            const std::vector<workflows::RunSkill>& skills) const;

  workflows::SkillRun run_;
  std::vector<workflows::RunSkill> skills_, fine_skills_;  // fine_skills_: at the physics rate
  TransferWorld described_;
};

}  // namespace simwright::transfer
