#include "workflows/skills/shipped_skills.h"

#include <cstdio>
#include <regex>

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "rl/policy_file.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kLargestCard = 1 << 20;  // bytes

ShippedSkill ReadSkillOf(const SuiteCell& cell, const fs::path& file) {
  ShippedSkill skill;
  skill.cell = cell;
  skill.file = file;
  const rl::Policy policy = rl::ReadPolicy(file);
  skill.action = ActionSpaceOf(policy);
  skill.observation_size = policy.observation_size();
  skill.action_size = policy.action_size();
  const fs::path card = fs::path(file).replace_extension(".md");
  if (fs::exists(card)) skill.success = SuccessOnCard(core::ReadFile(card, kLargestCard));
  return skill;
}

core::Error NoSkills(const fs::path& models) {
  return core::Error("there are no shipped skills",
                     models.empty() ? "the models folder" : (models / "skills").string(),
                     "install the models, or set SIMWRIGHT_MODELS to their folder");
}

}  // namespace

std::vector<ShippedSkill> ReadShippedSkills(const fs::path& models) {
  std::vector<ShippedSkill> skills;
  for (const SuiteCell& cell : SkillSuite()) {
    const fs::path file = ShippedPolicy(models, cell.name);
    if (fs::exists(file)) skills.push_back(ReadSkillOf(cell, file));
  }
  if (skills.empty()) throw NoSkills(models);
  return skills;
}

ShippedSkill ReadShippedSkill(const fs::path& models, const std::string& name) {
  std::string names;
  for (const SuiteCell& cell : SkillSuite()) {
    const fs::path file = ShippedPolicy(models, cell.name);
    if (!fs::exists(file)) continue;
    if (cell.name == name) return ReadSkillOf(cell, file);
    names += (names.empty() ? "" : ", ") + cell.name;
  }
  if (names.empty()) throw NoSkills(models);
  throw core::Error("there is no shipped skill '" + name + "'", "--skill",
                    "choose one of " + names);
}

std::optional<MeasuredSuccess> SuccessOnCard(const std::string& card) {
  static const std::regex count(R"(\| *([0-9]{1,7}) of +([0-9]{1,7}) *\|)");
  std::smatch found;
  if (!std::regex_search(card, found, count)) return std::nullopt;
  MeasuredSuccess success;
  success.successes = std::stoi(found[1]);
  success.episodes = std::stoi(found[2]);
  if (success.episodes < 1 || success.successes > success.episodes) return std::nullopt;
  success.interval = rl::WilsonInterval(success.successes, success.episodes);
  return success;
}

std::string ShippedSkillsTable(const std::vector<ShippedSkill>& skills) {
  char line[256];
  std::snprintf(line, sizeof(line), "%-20s  %-50s  %-13s  %-12s  %-7s  %3s  %3s  %s\n", "skill",
                "what it does", "robot", "trained on", "action", "obs", "act", "success (95 %)");
  std::string table = line;
  for (const ShippedSkill& skill : skills) {
    char success[64] = "not measured";
    if (skill.success) {
      std::snprintf(success, sizeof(success), "%5.1f %% (%.1f to %.1f)",
                    100.0 * skill.success->rate(), 100.0 * skill.success->interval.low,
                    100.0 * skill.success->interval.high);
    }
    std::snprintf(line, sizeof(line), "%-20s  %-50s  %-13s  %-12s  %-7s  %3d  %3d  %s\n",
                  skill.cell.name.c_str(), skill.cell.description.c_str(), skill.cell.robot.c_str(),
                  skill.cell.kind.c_str(), skills::NameOf(skill.action).c_str(),
                  skill.observation_size, skill.action_size, success);
    table += line;
  }
  return table + "files: " + skills.front().file.parent_path().string() + "\n";
}

std::string ShippedSkillsJson(const std::vector<ShippedSkill>& skills) {
  core::OrderedJson list = core::OrderedJson::array();
  for (const ShippedSkill& skill : skills) {
    core::OrderedJson one = {{"name", skill.cell.name},
                             {"description", skill.cell.description},
                             {"robot", skill.cell.robot},
                             {"kind", skill.cell.kind},
                             {"action", skills::NameOf(skill.action)},
                             {"observation_size", skill.observation_size},
                             {"action_size", skill.action_size},
                             {"file", skill.file.string()}};
    if (skill.success) {
      one["success"] = {{"successes", skill.success->successes},
                        {"episodes", skill.success->episodes},
                        {"low", skill.success->interval.low},
                        {"high", skill.success->interval.high}};
    } else {
      one["success"] = nullptr;
    }
    list.push_back(std::move(one));
  }
  return core::JsonText(core::OrderedJson{{"skills", list}});
}

}  // namespace simwright::workflows
