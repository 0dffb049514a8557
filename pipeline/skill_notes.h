#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipeline/skill_motion.h"
#include "pipeline/skill_run.h"

namespace simwright::pipeline {

// What an exported motion says of itself, so that it replays from its file alone.
struct SkillNotes {
  std::string robot;
  std::string task;
  std::string run;                      // the training's folder, absolute
  std::vector<std::string> assets;      // hashes, as the run has them
  std::uint64_t seed = 0, episode = 0;  // which of the seed's episodes it was
  std::string start;                    // rl::StartText
  std::vector<std::string> subtasks;    // names
  std::vector<SubtaskTimes> times;      // by subtask
};

// The notes of an episode of `run`, whose start is that of one of its tasks.
SkillNotes NotesOf(const SkillRun& run, const std::vector<RunSkill>& skills,
                   const ChainRecording& recording, std::uint64_t seed);

// As a trajectory's file carries them, a line each, and back. NotesFrom throws core::Error, naming
// `where` and the note that is missing or damaged.
std::map<std::string, std::string> NoteLines(const SkillNotes& notes);
SkillNotes NotesFrom(const std::map<std::string, std::string>& lines, const std::string& where);

// Throws core::Error, naming `where`, unless the notes are of this run's robot, task, subtasks and
// assets.
void RequireOfRun(const SkillNotes& notes, const SkillRun& run, const std::vector<RunSkill>& skills,
                  const std::string& where);

}  // namespace simwright::pipeline
