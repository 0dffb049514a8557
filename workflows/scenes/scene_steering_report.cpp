#include <algorithm>
#include <cstdio>

#include "core/json.h"
#include "workflows/scenes/scene_steering.h"

namespace simwright::workflows {
namespace {

std::string Joined(const std::vector<std::string>& parts, const std::string& separator) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

std::string CommaList(const std::vector<std::string>& names) {
  return Joined(names, ", ");
}

void Add(const char* code, const SteeredSceneReport& scene, const std::string& sentence,
         double figure, const std::string& remedy, core::Findings* findings) {
  findings->push_back({code, core::Severity::kWarning, scene.name, sentence, figure, remedy});
}

}  // namespace

core::Findings SteeringFindings(const std::vector<SteeredSceneReport>& scenes, bool rearrange) {
  core::Findings findings;
  for (const SteeredSceneReport& scene : scenes) {
    const auto count = [](const std::vector<std::string>& names) {
      return static_cast<double>(names.size());
    };
    if (!scene.unstable.empty()) {
      Add("kept-unstable", scene,
          std::string("these kept objects do not stay still ") +
              (rearrange ? "without those that are rearranged: " : "by themselves: ") +
              CommaList(scene.unstable),
          count(scene.unstable),
          rearrange ? "keep what they stand on, too" : "settle the scene before", &findings);
    }
    if (!rearrange && scene.done < scene.asked) {
      Add("objects-missing", scene,
          "only " + std::to_string(scene.done) + " of " + std::to_string(scene.asked) +
              " objects found a place" +
              (scene.missing.empty() ? "" : "; missing: " + CommaList(scene.missing)),
          scene.asked - scene.done, "give more --attempts or --candidates", &findings);
    }
    if (!scene.broken.empty()) {
      Add("relations-broken", scene, "it does not hold that " + Joined(scene.broken, "; that "),
          count(scene.broken), "give more --candidates", &findings);
    }
    if (!scene.returned.empty()) {
      Add("objects-returned", scene,
          "these objects found no new pose and are back at their old one: " +
              CommaList(scene.returned),
          count(scene.returned), "give more --attempts or --candidates", &findings);
    }
    if (!scene.lost.empty()) {
      Add("objects-lost", scene,
          "these objects found no place and are left out: " + CommaList(scene.lost),
          count(scene.lost), "give more --attempts or --candidates", &findings);
    }
    if (!scene.stable && scene.unstable.empty()) {
      Add("scene-unstable", scene, "objects move by more than 1 mm once everything is free",
          std::max(scene.kept_displacement, scene.drift), "", &findings);
    }
  }
  return findings;
}

std::string SteeringTable(const SceneSteeringReport& report) {
  const auto count = static_cast<double>(report.scenes.size());
  SteeredSceneReport worst;
  int stable = 0, statements = 0, held = 0, unstable = 0;
  for (const SteeredSceneReport& scene : report.scenes) {
    worst.kept += scene.kept;
    worst.asked += scene.asked;
    worst.done += scene.done;
    worst.attempts = std::max(worst.attempts, scene.attempts);
    worst.kept_displacement = std::max(worst.kept_displacement, scene.kept_displacement);
    worst.penetration = std::max(worst.penetration, scene.penetration);
    stable += scene.stable;
    unstable += static_cast<int>(scene.unstable.size());
    statements += scene.statements;
    held += scene.statements - static_cast<int>(scene.broken.size());
  }
  char text[640];
  std::snprintf(
      text, sizeof text,
      "%s: %.0f scenes, %d objects kept, %d of %d %s\n"
      "kept objects move by at most %.3f mm once everything is free; penetration %.3f mm\n"
      "%d of %.0f scenes are stable; at most %d attempts\n"
      "%.1f s: model %.1f, assets %.1f, sampling %.1f, physics %.1f, pictures %.1f\n",
      report.output.c_str(), count, worst.kept, worst.done, worst.asked,
      report.rearrange ? "moved" : "added", 1e3 * worst.kept_displacement, 1e3 * worst.penetration,
      stable, count, worst.attempts, report.seconds, report.model_seconds, report.asset_seconds,
      report.sampling_seconds, report.physics_seconds, report.picture_seconds);
  std::string table = text;
  if (unstable > 0) {
    std::snprintf(
        text, sizeof text,
        "%d kept objects, which these figures leave out, do not stay still by themselves\n",
        unstable);
    table += text;
  }
  if (statements > 0) {
    std::snprintf(text, sizeof text, "%d of %d relations that the prompt asks for hold\n", held,
                  statements);
    table += text;
  }
  return table;
}

std::string SteeringJson(const SceneSteeringReport& report) {
  core::OrderedJson json;
  json["output"] = report.output.string();
  json["command"] = report.rearrange ? "rearrange" : "complete";
  json["scenes"] = core::OrderedJson::array();
  for (const SteeredSceneReport& scene : report.scenes) {
    core::OrderedJson one;
    one["scene"] = scene.name;
    one["kept"] = scene.kept;
    one["asked"] = scene.asked;
    one[report.rearrange ? "moved" : "added"] = scene.done;
    one["attempts"] = scene.attempts;
    one["kept_displacement_mm"] = 1e3 * scene.kept_displacement;
    one["penetration_mm"] = 1e3 * scene.penetration;
    one["drift_mm"] = 1e3 * scene.drift;
    one["stable"] = scene.stable;
    one["unstable_kept"] = scene.unstable;
    if (!report.rearrange) one["missing"] = scene.missing;
    if (scene.statements > 0) {
      one["relations"] = scene.statements;
      one["relations_broken"] = scene.broken;
    }
    if (report.rearrange) {
      one["returned"] = scene.returned;
      one["lost"] = scene.lost;
    }
    json["scenes"].push_back(std::move(one));
  }
  json["seconds"] = report.seconds;
  json["seconds_of"] = {{"model", report.model_seconds},
                        {"assets", report.asset_seconds},
                        {"sampling", report.sampling_seconds},
                        {"physics", report.physics_seconds},
                        {"pictures", report.picture_seconds}};
  return core::JsonText(json);
}

}  // namespace simwright::workflows
