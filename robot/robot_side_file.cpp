#include "robot/robot_side_file.h"

#include "core/error.h"
#include "core/json.h"

namespace simwright::robot {
namespace {

using core::JsonField;

constexpr std::uint64_t kMaxSideFileBytes = 1 << 20;

StatedLimits LimitsFrom(const JsonField& field) {
  field.RequireMembers({}, {"velocity", "acceleration", "jerk", "effort"});
  StatedLimits limits;
  const auto stated = [&](const char* name) {
    return field.Has(name) ? std::optional<double>(field[name].PositiveNumber()) : std::nullopt;
  };
  limits.velocity = stated("velocity");
  limits.acceleration = stated("acceleration");
  limits.jerk = stated("jerk");
  limits.effort = stated("effort");
  return limits;
}

LimitMargin MarginFrom(const JsonField& field) {
  field.RequireMembers({"absolute", "delay"});
  const LimitMargin margin{field["absolute"].Number(), field["delay"].Number()};
  if (margin.absolute < 0.0 || margin.delay < 0.0) field.Fail("a margin is negative");
  return margin;
}

void ReadGripper(const JsonField& field, RobotSideFile* side) {
  field.RequireMembers({"joints", "finger_links", "closed", "open"},
                       {"opening_ratio", "grip_force"});
  side->gripper_joints = field["joints"].Names();
  if (side->gripper_joints.empty()) field["joints"].Fail("names no joints");
  side->finger_links = field["finger_links"].Names();
  if (side->finger_links.empty()) field["finger_links"].Fail("names no links");
  side->closed = field["closed"].Number();
  side->open = field["open"].Number();
  if (side->closed == side->open) field.Fail("'closed' and 'open' are the same position");
  if (field.Has("opening_ratio")) side->opening_ratio = field["opening_ratio"].PositiveNumber();
  if (field.Has("grip_force")) side->grip_force = field["grip_force"].PositiveNumber();
}

}  // namespace

RobotSideFile ReadRobotSideFile(const std::filesystem::path& path) {
  const std::string file = path.string();
  if (!std::filesystem::exists(path)) {
    throw core::Error("the robot's side file is missing", file,
                      "docs/robots.md shows its contents");
  }
  const core::JsonDocument document = core::JsonDocument::Read(path, kMaxSideFileBytes);
  const JsonField root = document.root();
  root.RequireMembers({"format", "tool_link", "arm_joints", "home", "gripper"},
                      {"base_joints", "limits", "margin", "ignored_collisions"});
  if (root["format"].Integer() != 1) root["format"].Fail("must be 1");
  RobotSideFile side;
  side.tool_link = root["tool_link"].Name();
  if (root.Has("base_joints")) side.base_joints = root["base_joints"].Names();
  side.arm_joints = root["arm_joints"].Names();
  for (const auto& [name, field] : root["home"].Members()) side.home[name] = field.Number();
  if (root.Has("limits")) {
    for (const auto& [name, field] : root["limits"].Members()) {
      side.limits[name] = LimitsFrom(field);
    }
  }
  if (root.Has("margin")) side.margin = MarginFrom(root["margin"]);
  ReadGripper(root["gripper"], &side);
  if (root.Has("ignored_collisions")) {
    for (const JsonField& pair : root["ignored_collisions"].Elements()) {
      const std::vector<std::string> names = pair.Names();
      if (names.size() != 2) pair.Fail("must name two links");
      side.ignored_collisions.emplace_back(names[0], names[1]);
    }
  }
  return side;
}

}  // namespace simwright::robot
