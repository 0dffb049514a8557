#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::tasks {

// What one input of a program holds; [width], SI units, world frame, quaternions xyzw.
enum class RewardInput {
  kLinkPosition,         // [3] m
  kLinkOrientation,      // [4]
  kLinkLinearVelocity,   // [3] m/s
  kLinkAngularVelocity,  // [3] rad/s
  kLinkBoundingBox,      // [6] m: lowest corner, highest corner, along the world's axes
  kAssetPosition,        // as the five above, of the asset's root
  kAssetOrientation,
  kAssetLinearVelocity,
  kAssetAngularVelocity,
  kAssetBoundingBox,
  kGripperPosition,         // [3] m, between the fingertips
  kGripperOrientation,      // [4]
  kGripperLinearVelocity,   // [3] m/s
  kGripperAngularVelocity,  // [3] rad/s
  kGripperOpening,          // [1] m between the fingers
  kGripperContact,          // [1] 1 where a finger touches the asset (or link), any where unnamed
  kGrasped,                 // [1] 1 where both fingers hold the asset (or link)
  kJointState,              // [1] rad or m
  kJointVelocity,           // [1] rad/s or m/s
  kJointLower,              // [1] rad or m, one for all environments
  kJointUpper,              // [1]
  kGoalPosition,            // [3] m
  kParameter,               // a parameter of the reward function
};

// A short stable name, e.g. "link_position".
std::string_view RewardInputName(RewardInput input);

// What a call of the environment's API gives.
enum class ApiResult {
  kVector,     // [N, width], or [N] where the width is 1
  kFlag,       // [N], true or false
  kLimits,     // {"lower": ..., "upper": ...}, also by [0] and [1]
  kLimitPair,  // (lower, upper)
  kLower,      // a scalar
  kUpper,      // a scalar
  kBox,        // (lowest corner [N, 3], highest corner [N, 3])
  kPose,       // (position [N, 3], orientation [N, 4])
  kInsideBox,  // [N]: a point inside a box
  kDistance,   // [N]: between two points
};

// One function of the environment's API. It can be called on the environment, env.f("cup"), and
// then gives a row an environment; or as a helper that is handed the environment, f(env, "cup"),
// and then gives the value of one environment, without the leading N.
struct ApiFunction {
  std::string_view names;      // the first one is the name proper, the others mean the same
  std::string_view arguments;  // of asset, link, joint, point, low, high; "?" may be left out
  ApiResult result;
  RewardInput input;  // with a link; where none is named, the asset's
  int width;
  std::string_view document;  // one line
};

std::span<const ApiFunction> EnvironmentApi();

// Null where there is no such function.
const ApiFunction* FindApiFunction(std::string_view name);

// All names and aliases.
std::vector<std::string> ApiNames();

// True for the names that a parameter has which is the environment: env, self, simulator, envs.
bool IsEnvironmentName(std::string_view name);

}  // namespace simwright::tasks
