#include "skills/episode.h"

#include <algorithm>
#include <cmath>

#include "manipulation/carry_plan.h"
#include "manipulation/goal_displacement.h"
#include "manipulation/reach_plan.h"
#include "skills/scripted_expert.h"

namespace simwright::skills {
namespace {

// The weight of the finger command of an action: a full action overrides the scripted expert.
constexpr float kOverrule = 2.0f;
constexpr double kNearPlansEnd = 0.15;  // rad
constexpr int kMostPlans = 3;           // per episode, at most
// The pace of an arm that carries an object far: an object held by its rim between two fingers
// rotates when it is accelerated, and is lost.
constexpr double kCarryingPace = 0.6;
constexpr double kFarDestination = 0.25;  // m: to a nearer destination the tool moves straight

}  // namespace

// The observer and the reward of one variant, with their memory.
struct Episode::Program {
  Program(const Skill& skill, const SkillVariant& variant)
      : observer(skill, variant), reward(variant) {}

  Observer observer;
  VariantReward reward;
};

Episode::Episode(const Skill& skill)
    : skill_(skill),
      programs_(skill.variants.size()),
      action_(static_cast<size_t>(ActionSize(skill))),
      combined_action_(action_.size()) {}

Episode::~Episode() = default;

void Episode::Begin(const StartState& start) {
  start_ = start;
  const auto variant = static_cast<size_t>(start.variant);
  if (!programs_[variant]) {
    programs_[variant] = std::make_unique<Program>(skill_, skill_.variants[variant]);
  }
  world_ = std::make_unique<SkillWorld>(skill_, start_);
  state_ = start.state;
  world_->Read(&state_);
  previous_ = state_;
  command_.sent = world_->robot().command();
  plan_count_ = 0;
  command_.pace = 1.0;
  StartPlan();
  command_.leader = world_->robot().leader_command();
  command_.rate = robot::JointVector::Zero(command_.sent.size());
  command_.leader_rate = 0.0;
  world_->robot().Positions(&positions_);
  arm_ = positions_;
  velocities_ = robot::JointVector::Zero(arm_.size());
  target_.base_from_tool =
      skill_.variants[variant].subtask.start.world_from_robot.inverse() * state_.gripper;
  target_.joints = command_.sent;
  target_.leader = command_.leader;
  std::fill(action_.begin(), action_.end(), 0.0f);
  decisions_ = held_ = 0;
}

// Starts the plan in `start_` from the current state of objects and arm.
void Episode::StartPlan() {
  const SkillVariant& variant = skill_.variants[static_cast<size_t>(start_.variant)];
  const Eigen::Isometry3d grasp_configuration =
      robot::ForwardKinematics(skill_.robot->arm, start_.grasp_configuration);
  const Eigen::Matrix3d& world_from_base = variant.subtask.start.world_from_robot.linear();
  frame_ = std::make_unique<manipulation::TargetFrame>(
      variant, state_, world_from_base * grasp_configuration.linear().col(1), start_.pitch,
      start_.retreat, start_.grasp);
  const bool planned = FollowsPlan(skill_.options.action) && !frame_->retreating();
  command_.goal = planned ? start_.grasp_configuration : start_.arm;
  command_.waypoints = planned ? start_.waypoints : manipulation::JointPath();
  along_ = manipulation::ConfigurationsAlongJoint(skill_, variant, state_,
                                                  start_.grasp_configuration, start_.pitch);
  if (frame_->at_destination()) PlanArrival();
  UpdateRestConfiguration();
  ++plan_count_;
}

// Returns true if a door was pushed to the end of its planned configurations, which may not reach
// the joint target from wide open.
bool Episode::IsAtPlansEnd() const {
  const std::optional<manipulation::InteractionTarget>& focus =
      skill_.variants[static_cast<size_t>(start_.variant)].target;
  if (!focus || !focus->pushes || !along_.ends_early || frame_->retreating()) return false;
  const double position =
      state_.joints[static_cast<size_t>(focus->object)][static_cast<size_t>(focus->joint)];
  const double end = along_.positions.back(), begin = along_.positions.front();
  return (position - end) * (begin - end) < kNearPlansEnd * std::abs(begin - end);
}

void Episode::Replan() {
  core::Rng rng = core::StreamRng(static_cast<std::uint64_t>(plan_count_), 0);
  StartState now = start_;
  now.state = state_;
  now.arm = arm_;
  start_ = PlannedFrom(skill_, now, rng, Resampling::kNothing);
  StartPlan();
}

void Episode::Act(const ToolTarget& target) {
  const SkillVariant& variant = skill_.variants[static_cast<size_t>(start_.variant)];
  for (int step = 0; step < skill_.options.control_steps; ++step) {
    if (step >= start_.delay) target_ = target;
    command_.together =
        frame_->retreating() || (frame_->at_destination() && variant.target->rim > 0.0);
    StepCommand(skill_, target_, arm_, &command_);
    world_->robot().Command(command_.sent, command_.leader);
    world_->Advance();
    world_->robot().Positions(&positions_);
    arm_ = positions_;
    if (watch_) watch_(*this);
  }
  world_->robot().Velocities(&positions_);
  velocities_ = positions_;
}

// Plans a joint path to a far destination; to a near one the tool moves straight.
void Episode::PlanArrival() {
  arrival_.resize(0);
  command_.pace = 1.0;
  if (!FollowsPlan(skill_.options.action)) return;
  const SkillVariant& variant = skill_.variants[static_cast<size_t>(start_.variant)];
  if (manipulation::DisplacementToDestination(variant, state_).norm() < kFarDestination) return;
  manipulation::CarryTask task;
  task.there = frame_->world_from_target();
  const double back = std::max(skill_.options.standoff, frame_->retreat_distance());
  task.back = back * (task.there.linear() * frame_->back());
  task.may_turn = !variant.room;
  const auto plan = manipulation::PlanCarry(skill_, variant, state_, task, command_.sent);
  if (!plan) return;
  arrival_ = plan->arrival;
  if (variant.target->rim > 0.0) command_.pace = kCarryingPace;
  if (plan->turn != 0.0) frame_->Turn(plan->turn, state_);
  command_.goal = plan->arrival;
  command_.waypoints = plan->waypoints;
  // In front of a side-opening receptacle the gripper may first have to move straight back.
  if (!variant.room) command_.waypoints.push_back(plan->arrival);
}

// Redundant joints keep to the planned configuration. With home as their target, an arm that pulls
// a door drifts into that door.
void Episode::UpdateRestConfiguration() {
  const SkillVariant& variant = skill_.variants[static_cast<size_t>(start_.variant)];
  const std::optional<manipulation::InteractionTarget>& focus = variant.target;
  if (!focus || frame_->retreating() || manipulation::Pushes(variant)) {
    command_.rest.resize(0);
  } else if (!along_.positions.empty()) {
    command_.rest = along_.At(
        state_.joints[static_cast<size_t>(focus->object)][static_cast<size_t>(focus->joint)]);
  } else {
    command_.rest = frame_->at_destination() ? arrival_ : start_.grasp_configuration;
  }
}

float Episode::Reward(bool* success) {
  Program& program = *programs_[static_cast<size_t>(start_.variant)];
  const float reward =
      program.reward.Run(state_, previous_, skill_.options.decision_seconds(), success);
  return reward + (*success ? static_cast<float>(skill_.options.success_bonus) : 0.0f);
}

Decision Episode::Step(const float* action) {
  if (!std::all_of(action, action + action_.size(), [](float a) { return std::isfinite(a); })) {
    return {.truncated = true, .failed = true, .invalid_action = true};
  }
  for (size_t a = 0; a < action_.size(); ++a) action_[a] = std::clamp(action[a], -1.0f, 1.0f);
  const SkillVariant& variant = skill_.variants[static_cast<size_t>(start_.variant)];
  ActionFrame work;
  work.base_from_target =
      variant.subtask.start.world_from_robot.inverse() * frame_->world_from_target();
  work.lean = frame_->lean();
  work.pushes = manipulation::Pushes(variant) || (variant.target && variant.target->pushes);
  work.motion_direction = frame_->motion_direction();
  work.back = frame_->back();
  work.retreat_distance = frame_->retreat_distance();
  if (skill_.options.action == ActionSpace::kGuided) {
    ExpertAction(*this, combined_action_.data());
    for (size_t a = 0; a < combined_action_.size(); ++a) {
      const float weight = a + 1 == combined_action_.size() ? kOverrule : 1.0f;
      combined_action_[a] = std::clamp(combined_action_[a] + weight * action_[a], -1.0f, 1.0f);
    }
  }
  const bool guided = skill_.options.action == ActionSpace::kGuided;
  Act(ActionTarget(skill_, guided ? combined_action_.data() : action_.data(), work, command_));
  std::swap(previous_, state_);
  state_ = previous_;
  world_->Read(&state_);
  ++decisions_;
  Decision decision;
  if (!world_->IsStateValid() || !command_.sent.allFinite()) {
    state_ = previous_;
    decision.failed = decision.truncated = true;
    return decision;
  }
  const bool withdrew = frame_->retreating(), was_there = frame_->at_destination();
  frame_->Update(state_);
  if (frame_->at_destination() && !was_there) PlanArrival();
  if (plan_count_ < kMostPlans && IsAtPlansEnd()) Replan();
  UpdateRestConfiguration();
  if (FollowsPlan(skill_.options.action) && withdrew && !frame_->retreating()) {
    command_.goal = start_.grasp_configuration;
    command_.waypoints = start_.waypoints;
  }
  decision.reward = Reward(&decision.success);
  if (!std::isfinite(decision.reward)) {
    decision.reward = 0.0f;
    decision.failed = decision.truncated = true;
    return decision;
  }
  held_ = decision.success ? held_ + 1 : 0;
  const SkillOptions& options = skill_.options;
  const int hold =
      std::max(1, static_cast<int>(std::ceil(options.hold_seconds / options.decision_seconds())));
  decision.terminated = held_ >= hold;
  decision.truncated = !decision.terminated && decisions_ >= options.decisions();
  // A success that ends the episode is paid as if it lasted forever: otherwise a policy would gain
  // by staying just short of it.
  if (decision.terminated) {
    decision.reward *= static_cast<float>(1.0 / (1.0 - options.discount));
  }
  return decision;
}

void Episode::Observe(float* row) const {
  PolicyInputs senses;
  senses.arm = &arm_;
  senses.velocities = &velocities_;
  senses.leader_command = command_.leader;
  senses.last_action = action_.data();
  senses.world_from_target = frame_->world_from_target();
  senses.at_destination = frame_->at_destination();
  senses.retreating = frame_->retreating();
  programs_[static_cast<size_t>(start_.variant)]->observer.Write(state_, &previous_, senses, row);
}

}  // namespace simwright::skills
