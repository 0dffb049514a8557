#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rl/wilson_interval.h"
#include "workflows/skills/skill_suite.h"

namespace simwright::workflows {

// The measured success that the card of a shipped policy states.
struct MeasuredSuccess {
  int successes = 0, episodes = 0;
  rl::Interval interval;  // 95 %, of the success rate

  double rate() const { return episodes > 0 ? static_cast<double>(successes) / episodes : 0.0; }
};

// A shipped policy: the cell of the suite that it was trained for, and the content of its file.
struct ShippedSkill {
  SuiteCell cell;
  std::filesystem::path file;
  skills::ActionSpace action = skills::ActionSpace::kTargetFrame;
  int observation_size = 0, action_size = 0;
  std::optional<MeasuredSuccess> success;  // none if there is no card
};

// Returns the shipped policies of a folder of models (ModelsFolder), in the order of the suite.
// Throws core::Error if the folder has none, or a policy is damaged.
std::vector<ShippedSkill> ReadShippedSkills(const std::filesystem::path& models);

// Returns the shipped policy of this name. Throws core::Error, listing the known names, if the
// folder has none.
ShippedSkill ReadShippedSkill(const std::filesystem::path& models, const std::string& name);

// Reads "298 of 300" in the table of a card. Returns nothing if the card has no such figure.
std::optional<MeasuredSuccess> SuccessOnCard(const std::string& card);

// Format the list for a terminal and for machines.
std::string ShippedSkillsTable(const std::vector<ShippedSkill>& skills);
std::string ShippedSkillsJson(const std::vector<ShippedSkill>& skills);

}  // namespace simwright::workflows
