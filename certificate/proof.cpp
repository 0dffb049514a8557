#include "certificate/proof.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "certificate/planner.h"
#include "core/error.h"
#include "core/progress.h"
#include "sim/articulated_world.h"
#include "sim/driven_robot.h"

namespace simwright::certificate {
namespace {

using Eigen::Isometry3d;

constexpr double kSweepStep = 0.06;  // rad of any joint between configurations of the sweep
constexpr int kCheckSteps = 6;       // physics steps between checks of the others
constexpr double kGripForce = 0.5;   // N of each finger on a held object
constexpr double kAtRest = 1e-3;     // m that a placed object may move while it is watched

// Returns an upper bound of the displacement of any point of a body.
double DisplacementOf(const BodyModel& model, const Isometry3d& from, const Isometry3d& to) {
  const double turned = Eigen::AngleAxisd(from.linear().transpose() * to.linear()).angle();
  return (from * model.center_of_mass - to * model.center_of_mass).norm() +
         2.0 * std::sin(0.5 * turned) * model.radius;
}

// The positions of a trajectory, interpolated between its samples.
class TrajectoryCommands {
 public:
  TrajectoryCommands(const robot::JointTrajectory& trajectory, const robot::RobotModel& robot)
      : trajectory_(trajectory) {
    std::vector<std::string> names;
    for (const robot::ArmJoint& joint : robot.arm.joints) names.push_back(joint.name);
    names.push_back(robot.urdf.joints[static_cast<size_t>(robot.gripper.joints.front())].name);
    for (const std::string& name : names) {
      const auto found = std::find(trajectory.joints.begin(), trajectory.joints.end(), name);
      if (found == trajectory.joints.end()) {
        throw core::Error("the trajectory lacks the joint '" + name + "'", robot.name,
                          "give a trajectory of this robot");
      }
      columns_.push_back(found - trajectory.joints.begin());
    }
  }

  double duration() const { return trajectory_.times.back(); }
  // Returns the arm's positions and the gripper's first joint's. (J + 1)
  Eigen::VectorXd At(double time) {
    const auto last = static_cast<size_t>(trajectory_.size() - 1);
    while (at_ + 1 < last && trajectory_.times[at_ + 1] <= time) ++at_;
    const size_t next = std::min(at_ + 1, last);
    const double span = trajectory_.times[next] - trajectory_.times[at_];
    const double share =
        span > 0.0 ? std::clamp((time - trajectory_.times[at_]) / span, 0.0, 1.0) : 1.0;
    Eigen::VectorXd command(static_cast<Eigen::Index>(columns_.size()));
    for (Eigen::Index j = 0; j < command.size(); ++j) {
      const Eigen::Index column = columns_[static_cast<size_t>(j)];
      command[j] = (1.0 - share) * trajectory_.positions(static_cast<Eigen::Index>(at_), column) +
                   share * trajectory_.positions(static_cast<Eigen::Index>(next), column);
    }
    return command;
  }

