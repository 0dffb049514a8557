#include "skills/skill_options.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace simwright::skills {
namespace {

bool IsRange(const FactorRange& range) {
  return range.low > 0.0 && range.high >= range.low && std::isfinite(range.high);
}

bool IsShare(double share) {
  return share >= 0.0 && share <= 1.0;
}

constexpr std::pair<ActionSpace, const char*> kActionSpaces[] = {
    {ActionSpace::kTargetFrame, "focus"}, {ActionSpace::kGuided, "guided"},
    {ActionSpace::kAbsolute, "absolute"}, {ActionSpace::kDelta, "delta"},
    {ActionSpace::kJoints, "joints"},     {ActionSpace::kJointTargets, "joint_targets"},
};

}  // namespace

std::string NameOf(ActionSpace space) {
  for (const auto& [known, name] : kActionSpaces) {
    if (known == space) return name;
  }
  return "";
}

ActionSpace ActionSpaceOf(const std::string& name) {
  std::string names;
  for (const auto& [space, known] : kActionSpaces) {
    if (name == known) return space;
    names += (names.empty() ? "" : ", ") + std::string(known);
  }
  throw core::Error("there is no action space '" + name + "'", "", "it is one of " + names);
}

bool CommandsJoints(ActionSpace space) {
  return space == ActionSpace::kJoints || space == ActionSpace::kJointTargets;
}

bool FollowsPlan(ActionSpace space) {
  return space == ActionSpace::kTargetFrame || space == ActionSpace::kGuided;
}

int SkillOptions::decisions() const {
  return static_cast<int>(std::ceil(episode_seconds / decision_seconds() - 1e-9));
}

SkillOptions SkillOptions::ForEvaluation() const {
  SkillOptions options = *this;
  options.at_target_share = 0.0;
  options.partly_open_share = 0.0;
  return options;
}

SkillOptions SkillOptions::WithoutRandomization() const {
  SkillOptions options = *this;
  options.position_range = options.furniture_yaw = options.configuration_range = 0.0;
  options.any_yaw = false;
  for (auto& [asset, range] : options.placement_ranges) range = {};
  options.mass = options.friction = options.joint = {1.0, 1.0};
  options.finger_friction.reset();
  options.longest_delay = 0;
  return options;
}

bool SkillOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!(control_rate > 0.0) || substeps < 1 || control_steps < 1) {
    return fail("control_rate, substeps and control_steps must be positive");
  }
  if (!(episode_seconds >= decision_seconds())) {
    return fail("episode_seconds must be at least one decision long");
  }
  if (!(hold_seconds >= 0.0)) return fail("hold_seconds must not be negative");
  if (contact_iterations < 1 || light_contact_iterations < 1 || free_iterations < 1) {
    return fail(
        "contact_iterations, light_contact_iterations and free_iterations must be positive");
  }
  if (!(standoff >= 0.0)) return fail("standoff must not be negative");
  if (!(reach > 0.0) || !(turn >= 0.0) || !(delta_share > 0.0)) {
    return fail("reach and delta_share must be positive, turn not negative");
  }
  if (!(tool_speed > 0.0) || !(turn_speed > 0.0) || !(longest_lead > 0.0)) {
    return fail("tool_speed, turn_speed and longest_lead must be positive");
  }
  if (!(position_range >= 0.0) || !(furniture_yaw >= 0.0) || !(configuration_range >= 0.0)) {
    return fail("position_range, furniture_yaw and configuration_range must not be negative");
  }
  for (const auto& [asset, range] : placement_ranges) {
    if (range.position >= 0.0 && range.yaw >= 0.0 && std::isfinite(range.position) &&
        std::isfinite(range.yaw)) {
      continue;
    }
    return fail("placement_ranges must not be negative");
  }
  if (!IsRange(mass) || !IsRange(friction) || !IsRange(joint)) {
    return fail("mass, friction and joint must be ranges of positive factors");
  }
  if (finger_friction && !IsRange(*finger_friction)) {
    return fail("finger_friction must be a range of positive coefficients");
  }
  if (longest_delay < 0) return fail("longest_delay must not be negative");
  if (!IsShare(at_target_share) || !IsShare(partly_open_share) ||
      at_target_share + partly_open_share > 1.0) {
    return fail("at_target_share and partly_open_share must be shares of one whole");
  }
  if (!IsShare(pool_share)) return fail("pool_share must be a share");
  if (!(discount > 0.0) || !(discount < 1.0)) return fail("discount must be between 0 and 1");
  return true;
}

}  // namespace simwright::skills
