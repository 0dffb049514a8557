#include "workflows/photo_run/photo_run_record.h"

#include <algorithm>
#include <cstdio>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kPhotoRunFormat = 1;
constexpr const char* kFile = "run.json";
constexpr const char* kTraining = "train";

std::string RecordFigure(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.10g", value);
  return text;
}

std::string EffortName(asset_lift::LiftEffort effort) {
  switch (effort) {
    case asset_lift::LiftEffort::kOutline:
      return "outline";
    case asset_lift::LiftEffort::kFast:
      return "fast";
    default:
      return "full";
  }
}

// Returns true for an input that only extends a training.
bool BoundsTraining(const std::string& input) {
  return input == "--steps" || input == "--minutes";
}

std::string Difference(const std::string& input, const std::string& old, const std::string& now) {
  if (!input.starts_with("--")) return "another " + input;  // compared by its hash
  if (input == "--mask")
    return old.empty() ? "no --mask" : now.empty() ? "a --mask" : "another --mask";
  const auto shown = [](const std::string& value) { return value.empty() ? "none" : value; };
  return input + " " + shown(old) + ", not " + shown(now);
}

}  // namespace

PhotoRunRecord::Inputs PhotoRunRecord::InputsOf(const PhotoRunRequest& request) {
  return {{"photo", core::ContentHashOf(request.photo)},
          {"--mask", request.mask ? core::ContentHashOf(*request.mask) : ""},
          {"--category", request.category},
          {"--height", request.height > 0.0 ? RecordFigure(request.height) : ""},
          {"--lift", EffortName(request.effort)},
          {"--furniture", request.furniture},
          {"--task", request.task},
          {"--seed", std::to_string(request.seed)},
          {"--envs", std::to_string(request.environments)},
          {"--target", RecordFigure(request.target)},
          {"--episodes", std::to_string(request.episodes)},
          {"--steps", std::to_string(request.samples)},
          {"--imitate", std::to_string(request.imitated_samples)},
          {"--minutes", RecordFigure(request.minutes)}};
}

PhotoRunRecord::PhotoRunRecord(const PhotoRunRequest& request) : folder_(request.output) {
  const Inputs wanted = InputsOf(request);
  const fs::path file = folder_ / kFile;
  const bool run = fs::exists(file);
  if (fs::exists(folder_) && !run && !(fs::is_directory(folder_) && fs::is_empty(folder_))) {
    throw core::Error("already exists and is not a run", folder_.string(), "choose another folder");
  }
  if (run && !request.resume && !request.force) {
    throw core::Error("already exists", folder_.string(),
                      "--resume continues it, --force starts over");
  }
  if (run) lock_.emplace(folder_, "a run");
  if (run && request.resume) {
    Read(file);
    RequireSame(wanted);
    core::RemoveStagingLeftovers(folder_);
  } else if (run) {
    fs::remove_all(folder_);
  }
  std::error_code code;
  fs::create_directories(folder_, code);
  if (code) {
    throw core::Error("cannot create the folder: " + code.message(), folder_.string(),
                      "check that its parent exists and is writable");
  }
  if (!run || !request.resume) lock_.emplace(folder_, "a run");  // the folder is new
  inputs_ = wanted;
  Write();
}

void PhotoRunRecord::Read(const fs::path& file) {
  const core::JsonDocument document =
      core::JsonDocument::Read(file, 1 << 20, "--force starts over");
  const core::JsonField text = document.root();
  if (text["format"].Int() != kPhotoRunFormat) {
    throw core::Error("was written by another version", file.string(), "--force starts over");
  }
  for (const auto& [name, value] : text["inputs"].Members()) {
    inputs_.emplace_back(name, value.Text());
  }
  for (const core::JsonField& stage : text["stages"].Elements()) {
    stages_.push_back({stage["name"].Text(), stage["seconds"].Number(), stage["done"].Flag()});
  }
}

void PhotoRunRecord::Write() const {
  core::OrderedJson text;
  text["format"] = kPhotoRunFormat;
  for (const auto& [name, value] : inputs_) text["inputs"][name] = value;
  text["stages"] = core::OrderedJson::array();
  for (const RunStage& stage : stages_) {
    text["stages"].push_back(
        {{"name", stage.name}, {"seconds", stage.seconds}, {"done", stage.done}});
  }
  core::WriteFile(folder_ / kFile, core::JsonText(text));
}

void PhotoRunRecord::RequireSame(const Inputs& wanted) const {
  std::string differences;
  for (const auto& [name, value] : wanted) {
    if (BoundsTraining(name) && !Done(kTraining)) continue;
    const auto old = std::find_if(inputs_.begin(), inputs_.end(),
                                  [&](const auto& input) { return input.first == name; });
    const std::string had = old == inputs_.end() ? "" : old->second;
    if (had == value) continue;
    differences += (differences.empty() ? "" : ", and ") + Difference(name, had, value);
  }
  if (differences.empty()) return;
  throw core::Error("the run was started with " + differences, folder_.string(),
                    "choose another folder, or start over with --force");
}

bool PhotoRunRecord::Done(const std::string& stage) const {
  return std::any_of(stages_.begin(), stages_.end(),
                     [&](const RunStage& known) { return known.name == stage && known.done; });
}

double PhotoRunRecord::SecondsOf(const std::string& stage) const {
  const auto known = std::find_if(stages_.begin(), stages_.end(),
                                  [&](const RunStage& one) { return one.name == stage; });
  return known == stages_.end() ? 0.0 : known->seconds;
}

void PhotoRunRecord::Spend(const std::string& stage, double seconds, bool done) {
  auto known = std::find_if(stages_.begin(), stages_.end(),
                            [&](const RunStage& one) { return one.name == stage; });
  if (known == stages_.end()) known = stages_.insert(stages_.end(), {stage, 0.0, false});
  known->seconds += seconds;
  known->done = done;
  Write();
}

void PhotoRunRecord::RemoveIfNothingIsDone() {
  if (std::any_of(stages_.begin(), stages_.end(), [](const RunStage& one) { return one.done; })) {
    return;
  }
  std::error_code code;
  fs::remove_all(folder_, code);
}

}  // namespace simwright::workflows
