#include "tasks/rules/step.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "tasks/language/scene_description.h"
#include "tasks/rules/affordances.h"

namespace simwright::tasks {
namespace {

constexpr double kAway = 0.7;         // share of a joint's range that counts as open, on, pressed
constexpr double kAtRest = 0.05;      // share below which it counts as closed, off
constexpr double kLiftHeight = 0.15;  // m
constexpr double kSide = 0.18;        // m; offset of the place where objects are put or pushed
constexpr double kTilt = 2.2;         // rad

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", std::abs(value) < 5e-4 ? 0.0 : value);
  std::string number = text;
  while (number.ends_with("0") && !number.ends_with(".0")) number.pop_back();
  return number;
}

std::string Triple(const Eigen::Vector3d& v) {
  return "torch.tensor([" + Number(v.x()) + ", " + Number(v.y()) + ", " + Number(v.z()) +
         "], device=env.device)";
}

// A builder of a function, line by line.
class Program {
 public:
  explicit Program(std::string comment) {
    // A link's name may contain a line break, which would end the comment.
    std::replace_if(
        comment.begin(), comment.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    Line("# " + comment);
  }
  Program& Line(const std::string& line) {
    text_ += "    " + line + "\n";
    return *this;
  }
  std::string Text() const { return "def compute_reward(env):\n" + text_; }
  void Returns() { Line("return reward, success"); }

 private:
  std::string text_;
};

void AddReach(const std::string& target, Program* program) {
  program->Line("gripper = env.get_robot_gripper_pose()")
      .Line("reach = torch.norm(gripper - " + target + ", dim=-1)");
}

struct Verbs {
  const char *away, *away_name, *back, *back_name;
};

Verbs VerbsOf(JointUse use) {
  switch (use) {
    case JointUse::kSlide:
      return {"Slide open", "slide_open", "Slide closed", "slide_closed"};
    case JointUse::kTurn:
      return {"Turn on", "turn_on", "Turn off", "turn_off"};
    case JointUse::kLatch:
      return {"Turn", "turn", "Turn back", "turn_back"};
    case JointUse::kSwitch:
      return {"Switch on", "switch_on", "Switch off", "switch_off"};
    case JointUse::kPress:
      return {"Press", "press", "Release", "release"};
    default:
      return {"Open", "open", "Close", "close"};
  }
}

// Returns the share of its range that the joint has moved, as an expression of `state` and
// `limits`; for a continuous joint, the share of half a turn.
std::string ShareText(const ObjectJoint& joint) {
  if (joint.type == reward::RewardJointType::kContinuous) return "state / " + Number(joint.far());
  const bool up = joint.far() == joint.upper;
  const std::string far = up ? "limits[\"upper\"]" : "limits[\"lower\"]";
  const std::string near = up ? "limits[\"lower\"]" : "limits[\"upper\"]";
  const double rest = joint.rest();
  if (rest == (up ? joint.lower : joint.upper)) {
    return "(state - " + near + ") / (" + far + " - " + near + ")";
  }
  if (rest == 0.0) return "state / " + far;
  return "(state - " + Number(rest) + ") / (" + far + " - " + Number(rest) + ")";
}

Step JointStep(const WorldModel& model, const Operator& one) {
  const ArticulatedObject& object = model.objects[static_cast<std::size_t>(one.object)];
  const ObjectJoint& joint = object.joints[static_cast<std::size_t>(one.part)];
  const bool away = one.verb == ActionType::kOpen;
  const Verbs verbs = VerbsOf(GetJointUse(object, joint));
  const std::string part = PartName(object, joint);
  const std::string grip = object.LinkName(joint.grasp_link);
  Step step;
  step.name = NameFrom(std::string(away ? verbs.away_name : verbs.back_name) + "_" + object.name +
                       "_" + part);
  const bool numbered = std::isdigit(static_cast<unsigned char>(part.back())) != 0;
  const bool itself = object.category == part;  // for example the door of a door
  step.description = std::string(away ? verbs.away : verbs.back) + (numbered ? " " : " the ") +
                     (itself ? SpokenName(object) : part + " of the " + SpokenName(object)) + ".";
  Program program("Reach for the " + grip + ", then move the joint.");
  program.Line("handle = env.get_pose_by_link_name(" + Quoted(object.name) + ", " + Quoted(grip) +
               ")");
  AddReach("handle", &program);
  const std::string names = Quoted(object.name) + ", " + Quoted(joint.name);
  program.Line("state = env.get_state_by_joint_name(" + names + ")");
  if (joint.type != reward::RewardJointType::kContinuous) {
    program.Line("limits = env.get_limits_by_joint_name(" + names + ")");
  }
  program.Line("moved = " + ShareText(joint));
  if (away) {
    program.Line("reward = 2.0 * torch.clamp(moved, max=1.0) - reach")
        .Line("success = moved >= " + Number(kAway));
  } else {
    program.Line("reward = -2.0 * torch.clamp(moved, min=0.0) - reach")
        .Line("success = moved <= " + Number(kAtRest));
  }
  program.Returns();
  step.program = program.Text();
  step.success = joint.name + " of " + object.name +
                 (away ? " past " + std::to_string(std::lround(100.0 * kAway)) + " % of its way"
                       : " within 5 % of its rest");
  const double target = away ? joint.joint_target() : joint.rest();
  step.action = {ActionKind::kMoveJoint, one.object, one.part, target, Eigen::Vector3d::Zero()};
  return step;
}

Step PickStep(const WorldModel& model, const WorldState& state, const Operator& one) {
  const ArticulatedObject& object = model.objects[static_cast<std::size_t>(one.object)];
  const std::string spoken = SpokenName(object), name = Quoted(object.name);
  Step step;
  step.name = NameFrom("pick_up_" + object.name);
  step.description = "Pick up the " + spoken + ".";
  const Eigen::Vector3d middle = LinkPosition(model, state, one.object, 0);
  Eigen::Vector3d raised = middle + Eigen::Vector3d(0, 0, kLiftHeight);
  if (one.part >= 0) {
    // The object leaves through the opening first, then moves up.
    const ArticulatedObject& holder = model.objects[static_cast<std::size_t>(one.other)];
    step.name += NameFrom("_from_" + holder.name);
    step.description = "Take the " + spoken + " out of the " + SpokenName(holder) + ".";
    const Receptacle& receptacle = holder.receptacles[static_cast<std::size_t>(one.part)];
    const auto h = static_cast<std::size_t>(one.other);
    const Eigen::Isometry3d link =
        state.roots[h] *
        LinkPosesOf(holder, state.joints[h])[static_cast<std::size_t>(receptacle.link)];
    const Eigen::Vector3d out = link.linear() * receptacle.opening;
    const double depth = std::abs(receptacle.box.sizes().dot(receptacle.opening));
    raised = middle + (0.6 * depth + 0.5 * object.box.sizes().maxCoeff() + 0.05) * out;
  } else if (one.other >= 0) {
    step.name += NameFrom("_from_" + model.objects[static_cast<std::size_t>(one.other)].name);
  }
  step.goal = raised;
  Program program("Grasp the " + spoken + " and bring it to the goal.");
  program.Line("thing = env.get_position(" + name + ")");
  AddReach("thing", &program);
  program.Line("grasped = env.check_grasped(" + name + ")")
      .Line("missing = torch.norm(env.get_goal_pose() - thing, dim=-1)")
      .Line("reward = grasped.float() - reach - 2.0 * missing")
      .Line("success = torch.logical_and(grasped, missing <= 0.03)");
  program.Returns();
  step.program = program.Text();
  step.success = object.name + " held within 3 cm of the goal";
  step.action = {ActionKind::kCarry, one.object, -1, 0.0, raised};
  return step;
}

// Returns `point` moved by kSide along the robot's y axis, towards its x axis.
Eigen::Vector3d MovedAside(const Eigen::Vector3d& point,
                           const Eigen::Isometry3d& world_from_robot) {
  const Eigen::Vector3d left = world_from_robot.linear().col(1);
  const double aside = left.dot(point - world_from_robot.translation());
  return point + (aside > 0.0 ? -kSide : kSide) * left;
}

// Returns a position on the floor beside the object, on the side nearer to the robot's x axis.
Eigen::Vector3d BesideOf(const WorldModel& model, const WorldState& state, int object,
                         const Eigen::Isometry3d& world_from_robot) {
  const ArticulatedObject& known = model.objects[static_cast<std::size_t>(object)];
  Eigen::Vector3d target = MovedAside(LinkPosition(model, state, object, 0), world_from_robot);
  target.z() = known.links[0].middle.z() - known.box.min().z();
  return target;
}

Step PutDownStep(const WorldModel& model, const WorldState& state, const Operator& one,
                 const Eigen::Isometry3d& world_from_robot) {
  const ArticulatedObject& object = model.objects[static_cast<std::size_t>(one.object)];
  const std::string name = Quoted(object.name);
  Step step;
  step.name = NameFrom("put_down_" + object.name);
  step.description = "Put the " + SpokenName(object) + " down at the goal.";
  step.goal = BesideOf(model, state, one.object, world_from_robot);
  Program program("Bring the " + SpokenName(object) + " to the goal and let go of it.");
  program.Line("thing = env.get_position(" + name + ")")
      .Line("distance = torch.norm(env.get_goal_pose() - thing, dim=-1)")
      .Line("there = distance <= 0.03")
      .Line("released = torch.logical_not(env.check_grasped(" + name + "))")
      .Line("success = torch.logical_and(there, released)")
      .Line("reward = there.float() + success.float() - 2.0 * distance");
  program.Returns();
  step.program = program.Text();
  step.success = object.name + " within 3 cm of the goal, not held";
  step.action = {ActionKind::kPlace, one.object, -1, 0.0, *step.goal};
  return step;
}

Step PlaceOnStep(const WorldModel& model, const WorldState& state, const Operator& one) {
  const ArticulatedObject& object = model.objects[static_cast<std::size_t>(one.object)];
  const ArticulatedObject& holder = model.objects[static_cast<std::size_t>(one.other)];
  Step step;
  step.name = NameFrom("place_" + object.name + "_on_" + holder.name);
  step.description = "Place the " + SpokenName(object) + " on the " + SpokenName(holder) + ".";
  Program program("Stand the " + SpokenName(object) + " on top and let go of it.");
  program
      .Line("low, high = env.get_bounding_box_link(" + Quoted(holder.name) + ", " +
            Quoted(holder.LinkName(0)) + ")")
      .Line("top = 0.5 * (low + high)")
      .Line("top[:, 2] = high[:, 2]")
      .Line("foot_low, foot_high = env.get_bounding_box(" + Quoted(object.name) + ")")
      .Line("foot = 0.5 * (foot_low + foot_high)")
      .Line("foot[:, 2] = foot_low[:, 2]")
      .Line("distance = torch.norm(top - foot, dim=-1)")
      .Line("there = distance <= 0.03")
      .Line("released = torch.logical_not(env.check_grasped(" + Quoted(object.name) + "))")
      .Line("success = torch.logical_and(there, released)")
      .Line("reward = there.float() + success.float() - 2.0 * distance");
  program.Returns();
  step.program = program.Text();
  step.success = "the foot of " + object.name + " within 3 cm of the middle of " + holder.name +
                 "'s top, not held";
  const Eigen::AlignedBox3d body = WorldAabb(model, state, one.other, 0);
  Eigen::Vector3d target = body.center();
  target.z() = body.max().z() + 0.5 * object.height() + 1e-3;
  step.action = {ActionKind::kPlace, one.object, -1, 0.0, target};
  return step;
}

// Returns the position of the object's centre in a receptacle (world frame): the receptacle's
// centre, or else a position beside it that is free of other objects.
Eigen::Vector3d FreePosition(const WorldModel& model, const WorldState& state, int object,
                             const Eigen::AlignedBox3d& receptacle) {
  const Eigen::Vector3d size = model.objects[static_cast<std::size_t>(object)].box.sizes();
  Eigen::Vector3d middle = receptacle.center();
  middle.z() = receptacle.min().z() + 0.5 * size.z() + 1e-3;
  const Eigen::Vector3d spare = (0.5 * (receptacle.sizes() - size)).cwiseMax(0.0);
  for (const auto& [x, y] :
       {std::pair{0.0, 0.0}, {0.0, 0.9}, {0.0, -0.9}, {0.9, 0.0}, {-0.9, 0.0}}) {
    const Eigen::Vector3d spot = middle + Eigen::Vector3d(x * spare.x(), y * spare.y(), 0.0);
    const Eigen::AlignedBox3d taken(spot - 0.5 * size, spot + 0.5 * size);
    bool is_free = true;
    for (std::size_t other = 0; other < model.objects.size(); ++other) {
      if (static_cast<int>(other) == object || model.objects[other].articulated()) continue;
      is_free = is_free && !taken.intersects(WorldAabb(model, state, static_cast<int>(other)));
    }
    if (is_free) return spot;
  }
  return middle;
}

// Shrinks a receptacle (world frame) to the positions of the centre of an object of `size` at which
// the door can close: removes half of the size at the opening, on the side that `opening` (unit,
// world) points to. `target`, which is inside, remains inside.
void KeepBehindDoor(const Eigen::Vector3d& opening, const Eigen::Vector3d& size,
                    const Eigen::Vector3d& target, Eigen::AlignedBox3d* receptacle) {
  Eigen::Index side = 0;
  opening.cwiseAbs().maxCoeff(&side);
  const double half = 0.5 * std::max(size.x(), size.y());
  if (side == 2) return;
  if (opening[side] > 0.0) {
    receptacle->max()[side] = std::max(receptacle->max()[side] - half, target[side]);
  } else {
    receptacle->min()[side] = std::min(receptacle->min()[side] + half, target[side]);
  }
}

Step PutIntoStep(const WorldModel& model, const WorldState& state, const Operator& one) {
  const ArticulatedObject& object = model.objects[static_cast<std::size_t>(one.object)];
  const ArticulatedObject& holder = model.objects[static_cast<std::size_t>(one.other)];
  const Receptacle& receptacle = holder.receptacles[static_cast<std::size_t>(one.part)];
  const std::string& link = holder.LinkName(receptacle.link);
  const auto h = static_cast<std::size_t>(one.other);
  const Eigen::Isometry3d pose =
      state.roots[h] *
      LinkPosesOf(holder, state.joints[h])[static_cast<std::size_t>(receptacle.link)];
  // The receptacle is expressed as shares of the link's AABB, so it moves with the link.
  Eigen::AlignedBox3d space;
  for (int corner = 0; corner < 8; ++corner) {
    space.extend(pose *
                 receptacle.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  const Eigen::AlignedBox3d box = WorldAabb(model, state, one.other, receptacle.link);
  const Eigen::Vector3d size = box.sizes().cwiseMax(1e-6);
  const Eigen::Vector3d target = FreePosition(model, state, one.object, space);
  // An object that protrudes from a cup has its centre above the cup's receptacle.
  const double lift = std::max(0.0, target.z() + 0.02 - space.max().z());
  if (receptacle.door >= 0) {
    KeepBehindDoor(pose.linear() * receptacle.opening, object.box.sizes(), target, &space);
  }
  const Eigen::Vector3d low = (space.min() - box.min()).cwiseQuotient(size);
  const Eigen::Vector3d high =
      (space.max() + Eigen::Vector3d(0, 0, lift) - box.min()).cwiseQuotient(size);
  const Eigen::Vector3d wanted = (target - box.min()).cwiseQuotient(size);
  Step step;
  step.name = NameFrom("put_" + object.name + "_into_" + holder.name);
  step.description = "Put the " + SpokenName(object) + " into the " + SpokenName(holder) + ".";
  Program program("Bring the " + SpokenName(object) + " inside and let go of it.");
  program.Line("thing = env.get_position(" + Quoted(object.name) + ")")
      .Line("low, high = env.get_bounding_box_link(" + Quoted(holder.name) + ", " + Quoted(link) +
            ")")
      .Line("size = high - low")
      .Line("inside = env.in_bbox(thing, low + size * " + Triple(low) + ",")
      .Line("                     low + size * " + Triple(high) + ")")
      .Line("distance = torch.norm(low + size * " + Triple(wanted) + " - thing, dim=-1)")
      .Line("released = torch.logical_not(env.check_grasped(" + Quoted(object.name) + "))")
      .Line("success = torch.logical_and(inside, released)")
      .Line("reward = inside.float() + success.float() - 2.0 * distance");
  program.Returns();
  step.program = program.Text();
  step.success =
      "the middle of " + object.name + " inside " + link + " of " + holder.name + ", not held";
  step.action = {ActionKind::kPlace, one.object, -1, 0.0, target};
  return step;
}

Step PushStep(const WorldModel& model, const WorldState& state, const Operator& one,
              const Eigen::Isometry3d& world_from_robot) {
  const ArticulatedObject& object = model.objects[static_cast<std::size_t>(one.object)];
  Step step;
  step.name = NameFrom("push_" + object.name);
  step.description = "Push the " + SpokenName(object) + " along the floor to the goal.";
  const Eigen::Vector3d goal =
      MovedAside(LinkPosition(model, state, one.object, 0), world_from_robot);
  step.goal = goal;
  Program program("Reach for the " + SpokenName(object) + " and push it to the goal.");
  program.Line("thing = env.get_position(" + Quoted(object.name) + ")");
  AddReach("thing", &program);
  program.Line("goal = env.get_goal_pose()")
      .Line("distance = torch.norm(goal[:, :2] - thing[:, :2], dim=-1)")
      .Line("reward = -2.0 * distance - 0.5 * reach")
      .Line("success = distance <= 0.03");
  program.Returns();
  step.program = program.Text();
  step.success = object.name + " within 3 cm of the goal, seen from above";
  step.action = {ActionKind::kPush, one.object, -1, 0.0, goal};
  return step;
}

Step PourStep(const WorldModel& model, const WorldState& state, const Operator& one) {
  const ArticulatedObject& object = model.objects[static_cast<std::size_t>(one.object)];
  const ArticulatedObject& holder = model.objects[static_cast<std::size_t>(one.other)];
  Step step;
  step.name = NameFrom("pour_" + object.name + "_over_" + holder.name);
  step.description = "Hold the " + SpokenName(object) + " over the " + SpokenName(holder) +
                     " and tilt it as if to pour.";
  const Eigen::AlignedBox3d box = WorldAabb(model, state, one.other);
  Eigen::Vector3d above = box.center();
  above.z() = box.max().z() + 0.5 * object.box.sizes().maxCoeff() + 0.05;
  Program program("Hold it above, then tilt it: upright is 1, on its side 0, upside down -1.");
  program.Line("thing = env.get_position(" + Quoted(object.name) + ")")
      .Line("low, high = env.get_bounding_box(" + Quoted(holder.name) + ")")
      .Line("above = 0.5 * (low + high)")
      .Line("above[:, 2] = high[:, 2] + " + Number(above.z() - box.max().z()))
      .Line("distance = torch.norm(above - thing, dim=-1)")
      .Line("turn = env.get_orientation(" + Quoted(object.name) + ")")
      .Line("upright = 1.0 - 2.0 * (turn[:, 0] ** 2 + turn[:, 1] ** 2)")
      .Line("near = distance <= 0.1")
      .Line("reward = -2.0 * distance - torch.where(near, upright, torch.ones_like(upright))")
      .Line("success = torch.logical_and(near, upright <= -0.2)");
  program.Returns();
  step.program = program.Text();
  step.success = object.name + " above " + holder.name + ", tilted by more than 100 degrees";
  step.action = {ActionKind::kTilt, one.object, -1, kTilt, above};
  return step;
}

}  // namespace

std::string NameFrom(std::string text) {
  const auto other = [](unsigned char c) { return c < 0x80 && std::isalnum(c) == 0; };
  std::replace_if(text.begin(), text.end(), other, '_');
  return text;
}

std::string SpokenName(const ArticulatedObject& object) {
  std::string name = object.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

Step MakeStep(const WorldModel& model, const WorldState& state, const Operator& one,
              const Eigen::Isometry3d& world_from_robot) {
  switch (one.verb) {
    case ActionType::kOpen:
    case ActionType::kClose:
      return JointStep(model, one);
    case ActionType::kPick:
      return PickStep(model, state, one);
    case ActionType::kPlaceOn:
      return PlaceOnStep(model, state, one);
    case ActionType::kPutInto:
      return PutIntoStep(model, state, one);
    case ActionType::kPutDown:
      return PutDownStep(model, state, one, world_from_robot);
    case ActionType::kPush:
      return PushStep(model, state, one, world_from_robot);
    default:
      return PourStep(model, state, one);
  }
}

}  // namespace simwright::tasks
