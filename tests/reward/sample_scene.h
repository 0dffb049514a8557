#pragma once

#include "reward/reward_scene.h"

namespace simwright::reward {

// A microwave with a hinged door and a sliding tray, and a cup.
inline RewardScene SampleScene() {
  RewardAsset microwave;
  microwave.name = "microwave";
  microwave.links = {"base", "link_0", "handle_0", "tray"};
  microwave.joints = {{"joint_0", RewardJointType::kRevolute, 0.25, 1.5},
                      {"joint_1", RewardJointType::kPrismatic, -0.125, 0.375},
                      {"handlejoint_0", RewardJointType::kFixed, 0.0, 0.0},
                      {"knob", RewardJointType::kContinuous, 0.0, 0.0}};
  RewardAsset cup;
  cup.name = "cup";
  cup.links = {"base"};
  cup.joints = {{"base_joint", RewardJointType::kFixed, 0.0, 0.0}};
  return {{microwave, cup}};
}

}  // namespace simwright::reward
