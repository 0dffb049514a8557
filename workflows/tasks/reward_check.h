#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "reward/reward_slot.h"

namespace simwright::workflows {

struct RewardCheckRequest {
  std::filesystem::path program;
  // The assets, each a folder (ours, or PartNet-Mobility's) or a URDF. A program calls an asset by
  // the name of its folder or URDF file; "NAME=PATH" gives another name.
  std::vector<std::string> assets;
  // False: checks the function alone with free inputs as parameters, without looking up asset
  // names.
  bool scene = true;
  std::string entry;  // the reward function; empty: found by its name
};

// The results of checking a reward program before training.
struct RewardCheckReport {
  std::string subject;      // the file
  std::string source;       // the file's text
  core::Findings findings;  // place: "line:column" in the program, or the asset's file
  // If it compiles: the function, its inputs and its outputs.
  bool compiles = false;
  std::string entry;
  std::vector<reward::RewardSlot> reads;
  std::vector<std::string> components;
  bool has_success = false;
  int operations = 0;  // per environment

  bool valid = false;  // no finding in the program is an error

  bool passed() const { return valid; }
};

// Compiles the program against the assets' names and, with a scene, examines its behaviour there
// (tasks/verification). Throws core::Error if a file cannot be read, a folder has no URDF, two
// assets have the same name, or `scene` is set and there are no assets.
RewardCheckReport CheckReward(const RewardCheckRequest& request);

// Formats the report for people: the findings with their lines and carets, then the program's
// inputs and outputs.
std::string RewardCheckText(const RewardCheckReport& report);
// Formats the report as one JSON object (docs/rewards.md).
std::string RewardCheckJson(const RewardCheckReport& report);

}  // namespace simwright::workflows
