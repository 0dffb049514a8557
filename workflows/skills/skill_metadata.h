#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "workflows/skills/skill_motion.h"
#include "workflows/skills/skill_run.h"

namespace simwright::workflows {

// The metadata of an exported motion, with which it replays from its file alone.
struct SkillMetadata {
  std::string robot;
  std::string task;
  std::string run;                      // the training folder's absolute path
  std::vector<std::string> assets;      // the run's asset hashes
  std::uint64_t seed = 0, episode = 0;  // the index among the seed's episodes
  std::string start;                    // skills::StartText
  std::vector<std::string> subtasks;    // names
  std::vector<SubtaskTimes> times;      // by subtask
};

// Returns the metadata of an episode of `run`, whose start is that of one of its tasks.
SkillMetadata MetadataOf(const SkillRun& run, const std::vector<RunSkill>& skills,
                         const ChainRecording& recording, std::uint64_t seed);

// Convert metadata to the lines of a trajectory's file and back. MetadataFrom throws core::Error,
// naming `where` and the entry that is missing or damaged.
std::map<std::string, std::string> MetadataLines(const SkillMetadata& metadata);
SkillMetadata MetadataFrom(const std::map<std::string, std::string>& lines,
                           const std::string& where);

// Throws core::Error, naming `where`, unless the metadata matches this run's robot, task, subtasks
// and assets.
void RequireMatchingRun(const SkillMetadata& metadata, const SkillRun& run,
                        const std::vector<RunSkill>& skills, const std::string& where);

}  // namespace simwright::workflows
