#include "skills/skill.h"

#include <algorithm>

#include "core/error.h"
#include "core/log.h"
#include "geometry/convex_hull.h"
#include "manipulation/approach_choice.h"
#include "manipulation/gripper_penetration.h"
#include "manipulation/reach_plan.h"
#include "sim/driven_robot.h"

namespace simwright::skills {
namespace {

using reward::RewardInput;

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

// Returns the object that `object` stands in or on at the start: the one whose AABB extends below
// it and contains its middle from above. -1: the floor.
int CarrierOf(const tasks::WorldModel& model, const tasks::WorldState& start, int object,
              const std::vector<int>& placed) {
  constexpr double kOnFloor = 0.005;  // m
  const Eigen::AlignedBox3d box = tasks::WorldAabb(model, start, object);
  if (box.min().z() < kOnFloor) return -1;
  for (const int other : placed) {
    if (other == object) continue;
    const Eigen::AlignedBox3d holder = tasks::WorldAabb(model, start, other);
    const Eigen::Vector3d middle = box.center();
    const bool over = (middle.head<2>().array() >= holder.min().head<2>().array()).all() &&
                      (middle.head<2>().array() <= holder.max().head<2>().array()).all();
    if (over && holder.min().z() < box.min().z() - kOnFloor) return other;
  }
  return -1;
}

void SkillPlaceObjects(SkillVariant* variant) {
  const tasks::InitialState& start = variant->subtask.start;
  variant->fixed.assign(variant->model.objects.size(), false);
  variant->carried_by.assign(variant->model.objects.size(), -1);
  for (const tasks::AssetPlacement& placement : start.placements) {
    const int object = variant->model.Find(placement.asset);
    variant->placed.push_back(object);
    variant->fixed[static_cast<size_t>(object)] = placement.fixed;
  }
  variant->starts_held = !start.held.empty();
  for (const int object : variant->placed) {
    const bool held = variant->starts_held && object == variant->model.Find(start.held);
    if (variant->fixed[static_cast<size_t>(object)] || held) continue;
    variant->carried_by[static_cast<size_t>(object)] =
        CarrierOf(variant->model, variant->start, object, variant->placed);
  }
}

void CompileProgram(SkillVariant* variant) {
  const tasks::Subtask& subtask = variant->subtask;
  const reward::CompileOutcome outcome =
      reward::CompileReward(subtask.program, &variant->model.names);
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
  const std::vector<reward::RewardSlot>& slots = variant->program->slots();
  variant->target = manipulation::FindInteractionTarget(
      variant->model, variant->start, slots, opening,
      variant->subtask.start.world_from_robot.translation().z());
  if (variant->target) {
    variant->destination =
        manipulation::DestinationOf(variant->model, variant->start, *variant->target, slots);
  }
  for (const reward::RewardSlot& slot : slots) {
    if (slot.input == RewardInput::kGrasped) variant->asks_for_grasp = true;
  }
}

// Writes the proved grasps of an object that is grasped, or puts those of a sliding part among its
// approaches. A part that rotates is taken by its natural approach: fingers deep behind its handle
// hook it, while those of a proved grasp may slip as they pull (docs/skills.md).
void FindGrasps(const SkillSubtask& source, SkillVariant* variant) {
  if (!variant->target || variant->target->pushes) return;
  manipulation::InteractionTarget& target = *variant->target;
  const tasks::ArticulatedObject& object =
      variant->model.objects[static_cast<size_t>(target.object)];
  const auto known = source.grasps.find(object.name);
  if (known == source.grasps.end()) return;
  if (target.joint < 0) {
    if (variant->asks_for_grasp && !object.articulated()) target.grasps = known->second;
    return;
  }
  const tasks::ObjectJoint& joint = object.joints[static_cast<size_t>(target.joint)];
  if (joint.type != reward::RewardJointType::kPrismatic) return;
  for (const manipulation::Grasp& grasp : known->second) {
    const bool same_part = grasp.joint == joint.name && grasp.link == object.LinkName(target.link);
    if (same_part) target.grasps.push_back(grasp);
  }
  target.approaches = manipulation::WithProvedGrasps(target.approaches, target.grasps);
}

// Returns SkillVariant::next.
std::optional<manipulation::Destination> NextDestination(const SkillSubtask& source,
                                                         const SkillVariant& variant,
                                                         double opening) {
  if (!source.next || !variant.target || variant.target->joint >= 0) return std::nullopt;
  if (source.next->start.held.empty() ||
      variant.model.Find(source.next->start.held) != variant.target->object) {
    return std::nullopt;
  }
  SkillVariant next;
  next.model = variant.model;
  next.subtask = *source.next;
  next.start = tasks::StateOf(next.model, source.next->start, source.next->goal);
  CompileProgram(&next);
  FindTarget(opening, &next);
  const bool carries_on = next.target && next.target->object == variant.target->object;
  if (!carries_on || !next.destination || next.destination->goal) return std::nullopt;
  return next.destination;
}

// Returns SkillVariant::room.
std::optional<manipulation::SideReceptacle> FindReceptacle(const SkillVariant& variant) {
  if (!variant.target || variant.target->joint >= 0 || manipulation::Pushes(variant))
    return std::nullopt;
  if (variant.destination && variant.destination->room) return variant.destination->room;
  const Eigen::Vector3d point =
      tasks::LinkPosition(variant.model, variant.start, variant.target->object, 0);
  if (const auto room = manipulation::FindSideReceptacleAround(variant.model, variant.start, point))
    return room;
  return variant.next ? variant.next->room : std::nullopt;
}

void PrepareBodies(const std::vector<assets::SemanticModel>& models, const SkillOptions& options,
                   SkillVariant* variant) {
  for (size_t i = 0; i < models.size(); ++i) {
    sim::ArticulatedBody body =
        sim::ArticulatedBodyFrom(models[i].model, variant->model.objects[i].kinematics);
    const bool worked = variant->target && variant->target->object == static_cast<int>(i);
    // A convex hull has no wall and no handle to grasp.
    const bool only_moved = worked && body.joints().empty() && variant->target->rim == 0.0 &&
                            variant->target->grasps.empty();
    if (options.hulls && only_moved && !body.links.front().parts.empty()) UseConvexHull(&body);
    std::vector<int> joints;
    for (const tasks::ObjectJoint& joint : variant->model.objects[i].joints) {
      joints.push_back(body.kinematics->JointIndex(joint.name));
    }
    variant->body_joints.push_back(std::move(joints));
    variant->solids.push_back(manipulation::ConvexPartsOf(body));
    variant->bodies.push_back(std::make_shared<sim::PreparedBody>(std::move(body)));
    variant->visuals.push_back(assets::LinkVisuals(models[i].model));
  }
}

SkillVariant MakeVariant(const SkillSubtask& source, const robot::RobotModel& robot,
                         const SkillOptions& options) {
  SkillVariant variant;
  variant.model = tasks::MakeWorldModel(source.assets);
  variant.subtask = source.subtask;
  variant.start = tasks::StateOf(variant.model, source.subtask.start, source.subtask.goal);
  SkillPlaceObjects(&variant);
  CompileProgram(&variant);
  FindTarget(robot.gripper.MaxOpening(), &variant);
  FindGrasps(source, &variant);
  variant.next = NextDestination(source, variant, robot.gripper.MaxOpening());
  variant.room = FindReceptacle(variant);
  PrepareBodies(source.assets, options, &variant);
  if (variant.target && variant.target->joint >= 0) {
    variant.target->link_from_grasp = manipulation::ChooseApproach(robot, variant);
  }
  return variant;
}

// Returns true if two programs read the same kinds of inputs, so that one policy can observe both.
bool ReadSameInputs(const SkillVariant& a, const SkillVariant& b) {
  const auto kinds = [](const SkillVariant& variant) {
    std::vector<int> inputs;
    for (const reward::RewardSlot& slot : variant.program->slots()) {
      inputs.push_back(static_cast<int>(slot.input));
    }
    return inputs;
  };
  return kinds(a) == kinds(b) && a.target.has_value() == b.target.has_value() &&
         (!a.target || (a.target->joint >= 0) == (b.target->joint >= 0)) &&
         a.destination.has_value() == b.destination.has_value();
}

// Adds a variant for each of `subtasks`.
void AddVariants(const std::vector<SkillSubtask>& subtasks, Skill* skill) {
  for (const SkillSubtask& subtask : subtasks) {
    skill->variants.push_back(MakeVariant(subtask, *skill->robot, skill->options));
    if (!ReadSameInputs(skill->variants.front(), skill->variants.back())) {
      throw core::Error("its program reads other inputs than that of '" +
                            subtasks.front().subtask.name + "': one policy cannot learn both",
                        "subtask " + subtask.subtask.name);
    }
  }
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
  skill->robot_surface = manipulation::RobotSurface(robot, kSurfaceSpacing);
  skill->kinematics = std::make_shared<robot::PoseInverseKinematics>(robot.arm);
  skill->chain = std::make_shared<robot::ChainKinematics>(robot.arm);
  skill->options = options;
  skill->standoff = options.standoff;
  skill->later_skills = std::move(later);
  AddVariants(subtasks, skill.get());
  core::Log(core::LogLevel::kInfo, "skills", "prepared ", subtasks.front().subtask.name, " in ",
            subtasks.size(), " scenes");
  return skill;
}

std::shared_ptr<const Skill> InScenes(const Skill& skill,
                                      const std::vector<SkillSubtask>& subtasks) {
  if (subtasks.empty()) throw core::Error("a skill needs a subtask");
  auto other = std::make_shared<Skill>(skill);
  other->variants.clear();
  other->later_skills.clear();
  AddVariants(subtasks, other.get());
  return other;
}

}  // namespace simwright::skills
