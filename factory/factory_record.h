#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"

namespace simwright::factory {

// An attempt at an asset that failed.
struct FactoryFailure {
  std::string reason;
  std::string changed;  // what the next attempt changes: "seed 1003"; empty for the last
};

// The outcome of an asset of a factory: DIR/done/NAME.json.
struct AssetRecord {
  std::string name;
  std::string source;  // "library", "photo" or "file"
  std::string category;
  std::string folder;                 // relative to the factory's: "assets/mug_3"; empty: it failed
  std::vector<std::string> variants;  // folders likewise
  std::vector<FactoryFailure> failures;
  core::Findings findings;  // warnings
  double seconds = 0.0, cpu_seconds = 0.0;

  bool made() const { return !folder.empty(); }
};

// The outcome of a part of the tasks: DIR/done/tasks_NNNNN.json.
struct TaskPartRecord {
  int part = 0;
  int asked = 0, made = 0;  // tasks; all that are made are verified
  std::vector<std::string> assets;
  std::string reason;  // why none or fewer were made; empty: as many as asked
  double seconds = 0.0, cpu_seconds = 0.0;
};

std::string AssetRecordText(const AssetRecord& record);
std::string TaskPartText(const TaskPartRecord& record);

// Read a record; nothing if the file does not exist. Throw core::Error for a damaged one.
std::optional<AssetRecord> ReadAssetRecord(const std::filesystem::path& file);
std::optional<TaskPartRecord> ReadTaskPart(const std::filesystem::path& file);

}  // namespace simwright::factory