 private:
  const robot::JointTrajectory& trajectory_;
  std::vector<Eigen::Index> columns_;
  size_t at_ = 0;  // times only increase
};

// Returns the flags of the bodies near the robot, or the object in its gripper, during a motion.
std::vector<char> NearBodies(const Planner& planner, const PlacedScene& scene, int target,
                             const Isometry3d& world_from_robot,
                             const robot::JointTrajectory& trajectory, double distance) {
  if (!std::isfinite(distance)) return std::vector<char>(scene.bodies.size(), 1);
  const PlacedBody& grasped = scene.bodies[static_cast<size_t>(target)];
  std::vector<char> near(scene.bodies.size(), 0);
  near[static_cast<size_t>(target)] = 1;
  const Obstacles obstacles(scene);
  RobotClearance arm(planner.shapes(), obstacles, world_from_robot, {});
  TrajectoryCommands commands(trajectory, planner.robot());
  Eigen::VectorXd last;
  bool gripped = false;
  for (const double time : trajectory.times) {
    const Eigen::VectorXd now = commands.At(time);
    const auto size = now.size() - 1;
    const bool moved =
        last.size() == 0 || (now - last).head(size).lpNorm<Eigen::Infinity>() > kSweepStep;
    const bool closing = last.size() > 0 && now[size] < last[size] - 1e-3;
    if (closing && !gripped) {  // the target follows the tool from here on
      const Isometry3d tool =
          world_from_robot * robot::ForwardKinematics(planner.robot().arm, now.head(size));
      const Eigen::Vector3d middle = grasped.world_from_body * grasped.model->box.center();
      if ((tool.translation() - middle).norm() < grasped.model->radius + 0.05) {
        arm.Hold(grasped.model.get(), tool.inverse() * grasped.world_from_body);
        gripped = true;
      }
    }
    if (!moved && !closing && time < trajectory.times.back()) continue;
    last = now;
    arm.SetLeader(std::max(0.0, now[size]));
    arm.MarkNear(now.head(size), distance, &near);
  }
  return near;
}

std::string MovedText(const std::string& name, double moved) {
  char text[160];
  std::snprintf(text, sizeof text, "moves %s by %.1f mm", name.c_str(), 1e3 * moved);
  return text;
}

// A world in which a trajectory is replayed.
class ReplayWorld {
 public:
  ReplayWorld(const Planner& planner, const PlacedScene& scene, int target,
              const Isometry3d& world_from_robot, const std::vector<char>& free,
              const ProofOptions& options)
      : scene_(scene),
        target_(static_cast<size_t>(target)),
        options_(options),
        world_(Of(options)) {
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
      sim::Placement placement;
      placement.world_from_root = scene.bodies[i].world_from_body;
      placement.fixed = scene.bodies[i].fixed || !free[i];
      bodies_.push_back(world_.Add(scene.bodies[i].model->physics, placement));
    }
    robot_ = std::make_unique<sim::DrivenRobot>(planner.robot(), planner.physics(),
                                                world_from_robot, &world_);
    fingers_ = planner.robot().gripper.links;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
      if (!scene.bodies[i].fixed && free[i] && i != target_) watched_.push_back(i);
    }
  }

  void Command(const Eigen::VectorXd& command) {
    robot_->Command(command.head(command.size() - 1), std::max(0.0, command[command.size() - 1]));
  }
  void Step() {
    robot_->Drive();
    world_.Step();
  }

  Isometry3d PoseOf(size_t body) const { return world_.LinkPose(bodies_[body], 0); }
  Isometry3d Target() const { return PoseOf(target_); }
  const sim::DrivenRobot& robot() const { return *robot_; }
  double time_step() const { return world_.time_step(); }

  // Updates the displacements; returns false if another object has moved too far.
  bool CheckOthers(Proof* proof) const {
    for (const size_t i : watched_) {
      const PlacedBody& body = scene_.bodies[i];
      const double moved = DisplacementOf(*body.model, body.world_from_body, PoseOf(i));
      if (moved <= proof->others_moved) continue;
      proof->others_moved = moved;
      proof->moved_most = body.name;
    }
    if (proof->others_moved <= options_.others_tolerance) return true;
    proof->failure = MovedText(proof->moved_most, proof->others_moved);
    return false;
  }

  // Returns true if both fingers press on the target.
  bool IsHeld() {
    world_.Contacts(&contacts_);
    double impulse[2] = {0.0, 0.0};
    for (const sim::LinkContact& contact : contacts_) {
      const int own = robot_->body(), other = bodies_[target_];
      int link = -1;
      if (contact.body_a == own && contact.body_b == other) link = contact.link_a;
      if (contact.body_b == own && contact.body_a == other) link = contact.link_b;
      for (size_t f = 0; f < 2 && f < fingers_.size(); ++f) {
        if (link == fingers_[f]) impulse[f] += contact.impulse;
      }
    }
    const double least = kGripForce * world_.time_step();
    return impulse[0] > least && impulse[1] > least;
  }
  // Returns true if the robot touches the target.
  bool IsTouched() {
    world_.Contacts(&contacts_);
    return std::any_of(contacts_.begin(), contacts_.end(), [&](const sim::LinkContact& contact) {
      const int own = robot_->body(), other = bodies_[target_];
      return contact.distance < 5e-4 && ((contact.body_a == own && contact.body_b == other) ||
                                         (contact.body_b == own && contact.body_a == other));
    });
  }

