#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::reward {

// The content of one input of a program: [width], SI units, world frame, quaternions xyzw.
enum class RewardInput {
  kLinkPosition,         // [3] m
  kLinkOrientation,      // [4]
  kLinkLinearVelocity,   // [3] m/s
  kLinkAngularVelocity,  // [3] rad/s
  kLinkBoundingBox,      // [6] m: minimum corner, maximum corner of the AABB
  kAssetPosition,        // as the five above, for the asset's root
  kAssetOrientation,
  kAssetLinearVelocity,
  kAssetAngularVelocity,
  kAssetBoundingBox,
  kGripperPosition,         // [3] m, between the fingertips
  kGripperOrientation,      // [4]
  kGripperLinearVelocity,   // [3] m/s
  kGripperAngularVelocity,  // [3] rad/s
  kGripperOpening,          // [1] distance between the fingers, m
  kGripperContact,          // [1] 1 if a finger touches the asset or link, or any asset if none is
                            // named
  kGrasped,                 // [1] 1 if both fingers hold the asset or link
  kJointState,              // [1] rad or m
  kJointVelocity,           // [1] rad/s or m/s
  kJointLower,              // [1] rad or m, the same for all environments
  kJointUpper,              // [1]
  kGoalPosition,            // [3] m
  kParameter,               // a parameter of the reward function
};

// Returns a short stable name, e.g. "link_position".
std::string_view RewardInputName(RewardInput input);

// The result type of a call of the environment's API.
enum class ApiResult {
  kVector,     // [N, width], or [N] if the width is 1
  kFlag,       // [N], true or false
  kLimits,     // {"lower": ..., "upper": ...}, also by [0] and [1]
  kLimitPair,  // (lower, upper)
  kLower,      // a scalar
  kUpper,      // a scalar
  kBox,        // (minimum corner [N, 3], maximum corner [N, 3])
  kPose,       // (position [N, 3], orientation [N, 4])
  kInsideBox,  // [N]: true if a point is inside a box
  kDistance,   // [N]: distance between two points
};

// One function of the environment's API. Called on the environment, env.f("cup"), it returns a row
// per environment. Called as a helper with the environment as an argument, f(env, "cup"), it
// returns the value of one environment, without the leading N.
struct ApiFunction {
  std::string_view names;      // the name, then its aliases
  std::string_view arguments;  // from asset, link, joint, point, low, high; "?" marks optional ones
  ApiResult result;
  RewardInput input;  // the input for a link; without a link, the asset's
  int width;
  std::string_view document;  // one line
};

std::span<const ApiFunction> EnvironmentApi();

// Returns null if there is no such function.
const ApiFunction* FindApiFunction(std::string_view name);

// Returns all names and aliases.
std::vector<std::string> ApiNames();

// Returns true if a parameter of this name is the environment: env, self, simulator, envs.
bool IsEnvironmentName(std::string_view name);

}  // namespace simwright::reward
