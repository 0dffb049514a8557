#include "workflows/skills/trajectory_replay.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "skills/skill_world.h"
#include "skills/start_pool.h"
#include "skills/variant_reward.h"

namespace simwright::workflows {
namespace {

constexpr double kTimeSlack = 1e-6;  // s

// The positions of a trajectory, interpolated between its samples and constant before the first and
// after the last.
class Commands {
 public:
  Commands(const robot::JointTrajectory& trajectory, const robot::RobotModel& robot,
           const std::string& where)
      : trajectory_(trajectory) {
    for (const std::string& name : MotionJointsOf(robot).names) {
      const auto found = std::find(trajectory.joints.begin(), trajectory.joints.end(), name);
      if (found == trajectory.joints.end()) {
        throw core::Error("lacks the joint '" + name + "' of the robot '" + robot.name + "'", where,
                          "give a trajectory of this robot");
      }
      columns_.push_back(found - trajectory.joints.begin());
    }
    if (trajectory.joints.size() > columns_.size()) {
      throw core::Error("moves " + std::to_string(trajectory.joints.size()) +
                            " joints, the robot '" + robot.name + "' has " +
                            std::to_string(columns_.size()),
                        where, "give a trajectory of this robot");
    }
  }

  // Returns (J + 1) positions: the arm's, then the gripper's first joint's.
  Eigen::VectorXd At(double time) const {
    const std::vector<double>& times = trajectory_.times;
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    const auto next = std::min<Eigen::Index>(after - times.begin(), trajectory_.size() - 1);
    const Eigen::Index last = std::max<Eigen::Index>(after - times.begin() - 1, 0);
    const double span = times[static_cast<size_t>(next)] - times[static_cast<size_t>(last)];
    const double share =
        span > 0.0 ? std::clamp((time - times[static_cast<size_t>(last)]) / span, 0.0, 1.0) : 0.0;
    Eigen::VectorXd command(static_cast<Eigen::Index>(columns_.size()));
    for (Eigen::Index j = 0; j < command.size(); ++j) {
      const Eigen::Index column = columns_[static_cast<size_t>(j)];
      command[j] = (1.0 - share) * trajectory_.positions(last, column) +
                   share * trajectory_.positions(next, column);
    }
    return command;
  }

 private:
  const robot::JointTrajectory& trajectory_;
  std::vector<Eigen::Index> columns_;
};

// The world of one subtask, driven step by step.
class SubtaskReplay {
 public:
  SubtaskReplay(const skills::Skill& skill, const skills::StartState& start)
      : options_(skill.options),
        variant_(skill.variants[static_cast<size_t>(start.variant)]),
        start_(start),
        world_(skill, start),
        reward_(variant_) {
    start_.state.goal = variant_.start.goal;
    world_.Read(&start_.state);
    previous_ = start_.state;
  }

  void Step(const Eigen::VectorXd& command) {
    world_.robot().Command(command.head(command.size() - 1), command[command.size() - 1]);
    world_.Advance();
    if (++steps_ % options_.control_steps != 0) return;
    world_.Read(&start_.state);
    held_ = world_.IsStateValid() && IsDone() ? held_ + 1 : 0;
    previous_ = start_.state;
  }

  // Returns true if success has held for hold_seconds until now.
  bool Succeeded() const {
    return held_ * options_.decision_seconds() >= options_.hold_seconds - kTimeSlack;
  }

  // Returns the current state as the start of the next subtask.
  skills::StartState End() {
    world_.Read(&start_.state);
    Eigen::VectorXd arm;
    world_.robot().Positions(&arm);
    start_.arm = start_.grasp_configuration = arm;
    start_.leader = world_.robot().Leader();
    start_.held = skills::HeldObject(variant_, start_.state);
    return start_;
  }

 private:
  bool IsDone() {
    bool done = false;
    reward_.Run(start_.state, previous_, options_.decision_seconds(), &done);
    return done;
  }

  const skills::SkillOptions& options_;
  const skills::SkillVariant& variant_;
  skills::StartState start_;  // its state is the current one
  skills::SkillWorld world_;
  skills::VariantReward reward_;
  tasks::WorldState previous_;  // at the previous decision
  int steps_ = 0, held_ = 0;
};

}  // namespace

SkillRun AtPhysicsRate(const SkillRun& run) {
  SkillRun fine = run;
  fine.options.control_rate *= run.options.substeps;
  fine.options.control_steps *= run.options.substeps;
  fine.options.substeps = 1;
  return fine;
}

std::vector<bool> ReplayTrajectory(const std::vector<RunSkill>& skills,
                                   const robot::JointTrajectory& trajectory,
                                   const SkillMetadata& metadata, const std::string& where) {
  const skills::Skill& first = *skills.front().evaluated;
  return ReplayTrajectoryFrom(skills, trajectory, metadata.times,
                              skills::ParseStart(metadata.start, first, where + ", note 'start'"),
                              where);
}

std::vector<bool> ReplayTrajectoryFrom(const std::vector<RunSkill>& skills,
                                       const robot::JointTrajectory& trajectory,
                                       const std::vector<SubtaskTimes>& times,
                                       skills::StartState start, const std::string& where) {
  const skills::Skill& first = *skills.front().evaluated;
  const Commands commands(trajectory, *first.robot, where);
  // The last command is held after the end (MotionOf).
  const double held = 2.0 * first.options.hold_seconds;
  if (trajectory.times.back() < times.back().end - held - 2.0 / first.options.control_rate) {
    throw core::Error("ends before its last subtask", where, "it is truncated: export it again");
  }
  std::vector<bool> successes;
  const double rate = first.options.control_rate;
  std::int64_t step = 0;
  for (size_t k = 0; k < skills.size(); ++k) {
    SubtaskReplay replay(*skills[k].evaluated, start);
    const auto drive_until = [&](double time) {
      for (; static_cast<double>(step + 1) / rate <= time + kTimeSlack; ++step) {
        replay.Step(commands.At(static_cast<double>(step + 1) / rate));
      }
    };
    drive_until(times[k].end);
    successes.push_back(replay.Succeeded());
    if (!successes.back()) break;
    if (k + 1 < skills.size()) drive_until(times[k + 1].begin);
    start = replay.End();
  }
  return successes;
}

}  // namespace simwright::workflows
