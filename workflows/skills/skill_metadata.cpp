#include "workflows/skills/skill_metadata.h"

#include <algorithm>
#include <charconv>

#include "core/error.h"
#include "core/json.h"
#include "skills/start_pool.h"

namespace simwright::workflows {
namespace {

constexpr const char* kMetadataRemedy = "give a file of `simwright export`, with its metadata";

const std::string& MetadataLine(const std::map<std::string, std::string>& lines, const char* key,
                                const std::string& where) {
  const auto found = lines.find(key);
  if (found != lines.end()) return found->second;
  throw core::Error(std::string("lacks the metadata entry '") + key + "'", where, kMetadataRemedy);
}

std::uint64_t NumberField(const std::string& text, const char* key, const std::string& where) {
  std::uint64_t number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault == std::errc() && end == text.data() + text.size()) return number;
  throw core::Error("the entry '" + std::string(key) + "' is not a number: '" + text + "'", where,
                    kMetadataRemedy);
}

// Returns a metadata entry that is JSON.
core::JsonDocument JsonEntry(const std::map<std::string, std::string>& lines, const char* key,
                             const std::string& where) {
  return core::JsonDocument(MetadataLine(lines, key, where), where + ": " + key, kMetadataRemedy);
}

void ReadSubtasks(const core::JsonField& field, SkillMetadata* metadata) {
  double last = 0.0;
  for (const core::JsonField& one : field.Elements()) {
    const SubtaskTimes times{one["begin"].Number(), one["end"].Number()};
    if (!(times.begin >= last) || !(times.end > times.begin)) {
      one.Fail("has times that do not increase");
    }
    last = times.end;
    metadata->subtasks.push_back(one["name"].Text());
    metadata->times.push_back(times);
  }
}

[[noreturn]] void MetadataError(const std::string& what, const std::string& theirs,
                                const std::string& ours, const std::string& where) {
  throw core::Error("was made for " + what + " '" + theirs + "', the run has '" + ours + "'", where,
                    "give the run it was exported from");
}

}  // namespace

SkillMetadata MetadataOf(const SkillRun& run, const std::vector<RunSkill>& skills,
                         const ChainRecording& recording, std::uint64_t seed) {
  const skills::StartState& start = recording.subtasks.front().start;
  SkillMetadata metadata;
  metadata.robot = run.robot;
  metadata.task = run.set.tasks[static_cast<size_t>(start.variant)].name;
  metadata.run = std::filesystem::weakly_canonical(run.folder).string();
  metadata.assets = run.hashes;
  metadata.seed = seed;
  metadata.episode = recording.episode;
  metadata.start = skills::StartText(start);
  for (const RunSkill& skill : skills) metadata.subtasks.push_back(skill.name);
  return metadata;
}

std::map<std::string, std::string> MetadataLines(const SkillMetadata& metadata) {
  core::Json subtasks = core::Json::array();
  for (size_t i = 0; i < metadata.subtasks.size(); ++i) {
    subtasks.push_back({{"name", metadata.subtasks[i]},
                        {"begin", metadata.times[i].begin},
                        {"end", metadata.times[i].end}});
  }
  return {{"robot", metadata.robot},
          {"task", metadata.task},
          {"run", metadata.run},
          {"assets", core::JsonLine(core::Json(metadata.assets))},
          {"seed", std::to_string(metadata.seed)},
          {"episode", std::to_string(metadata.episode)},
          {"start", metadata.start},
          {"subtasks", core::JsonLine(subtasks)}};
}

SkillMetadata MetadataFrom(const std::map<std::string, std::string>& lines,
                           const std::string& where) {
  SkillMetadata metadata;
  metadata.robot = MetadataLine(lines, "robot", where);
  metadata.task = MetadataLine(lines, "task", where);
  metadata.run = MetadataLine(lines, "run", where);
  metadata.start = MetadataLine(lines, "start", where);
  metadata.seed = NumberField(MetadataLine(lines, "seed", where), "seed", where);
  metadata.episode = NumberField(MetadataLine(lines, "episode", where), "episode", where);
  const core::JsonDocument assets = JsonEntry(lines, "assets", where);
  metadata.assets = assets.root().Texts();
  const core::JsonDocument subtasks = JsonEntry(lines, "subtasks", where);
  ReadSubtasks(subtasks.root(), &metadata);
  return metadata;
}

void RequireMatchingRun(const SkillMetadata& metadata, const SkillRun& run,
                        const std::vector<RunSkill>& skills, const std::string& where) {
  if (metadata.robot != run.robot) MetadataError("the robot", metadata.robot, run.robot, where);
  const bool known =
      std::any_of(run.set.tasks.begin(), run.set.tasks.end(),
                  [&](const tasks::Task& task) { return task.name == metadata.task; });
  if (!known) MetadataError("the task", metadata.task, run.set.tasks.front().name, where);
  if (metadata.assets != run.hashes) {
    throw core::Error("the assets have changed since it was exported", where,
                      "give the run it was exported from, or export again");
  }
  bool same = metadata.subtasks.size() == skills.size();
  for (size_t i = 0; same && i < skills.size(); ++i) same = metadata.subtasks[i] == skills[i].name;
  if (!same) {
    throw core::Error("its subtasks are not those of the run", where,
                      "give the run it was exported from");
  }
}

}  // namespace simwright::workflows