  ReplayMoment Moment(double time) const {
    ReplayMoment moment;
    moment.time = time;
    robot_->Positions(&moment.arm);
    moment.leader = robot_->Leader();
    for (size_t i = 0; i < bodies_.size(); ++i) moment.poses.push_back(PoseOf(i));
    return moment;
  }

 private:
  static sim::WorldOptions Of(const ProofOptions& options) {
    sim::WorldOptions world;
    world.time_step = options.time_step;
    world.solver_iterations = options.solver_iterations;
    return world;
  }

  const PlacedScene& scene_;
  size_t target_;
  const ProofOptions& options_;
  sim::ArticulatedWorld world_;
  std::unique_ptr<sim::DrivenRobot> robot_;
  std::vector<int> bodies_, fingers_;
  std::vector<size_t> watched_;  // free bodies other than the target
  std::vector<sim::LinkContact> contacts_;
};

}  // namespace

bool ProofOptions::IsValid(std::string* error) const {
  const bool valid = time_step > 1e-5 && time_step <= 0.02 && solver_iterations >= 1 &&
                     others_tolerance > 0.0 && hold >= 0.0 && hold <= 60.0 && free_distance >= 0.0;
  if (!valid && error != nullptr) {
    *error = "the proof's step, iterations, tolerance and hold must be positive";
  }
  return valid;
}

Proof Replay(const Planner& planner, const PlacedScene& scene, int target, const Goal& goal,
             const Isometry3d& world_from_robot, const robot::JointTrajectory& trajectory,
             const std::vector<double>& moments, const ProofOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "replay");
  robot::RequireWellFormed(trajectory, "replay");
  const PlacedBody& body = scene.bodies[static_cast<size_t>(target)];
  const std::vector<char> free =
      NearBodies(planner, scene, target, world_from_robot, trajectory, options.free_distance);
  ReplayWorld world(planner, scene, target, world_from_robot, free, options);
  TrajectoryCommands commands(trajectory, planner.robot());
  Proof proof;
  proof.free_bodies = static_cast<int>(std::count(free.begin(), free.end(), 1));
  const double end = commands.duration() + options.hold;
  const int steps = static_cast<int>(std::ceil(end / world.time_step()));
  const int watch = static_cast<int>(std::floor(commands.duration() / world.time_step()));
  std::optional<Isometry3d> tool_from_target;
  Isometry3d at_watch = body.world_from_body;
  size_t next_moment = 0;
  const bool held_goal = goal.kind != GoalKind::kPlace;
  for (int step = 1; step <= steps; ++step) {
    const double time = step * world.time_step();
    world.Command(commands.At(time));
    world.Step();
    const bool picture = next_moment < moments.size() && time >= moments[next_moment];
    if (picture) {
      proof.moments.push_back(world.Moment(time));
      ++next_moment;
    }
    if (step == watch) at_watch = world.Target();
    if (step % kCheckSteps != 0 && step != steps) continue;
    core::CheckCancelled();
    proof.seconds = time;
    if (!world.CheckOthers(&proof)) return proof;
    const Isometry3d pose = world.Target();
    const double moved = DisplacementOf(*body.model, body.world_from_body, pose);
    if (!tool_from_target && moved > 0.01) {
      tool_from_target = world.robot().Tool().inverse() * pose;
    }
    // Keeps the goal until the end, from the end of the trajectory on.
    if (step < watch) continue;
    if (!goal.IsReached(*body.model, body.world_from_body, pose)) {
      proof.failure = moved < 0.01 ? "does not move the object" : "the object is not at its goal";
      return proof;
    }
    if (held_goal && !world.IsHeld()) {
      proof.failure = "drops the object";
      return proof;
    }
  }
  const Isometry3d pose = world.Target();
  proof.target_moved = DisplacementOf(*body.model, body.world_from_body, pose);
  proof.held = world.IsHeld();
  if (tool_from_target) {
    const Isometry3d expected = world.robot().Tool() * *tool_from_target;
    if (held_goal) proof.slip = (expected.translation() - pose.translation()).norm();
  }
  if (!held_goal && world.IsTouched()) {
    proof.failure = "does not release the object";
  } else if (!held_goal && DisplacementOf(*body.model, at_watch, pose) > kAtRest) {
    proof.failure = "the object does not come to rest";
  }
  proof.success = proof.failure.empty();
  return proof;
}

}  // namespace simwright::certificate
