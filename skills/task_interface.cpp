#include "skills/task_interface.h"

#include <algorithm>

#include "core/json.h"
#include "core/random.h"
#include "manipulation/reach_plan.h"
#include "manipulation/target_frame.h"
#include "skills/observation.h"

namespace simwright::skills {
namespace {

using core::OrderedJson;

OrderedJson JsonOf(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

OrderedJson ConfigurationJson(const robot::JointVector& v) {
  return std::vector<double>(v.data(), v.data() + v.size());
}

OrderedJson JsonOf(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return {{"position", JsonOf(Eigen::Vector3d(pose.translation()))},
          {"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}}};
}

const assets::TreeBody& BodyNamed(const TaskWorld& world, const std::string& name) {
  return *std::find_if(world.bodies.begin(), world.bodies.end(),
                       [&](const assets::TreeBody& body) { return body.name == name; });
}

OrderedJson RobotJson(const robot::RobotModel& robot, const TaskWorld& world) {
  const assets::TreeBody& body = world.bodies.front();
  OrderedJson arm = OrderedJson::array(), fingers = OrderedJson::array();
  for (size_t j = 0; j < robot.arm_joints.size(); ++j) {
    const robot::JointLimits& limits = robot.limits[static_cast<size_t>(robot.arm_joints[j])];
    arm.push_back({{"joint", assets::TreeJointName(body, robot.arm_joints[j])},
                   {"lower", robot.arm.joints[j].lower},
                   {"upper", robot.arm.joints[j].upper},
                   {"velocity", limits.velocity},
                   {"acceleration", limits.acceleration}});
  }
  for (size_t f = 0; f < robot.gripper.joints.size(); ++f) {
    fingers.push_back({{"joint", assets::TreeJointName(body, robot.gripper.joints[f])},
                       {"body", assets::TreeLinkName(body, robot.gripper.links[f])}});
  }
  const robot::JointLimits& finger =
      robot.limits[static_cast<size_t>(robot.gripper.joints.front())];
  return {{"world_from_base", JsonOf(body.world_from_root)},
          {"arm", arm},
          {"tool_body", assets::TreeLinkName(body, robot.tool_link)},
          {"fingers", fingers},
          {"closed", robot.gripper.closed},
          {"open", robot.gripper.open},
          {"opening_ratio", robot.gripper.opening_ratio},
          {"finger_velocity", finger.velocity},
          {"finger_acceleration", finger.acceleration}};
}

OrderedJson JointJson(const SkillVariant& variant, const TaskWorld& world, int object, int joint) {
  const auto t = static_cast<size_t>(object), j = static_cast<size_t>(joint);
  const tasks::ArticulatedObject& known = variant.model.objects[t];
  const tasks::ObjectJoint& read = known.joints[j];
  const assets::TreeBody& body = BodyNamed(world, known.name);
  return {{"joint", assets::TreeJointName(body, variant.body_joints[t][j])},
          {"body", assets::TreeLinkName(
                       body, body.kinematics->FindLink(
                                 known.kinematics->links()[static_cast<size_t>(read.link)].name))},
          {"prismatic", read.type == reward::RewardJointType::kPrismatic},
          {"axis", JsonOf(read.axis)},
          {"lower", read.lower},
          {"upper", read.upper},
          {"target", read.joint_target()}};
}

OrderedJson ObjectJson(const SkillVariant& variant, const TaskWorld& world, int object) {
  const tasks::ArticulatedObject& known = variant.model.objects[static_cast<size_t>(object)];
  return {{"body", assets::TreeLinkName(BodyNamed(world, known.name), 0)},
          {"center", JsonOf(known.links.front().middle)},
          {"size", JsonOf(Eigen::Vector3d(known.box.sizes()))}};
}

OrderedJson TargetJson(const Skill& skill, const SkillVariant& variant, const TaskWorld& world,
                       const StartState& start) {
  const manipulation::InteractionTarget& target = *variant.target;
  const auto t = static_cast<size_t>(target.object);
  const tasks::ArticulatedObject& known = variant.model.objects[t];
  const assets::TreeBody& body = BodyNamed(world, known.name);
  const Eigen::Isometry3d grasp =
      robot::ForwardKinematics(skill.robot->arm, start.grasp_configuration);
  // The gripper of a start state is not where the robot of the world is.
  tasks::WorldState state = start.state;
  state.grasped = false;
  const manipulation::TargetFrame frame(
      variant, state, variant.subtask.start.world_from_robot.linear() * grasp.linear().col(1),
      start.pitch, start.retreat, start.grasp);
  // A part's frame moves with its link, a free object's with the object.
  const auto link = static_cast<size_t>(target.joint >= 0 ? target.link : 0);
  const Eigen::Isometry3d world_from_link =
      start.state.roots[t] * tasks::LinkPosesOf(known, start.state.joints[t])[link];
  OrderedJson json = ObjectJson(variant, world, target.object);
  const std::string& name = known.kinematics->links()[link].name;
  json["link"] = assets::TreeLinkName(body, body.kinematics->FindLink(name));
  json["link_from_target"] = JsonOf(world_from_link.inverse() * frame.world_from_target());
  json["grasps_object"] = target.joint < 0 && !manipulation::Pushes(variant);
  json["pushes"] = target.pushes || manipulation::Pushes(variant);
  json["lean"] = frame.lean();
  json["back"] = JsonOf(frame.back());
  json["retreat_distance"] = frame.retreat_distance();
  json["motion_direction"] = JsonOf(frame.motion_direction());
  json["grasp_configuration"] = ConfigurationJson(start.grasp_configuration);
  json["waypoints"] = OrderedJson::array();
  for (const robot::JointVector& waypoint : start.waypoints) {
    json["waypoints"].push_back(ConfigurationJson(waypoint));
  }
  json["points"] = OrderedJson::array();  // of the shapes, in their links' frames
  for (size_t l = 0; l < known.links.size(); ++l) {
    if (target.joint >= 0 && static_cast<int>(l) != target.link) continue;
    OrderedJson points = OrderedJson::array();
    for (const Eigen::Vector3d& point : known.links[l].extreme_points) {
      points.push_back(JsonOf(point));
    }
    const std::string& owner = known.kinematics->links()[l].name;
    json["points"].push_back(
        {{"body", assets::TreeLinkName(body, body.kinematics->FindLink(owner))},
         {"points", points}});
  }
  json["joint"] = target.joint < 0 ? OrderedJson(nullptr)
                                   : JointJson(variant, world, target.object, target.joint);
  return json;
}

// Returns the layout of the observation, one entry per group (Observer). A number of the
// observation is the quantity divided by `unit`.
OrderedJson LayoutJson(const Skill& skill, const SkillVariant& variant, size_t joints,
                       size_t objects) {
  OrderedJson layout = OrderedJson::array();
  int at = 0;
  const auto add = [&](const char* name, int size, const char* quantity, double unit) {
    layout.push_back(
        {{"name", name}, {"start", at}, {"size", size}, {"quantity", quantity}, {"unit", unit}});
    at += size;
  };
  const int arm = skill.robot->arm.size();
  add("arm_position", arm, "2 (q - middle) / (upper - lower) of each arm joint", 1.0);
  add("arm_velocity", arm, "rad/s or m/s", 2.0);
  add("tool_position", 3, "m, of the tool in the target frame", 0.1);
  add("tool_rotation", 6, "y and z axes of the tool in the target frame", 1.0);
  add("opening", 1, "2 opening / largest opening - 1", 1.0);
  add("opening_command", 1, "the same of the command", 1.0);
  add("touches", 1, "1 if a finger touches the target object", 1.0);
  add("grasps", 1, "1 if both fingers press on it with more than 1 N", 1.0);
  add("frame_position", 3, "m, of the target frame in the robot's base frame", 0.5);
  add("frame_rotation", 6, "y and z axes of the target frame in the base frame", 1.0);
  add("frame_state", 1, "1 if the frame is at the destination, -1 in a retreat, else 0", 1.0);
  for (size_t j = 0; j < joints; ++j) {
    add("joint_position", 1, "2 (q - lower) / (upper - lower) - 1 of a joint of program_joints",
        1.0);
    add("joint_velocity", 1, "change since the last decision / (upper - lower), 1/s", 1.0);
  }
  if (variant.target) {
    add("object_position", 3, "m, of the object's centre from the tool, target axes", 0.1);
    add("object_up", 3, "z axis of the object, target axes", 1.0);
    add("object_velocity", 3, "m/s, target axes", 0.5);
    add("object_size", 3, "m, of the object's box in its own axes", 0.1);
    add("part_size", 3, "m, of the part's box in target axes", 0.1);
    if (variant.target->joint >= 0) {
      add("part_center", 3, "m, centre of that box in the target frame", 0.1);
      add("part_motion", 3, "direction in which the part moves as its joint increases", 1.0);
      add("part_hinge", 3, "m, to the nearest point of the joint's axis; 0 if it slides", 0.5);
    }
  }
  for (size_t o = 0; o < objects; ++o) {
    add("other_position", 3, "m, of another object from the tool, target axes", 0.5);
    add("other_up", 3, "its z axis, target axes", 1.0);
    add("other_size", 3, "m, of its box", 0.1);
  }
  if (variant.destination) {
    add("to_destination", 3, "m, from the object's centre to its destination, target axes", 0.1);
  }
  add("last_action", ActionSize(skill), "the last action", 1.0);
  return layout;
}

OrderedJson OptionsJson(const SkillOptions& options) {
  return {{"action_space", NameOf(options.action)},
          {"control_rate_hz", options.control_rate},
          {"control_steps", options.control_steps},
          {"reach", options.reach},
          {"turn", options.turn},
          {"standoff", options.standoff},
          {"tool_speed", options.tool_speed},
          {"turn_speed", options.turn_speed},
          {"longest_lead", options.longest_lead},
          {"episode_seconds", options.episode_seconds},
          {"hold_seconds", options.hold_seconds}};
}

}  // namespace

StartState TaskStart(const Skill& skill, std::optional<std::uint64_t> seed) {
  core::Rng rng(seed.value_or(1));
  if (seed) return SampleStart(skill, rng);
  StartState start;
  start.state = skill.variants.front().start;
  start.arm = skill.robot->home();
  start.leader = skill.robot->gripper.open;
  const size_t objects = skill.variants.front().model.objects.size();
  start.mass.assign(objects, 1.0);
  start.friction.assign(objects, 1.0);
  start.joint.assign(objects, 1.0);
  return PlannedFrom(skill, start, rng, Resampling::kNothing);
}

std::string TaskInterfaceJson(const std::string& subtask, const Skill& skill,
                              const TaskWorld& world, const StartState& start) {
  const SkillVariant& variant = skill.variants.front();
  OrderedJson json = {{"format", 1},
                      {"subtask", subtask},
                      {"success", variant.subtask.success},
                      {"options", OptionsJson(skill.options)},
                      {"robot", RobotJson(*skill.robot, world)}};
  const Observer observer(skill, variant);
  json["program_joints"] = json["other_objects"] = OrderedJson::array();
  for (const auto& [object, joint] : observer.joints()) {
    json["program_joints"].push_back(JointJson(variant, world, object, joint));
  }
  for (const int object : observer.objects()) {
    json["other_objects"].push_back(ObjectJson(variant, world, object));
  }
  json["target"] = variant.target ? TargetJson(skill, variant, world, start) : OrderedJson(nullptr);
  const bool goal = variant.destination && variant.destination->goal;
  json["goal"] = goal ? JsonOf(start.state.goal) : OrderedJson(nullptr);
  json["observation_size"] = observer.size();
  json["observation"] =
      LayoutJson(skill, variant, observer.joints().size(), observer.objects().size());
  return core::JsonText(json);
}

}  // namespace simwright::skills
