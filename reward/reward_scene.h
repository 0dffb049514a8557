#pragma once

#include <string>
#include <vector>

namespace simwright::reward {

enum class RewardJointType { kFixed, kRevolute, kContinuous, kPrismatic };

struct RewardJoint {
  std::string name;
  RewardJointType type = RewardJointType::kFixed;
  double lower = 0.0;  // rad or m; equal to upper if the joint is fixed
  double upper = 0.0;
};

struct RewardAsset {
  std::string name;
  std::vector<std::string> links;
  std::vector<RewardJoint> joints;
};

// The names that a reward program may use: the assets of one environment.
struct RewardScene {
  std::vector<RewardAsset> assets;
};

}  // namespace simwright::reward
