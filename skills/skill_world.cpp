#include "skills/skill_world.h"

#include <algorithm>
#include <cmath>

namespace simwright::skills {
namespace {

using Eigen::Isometry3d;

constexpr double kTouches = 5e-4;         // m
constexpr double kGraspForce = 1.0;       // N by each finger
constexpr double kClosing = 1.0;          // s at most, for closing the gripper on an object
constexpr double kStill = 0.1;            // s at rest that end the closing ...
constexpr double kStillSpeed = 2e-3;      // ... below this speed, m/s or rad/s
constexpr double kSettling = 0.1;         // s more, in which the grasp takes the object's weight
constexpr double kFarthestObject = 20.0;  // m from the robot: beyond, the physics has failed

sim::WorldOptions WorldOptionsOf(const SkillOptions& options, int iterations) {
  sim::WorldOptions world;
  world.time_step = 1.0 / (options.control_rate * options.substeps);
  world.solver_iterations = iterations;
  world.sleeping = true;
  return world;
}

}  // namespace

SkillWorld::SkillWorld(const Skill& skill, const StartState& start)
    : skill_(skill),
      variant_(skill.variants[static_cast<size_t>(start.variant)]),
      contact_iterations_(ContactIterations(start)),
      world_(WorldOptionsOf(skill.options, contact_iterations_)),
      bodies_(variant_.model.objects.size(), -1) {
  for (const int object : variant_.placed) {
    const auto t = static_cast<size_t>(object);
    sim::Placement placement;
    placement.world_from_root = start.state.roots[t];
    placement.fixed = variant_.fixed[t];
    placement.mass_scale = start.mass[t];
    placement.friction_scale = start.friction[t];
    placement.joint_scale = start.joint[t];
    bodies_[t] = world_.Add(variant_.bodies[t], placement);
    object_of_.push_back(object);
    for (size_t j = 0; j < variant_.body_joints[t].size(); ++j) {
      world_.SetPosition(bodies_[t], variant_.body_joints[t][j], start.state.joints[t][j]);
    }
  }
  sim::MotorOptions motors;
  motors.finger_friction = start.finger_friction;
  robot_ = std::make_unique<sim::DrivenRobot>(
      *skill.robot, skill.robot_body, variant_.subtask.start.world_from_robot, &world_, motors);
  object_of_.push_back(-1);
  for (auto& impulses : finger_impulses_) impulses.assign(variant_.model.objects.size(), 0.0);
  robot_->Place(start.arm, start.leader);
  if (start.held >= 0) {
    CloseGripperOn(start.held, skill.robot->gripper.closed);
  } else if (start.closed_to && variant_.target) {
    CloseGripperOn(variant_.target->object, *start.closed_to);
  }
}

int SkillWorld::ContactIterations(const StartState& start) const {
  const SkillOptions& options = skill_.options;
  for (const int object : variant_.placed) {
    const auto t = static_cast<size_t>(object);
    if (variant_.fixed[t]) continue;
    if (start.mass[t] * variant_.model.objects[t].mass < options.light_mass) {
      return options.light_contact_iterations;
    }
  }
  return options.contact_iterations;
}

// The object is held in place while the gripper closes to `leader`, as if it stood on a support.
void SkillWorld::CloseGripperOn(int object, double leader) {
  const int body = bodies_[static_cast<size_t>(object)];
  if (body < 0) return;
  const Isometry3d pose = world_.LinkPose(body, 0);
  robot_->Command(robot_->command(), leader);
  const bool free = !variant_.fixed[static_cast<size_t>(object)];
  const auto steps = [&](double seconds) {
    return static_cast<int>(std::lround(seconds / world_.time_step()));
  };
  int still = 0;
  for (int step = 0; step < steps(kClosing) && still < steps(kStill); ++step) {
    const double before = robot_->Leader();
    robot_->Drive();
    world_.Step();
    if (free) world_.SetRootPose(body, pose);
    still = std::abs(robot_->Leader() - before) < kStillSpeed * world_.time_step() ? still + 1 : 0;
  }
  for (int step = 0; step < steps(kSettling); ++step) {
    robot_->Drive();
    world_.Step();
  }
  ReadContacts();
}

void SkillWorld::Advance() {
  world_.SetIterations(touching_ ? contact_iterations_ : skill_.options.free_iterations);
  for (int step = 0; step < skill_.options.substeps; ++step) {
    robot_->Drive();
    world_.Step();
  }
  ReadContacts();
}

void SkillWorld::ReadContacts() {
  world_.Contacts(&contacts_);
  for (auto& impulses : finger_impulses_) std::fill(impulses.begin(), impulses.end(), 0.0);
  const std::vector<int>& fingers = skill_.robot->gripper.links;
  touching_ = false;
  touched_ = touched_link_ = -1;
  double hardest = -1.0;
  for (const sim::LinkContact& contact : contacts_) {
    if (contact.distance > kTouches) continue;
    const bool robot_first = contact.body_a == robot_->body();
    if (!robot_first && contact.body_b != robot_->body()) continue;
    touching_ = true;
    const int finger_link = robot_first ? contact.link_a : contact.link_b;
    const int other = robot_first ? contact.body_b : contact.body_a;
    if (other == sim::kFloor) continue;
    const auto finger = std::find(fingers.begin(), fingers.end(), finger_link) - fingers.begin();
    if (finger >= 2) continue;
    const int object = object_of_[static_cast<size_t>(other)];
    finger_impulses_[finger][static_cast<size_t>(object)] += contact.impulse;
    if (contact.impulse <= hardest) continue;
    hardest = contact.impulse;
    touched_ = object;
    touched_link_ = robot_first ? contact.link_b : contact.link_a;
  }
  const double least = kGraspForce * world_.time_step();
  grasped_ = touched_ >= 0 && finger_impulses_[0][static_cast<size_t>(touched_)] > least &&
             finger_impulses_[1][static_cast<size_t>(touched_)] > least;
}

void SkillWorld::Read(tasks::WorldState* state) const {
  for (size_t t = 0; t < bodies_.size(); ++t) {
    if (bodies_[t] < 0) continue;
    state->roots[t] = world_.LinkPose(bodies_[t], 0);
    for (size_t j = 0; j < variant_.body_joints[t].size(); ++j) {
      state->joints[t][j] = world_.Position(bodies_[t], variant_.body_joints[t][j]);
    }
  }
  state->gripper = robot_->Tool();
  state->opening = robot_->Opening();
  state->touched = touched_;
  state->touched_link = touched_link_;
  state->grasped = grasped_;
}

bool SkillWorld::IsStateValid() const {
  for (const int body : bodies_) {
    if (body < 0) continue;
    const Isometry3d pose = world_.LinkPose(body, 0);
    if (!(pose.translation().norm() < kFarthestObject) || !pose.matrix().allFinite()) return false;
  }
  return robot_->Tool().matrix().allFinite();
}

}  // namespace simwright::skills
