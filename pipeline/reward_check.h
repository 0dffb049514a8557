#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "tasks/reward/reward_slot.h"

namespace simwright::pipeline {

struct RewardCheckRequest {
  std::filesystem::path program;
  // Each an asset's folder (ours, or PartNet-Mobility's) or a URDF. A program calls it by its
  // folder's name, a URDF by its file's; "NAME=PATH" gives another.
  std::vector<std::string> assets;
  // False: the function alone, its parameters free inputs; names of assets are not looked up.
  bool scene = true;
  std::string entry;  // the function that gives the reward; empty: found by its name
};

// What is known of a reward program before anything is trained.
struct RewardCheckReport {
  std::string subject;      // the file
  std::string source;       // what it holds
  core::Findings findings;  // in the program, place: "line:column"; in an asset, its file
  // Where it compiles: the function, what it reads, and what it gives.
  bool compiles = false;
  std::string entry;
  std::vector<tasks::RewardSlot> reads;
  std::vector<std::string> components;
  bool has_success = false;
  int operations = 0;  // an environment

  bool sound = false;  // no finding in the program is an error

  bool passed() const { return sound; }
};

// Reads and compiles the program against the assets' names, and with a scene looks at what it does
// there (tasks/verification). Throws core::Error where a file cannot
// be read, a folder holds no URDF, two assets bear one name, or there is neither an asset nor
// `scene` unset.
RewardCheckReport CheckReward(const RewardCheckRequest& request);

// For a person: the findings with their lines and carets, then what the program reads and gives.
std::string RewardCheckText(const RewardCheckReport& report);
// One JSON object (docs/rewards.md).
std::string RewardCheckJson(const RewardCheckReport& report);

}  // namespace simwright::pipeline
