// Reports of scene exports as text and JSON.
#include <algorithm>
#include <cstdio>

#include "core/json.h"
#include "workflows/scenes/scene_export.h"

namespace simwright::workflows {
namespace {

std::string ExportLine(const SceneStability& check) {
  char line[256];
  std::snprintf(line, sizeof line, "%s  %3d objects %-6s  MuJoCo %8.3f mm %-18s Bullet %8.3f mm %s",
                check.name.c_str(), check.objects, check.Still() ? "still" : "MOVES",
                1e3 * check.mujoco.moved, check.mujoco.name.c_str(), 1e3 * check.bullet.moved,
                check.bullet.name.c_str());
  std::string text = line;
  for (const std::string& warning : check.warnings) text += "\n    MuJoCo: " + warning;
  return text + "\n";
}

core::OrderedJson MotionJson(const LargestDisplacement& motion) {
  core::OrderedJson json;
  json["moved_m"] = motion.moved;  // null if it is not finite
  json["thing"] = motion.name;
  return json;
}

core::OrderedJson CheckJson(const SceneStability& check) {
  core::OrderedJson json;
  json["scene"] = check.name;
  json["things"] = check.objects;
  json["still"] = check.Still();
  json["mujoco"] = MotionJson(check.mujoco);
  json["mujoco"]["warnings"] = check.warnings;
  json["bullet"] = MotionJson(check.bullet);
  return json;
}

int CountSentence(const std::vector<SceneStability>& checks,
                  bool (SceneStability::*still)() const) {
  return static_cast<int>(std::count_if(checks.begin(), checks.end(),
                                        [&](const SceneStability& one) { return (one.*still)(); }));
}

core::OrderedJson ChecksJson(const SceneExportReport& report) {
  core::OrderedJson json;
  json["still_share"] = report.StableFraction();
  json["checks"] = core::OrderedJson::array();
  for (const SceneStability& check : report.checks) json["checks"].push_back(CheckJson(check));
  return json;
}

}  // namespace

double SceneExportReport::StableFraction() const {
  if (checks.empty()) return 1.0;
  return static_cast<double>(CountSentence(checks, &SceneStability::Still)) /
         static_cast<double>(checks.size());
}

std::string ExportTable(const SceneExportReport& report) {
  std::string text;
  for (const SceneStability& check : report.checks) text += ExportLine(check);
  char line[200];
  if (!report.checks.empty()) {
    std::snprintf(line, sizeof line,
                  "stable for 2 s: %d of %zu scenes (%.0f %%); in MuJoCo %d, in Bullet %d\n",
                  CountSentence(report.checks, &SceneStability::Still), report.checks.size(),
                  100.0 * report.StableFraction(),
                  CountSentence(report.checks, &SceneStability::StableInMujoco),
                  CountSentence(report.checks, &SceneStability::StableInBullet));
    text += line;
  }
  return text + report.output.string() + ": " + std::to_string(report.scenes.size()) + " scenes, " +
         std::to_string(report.assets) + " assets\n";
}

std::string ExportJson(const SceneExportReport& report) {
  core::OrderedJson json;
  json["output"] = report.output.string();
  json["scenes"] = report.scenes;
  json["assets"] = report.assets;
  if (!report.checks.empty()) json.update(ChecksJson(report));
  return core::JsonText(json);
}

std::string StabilityJson(const SceneExportReport& report) {
  return core::JsonText(ChecksJson(report));
}

}  // namespace simwright::workflows
