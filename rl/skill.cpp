#include "rl/skill.h"

#include <algorithm>

#include "core/error.h"
#include "geometry/convex_hull.h"
#include "rl/approach_choice.h"
#include "rl/hand_clearance.h"
#include "rl/reach_plan.h"
#include "sim/driven_robot.h"

namespace simwright::rl {
namespace {

using tasks::RewardInput;

constexpr double kSurfaceSpacing = 0.016;  // m: twice the thickness of thin boards

// Replaces the collision parts of a rigid object by their convex hull.
void UseConvexHull(sim::ArticulatedBody* body) {
  sim::RigidBody& link = body->links.front();
  std::vector<Eigen::Vector3d> points;
  for (const core::TriangleMesh& part : link.parts) {
    points.insert(points.end(), part.vertices.begin(), part.vertices.end());
  }
  link.parts = {geometry::ConvexHull(points, 64)};
  link.capsules.clear();
}

// Returns the object that `thing` stands in or on at the start: the one whose AABB extends below it
// and contains its middle from above. -1: the floor.
int CarrierOf(const tasks::SceneModel& model, const tasks::SceneState& start, int thing,
              const std::vector<int>& placed) {
  constexpr double kOnFloor = 0.005;  // m
  const Eigen::AlignedBox3d box = tasks::WorldBox(model, start, thing);
  if (box.min().z() < kOnFloor) return -1;
  for (const int other : placed) {
    if (other == thing) continue;
    const Eigen::AlignedBox3d holder = tasks::WorldBox(model, start, other);
    const Eigen::Vector3d middle = box.center();
    const bool over = (middle.head<2>().array() >= holder.min().head<2>().array()).all() &&
                      (middle.head<2>().array() <= holder.max().head<2>().array()).all();
    if (over && holder.min().z() < box.min().z() - kOnFloor) return other;
  }
  return -1;
}

void PlaceObjects(SkillVariant* variant) {
  const tasks::InitialState& start = variant->subtask.start;
  variant->fixed.assign(variant->model.things.size(), false);
  variant->carried_by.assign(variant->model.things.size(), -1);
  for (const tasks::AssetPlacement& placement : start.placements) {
    const int thing = variant->model.Find(placement.asset);
    variant->placed.push_back(thing);
    variant->fixed[static_cast<size_t>(thing)] = placement.fixed;
  }
  variant->starts_held = !start.held.empty();
  for (const int thing : variant->placed) {
    const bool held = variant->starts_held && thing == variant->model.Find(start.held);
    if (variant->fixed[static_cast<size_t>(thing)] || held) continue;
    variant->carried_by[static_cast<size_t>(thing)] =
        CarrierOf(variant->model, variant->start, thing, variant->placed);
  }
}

void CompileProgram(SkillVariant* variant) {
  const tasks::Subtask& subtask = variant->subtask;
  const tasks::CompileOutcome outcome =
      tasks::CompileReward(subtask.program, &variant->model.names);
  if (!outcome.program) {
    std::string why = "the program does not compile";
    for (const core::Finding& finding : outcome.findings) {
      if (finding.severity != core::Severity::kError) continue;
      why = finding.sentence + " (" + finding.place + ")";
      break;
    }
    throw core::Error(why, "subtask " + subtask.name, "see `simwright reward`");
  }
  if (!outcome.program->has_success()) {
    throw core::Error("the program returns no success", "subtask " + subtask.name,
                      "return reward, success");
  }
  variant->program = outcome.program;
}

void FindTarget(double opening, SkillVariant* variant) {
  const std::vector<tasks::RewardSlot>& slots = variant->program->slots();
  variant->focus = FocusOf(variant->model, variant->start, slots, opening,
                           variant->subtask.start.world_from_robot.translation().z());
  if (variant->focus) {
    variant->destination = DestinationOf(variant->model, variant->start, *variant->focus, slots);
  }
  for (const tasks::RewardSlot& slot : slots) {
    if (slot.input == RewardInput::kGrasped) variant->asks_for_grasp = true;
  }
}

// Returns SkillVariant::next.
std::optional<Destination> NextDestination(const SkillSubtask& source, const SkillVariant& variant,
                                           double opening) {
  if (!source.next || !variant.focus || variant.focus->joint >= 0) return std::nullopt;
  if (source.next->start.held.empty() ||
      variant.model.Find(source.next->start.held) != variant.focus->thing) {
    return std::nullopt;
  }
  SkillVariant next;
  next.model = variant.model;
  next.subtask = *source.next;
  next.start = tasks::StateOf(next.model, source.next->start, source.next->goal);
  CompileProgram(&next);
  FindTarget(opening, &next);
  const bool carries_on = next.focus && next.focus->thing == variant.focus->thing;
  if (!carries_on || !next.destination || next.destination->goal) return std::nullopt;
  return next.destination;
}

// Returns SkillVariant::room.
std::optional<SideRoom> FindReceptacle(const SkillVariant& variant) {
  if (!variant.focus || variant.focus->joint >= 0 || Pushes(variant)) return std::nullopt;
  if (variant.destination && variant.destination->room) return variant.destination->room;
  const Eigen::Vector3d point =
      tasks::LinkPoint(variant.model, variant.start, variant.focus->thing, 0);
  if (const auto room = SideRoomAround(variant.model, variant.start, point)) return room;
  return variant.next ? variant.next->room : std::nullopt;
}

void PrepareBodies(const std::vector<assets::SemanticModel>& models, const SkillOptions& options,
                   SkillVariant* variant) {
  for (size_t i = 0; i < models.size(); ++i) {
    sim::ArticulatedBody body = sim::ArticulatedBodyFrom(models[i].model);
    const bool worked = variant->focus && variant->focus->thing == static_cast<int>(i);
    // A convex hull has no wall to grasp.
    const bool only_moved = worked && body.joints.empty() && variant->focus->rim == 0.0;
    if (options.hulls && only_moved && !body.links.front().parts.empty()) UseConvexHull(&body);
    std::vector<int> joints;
    for (const tasks::ThingJoint& joint : variant->model.things[i].joints) {
      joints.push_back(body.JointIndex(joint.name));
    }
    variant->body_joints.push_back(std::move(joints));
    variant->solids.push_back(SolidsOf(body));
    variant->bodies.push_back(std::make_shared<sim::PreparedBody>(std::move(body)));
  }
}

SkillVariant MakeVariant(const SkillSubtask& source, const robot::RobotModel& robot,
                         const SkillOptions& options) {
  SkillVariant variant;
  variant.model = tasks::MakeSceneModel(source.assets);
  variant.subtask = source.subtask;
  variant.start = tasks::StateOf(variant.model, source.subtask.start, source.subtask.goal);
  PlaceObjects(&variant);
  CompileProgram(&variant);
  FindTarget(robot.gripper.MaxOpening(), &variant);
  variant.next = NextDestination(source, variant, robot.gripper.MaxOpening());
  variant.room = FindReceptacle(variant);
  PrepareBodies(source.assets, options, &variant);
  if (variant.focus && variant.focus->joint >= 0) {
    const auto thing = static_cast<size_t>(variant.focus->thing);
    variant.focus->link_from_tool = ChooseApproach(robot, variant, variant.bodies[thing]->body());
  }
  return variant;
}

// Returns true if two programs read the same kinds of inputs, so that one policy can observe both.
bool ReadSameInputs(const SkillVariant& a, const SkillVariant& b) {
  const auto kinds = [](const SkillVariant& variant) {
    std::vector<int> inputs;
    for (const tasks::RewardSlot& slot : variant.program->slots()) {
      inputs.push_back(static_cast<int>(slot.input));
    }
    return inputs;
  };
  return kinds(a) == kinds(b) && a.focus.has_value() == b.focus.has_value() &&
         (!a.focus || (a.focus->joint >= 0) == (b.focus->joint >= 0)) &&
         a.destination.has_value() == b.destination.has_value();
}

}  // namespace

std::shared_ptr<const Skill> MakeSkill(const robot::RobotModel& robot,
                                       const std::vector<SkillSubtask>& subtasks,
                                       const SkillOptions& options,
                                       std::vector<std::shared_ptr<const Skill>> later) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "skill options");
  if (subtasks.empty()) throw core::Error("a skill needs a subtask");
  for (const auto& skill : later) {
    if (skill->variants.size() == subtasks.size()) continue;
    throw core::Error("has another number of scenes than the skill before it",
                      "subtask " + skill->variants.front().subtask.name);
  }
  auto skill = std::make_shared<Skill>();
  skill->robot = &robot;
  skill->robot_body = sim::RobotBody(robot);
  skill->robot_surface = RobotSurface(robot, kSurfaceSpacing);
  skill->kinematics = std::make_shared<robot::PoseInverseKinematics>(robot.arm);
  skill->chain = std::make_shared<robot::ChainKinematics>(robot.arm);
  skill->options = options;
  skill->later = std::move(later);
  for (const SkillSubtask& subtask : subtasks) {
    skill->variants.push_back(MakeVariant(subtask, robot, options));
    if (!ReadSameInputs(skill->variants.front(), skill->variants.back())) {
      throw core::Error("its program reads other inputs than that of '" +
                            subtasks.front().subtask.name + "': one policy cannot learn both",
                        "subtask " + subtask.subtask.name);
    }
  }
  return skill;
}

}  // namespace simwright::rl
