#include "workflows/scenes/post_training_settings.h"

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxSettingsBytes = 1 << 20;

// Maps options of the command line to values.
core::OrderedJson SettingsOf(const ScenePostTrainingRequest& request, const fs::path& weights) {
  const steering::PostTrainingOptions& options = request.options;
  core::OrderedJson settings;
  settings["weights"] = fs::absolute(weights).lexically_normal().string();
  settings["--data"] = fs::absolute(request.data).lexically_normal().string();
  settings["--objective"] = request.prompt.empty() ? request.objective : "";
  settings["--prompt"] = request.prompt;
  settings["--scenes"] = options.scenes;
  settings["--steps"] = options.steps;
  settings["--gradient-steps"] = options.gradient_steps;
  settings["--updates"] = options.updates;
  settings["--more-slots"] = options.more_entries;
  settings["--seed"] = options.seed;
  return settings;
}

}  // namespace

void WritePostTrainingSettings(const ScenePostTrainingRequest& request, const fs::path& weights) {
  core::WriteFile(request.output / kPostTrainingSettingsFile,
                  core::JsonText(SettingsOf(request, weights)));
}

void CheckPostTrainingSettings(const ScenePostTrainingRequest& request, const fs::path& weights) {
  const fs::path file = request.output / kPostTrainingSettingsFile;
  if (!fs::exists(file)) return;
  const core::JsonDocument earlier = core::JsonDocument::Read(file, kMaxSettingsBytes);
  const core::OrderedJson settings = SettingsOf(request, weights);
  for (const auto& [name, value] : settings.items()) {
    const core::Json* const before = core::FindMember(earlier.json(), name.c_str());
    const std::string now = core::JsonLine(value);
    if (before != nullptr && core::JsonLine(*before) == now) continue;
    throw core::Error("the stopped post-training had another value of " + name,
                      request.output.string(),
                      "it was " + (before == nullptr ? "not given" : core::JsonLine(*before)) +
                          " and is now " + now + "; give the same, or another folder");
  }
}

}  // namespace simwright::workflows
