#include <algorithm>
#include <cstdio>

#include "core/json.h"
#include "workflows/scenes/scene_generation.h"

namespace simwright::workflows {
namespace {

constexpr int kBins = 8, kBar = 24;  // table lines, characters of the longest bar

int Between(const std::vector<int>& counts, size_t from, size_t to) {
  int sum = 0;
  for (size_t i = from; i < std::min(to, counts.size()); ++i) sum += counts[i];
  return sum;
}

// Formats the shares of samples and of accepted scenes by their number of objects.
std::string CountsTable(const SceneStatistics& statistics) {
  const size_t longest = std::max(statistics.drawn_counts.size(), statistics.scene_counts.size());
  const size_t step = (longest + kBins - 1) / kBins;
  std::string text = "  objects    sampled   kept\n";
  for (size_t from = 0; step > 0 && from < longest; from += step) {
    const double drawn = Between(statistics.drawn_counts, from, from + step) /
                         std::max(1.0, 1.0 * statistics.attempts);
    const double kept = Between(statistics.scene_counts, from, from + step) /
                        std::max(1.0, 1.0 * statistics.scenes);
    if (drawn == 0.0 && kept == 0.0) continue;
    char line[96];
    std::snprintf(line, sizeof line, "  %3zu to %3zu  %5.1f%%  %5.1f%%  ", from, from + step - 1,
                  100.0 * drawn, 100.0 * kept);
    text += line + std::string(static_cast<size_t>(kBar * kept + 0.5), '#') + "\n";
  }
  return text;
}

std::string ElsewhereText(const SceneStatistics& statistics) {
  if (statistics.elsewhere == 0) return "";
  return std::to_string(statistics.elsewhere) + " shards are being made by other workers\n";
}

}  // namespace

core::Findings DroppedFindings(const SceneStatistics& statistics) {
  constexpr double kFew = 0.1;
  const double share = 1.0 - statistics.kept;
  if (share <= kFew) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "%.0f %% of the objects of these scenes, %.1f per scene, were dropped: they "
                "interpenetrated, fell or found no support",
                100.0 * share, statistics.dropped);
  return {{"objects-dropped", core::Severity::kWarning, statistics.type, text, share,
           "give more --steps if they are sampled, smaller assets, or --raw to see the "
           "samples"}};
}

std::string StatisticsTable(const SceneStatistics& statistics) {
  char text[640];
  if (!statistics.physics) {
    std::snprintf(
        text, sizeof text,
        "%d scenes of %s, as sampled: without physics they interpenetrate and do not rest\n"
        "objects: mean %.1f, at most %d\n",
        statistics.scenes, statistics.type.c_str(), statistics.mean_objects,
        statistics.most_objects);
    return text + CountsTable(statistics) + ElsewhereText(statistics);
  }
  std::snprintf(text, sizeof text,
                "%d scenes of %s, %.1f %% of %d attempts, with %.1f %% of their objects kept\n"
                "objects: mean %.1f (%.1f sampled), at most %d; %.2f dropped per scene\n"
                "mean displacement %.1f mm; worst penetration %.3f mm, worst drift %.2f mm\n",
                statistics.scenes, statistics.type.c_str(), 100.0 * statistics.yield,
                statistics.attempts, 100.0 * statistics.kept, statistics.mean_objects,
                statistics.mean_drawn, statistics.most_objects, statistics.dropped,
                1e3 * statistics.moved, 1e3 * statistics.penetration, 1e3 * statistics.drift);
  std::string table = text + CountsTable(statistics);
  if (statistics.too_few > 0) {
    table += std::to_string(statistics.too_few) +
             " more are collision-free and stable, but have too few objects left\n";
  }
  return table + ElsewhereText(statistics);
}

std::string StatisticsJson(const SceneStatistics& statistics) {
  core::OrderedJson json;
  json["type"] = statistics.type;
  if (!statistics.physics) json["physics"] = false;
  json["scenes"] = statistics.scenes;
  json["attempts"] = statistics.attempts;
  json["too_few"] = statistics.too_few;
  json["yield"] = statistics.yield;
  json["objects_mean"] = statistics.mean_objects;
  json["objects_drawn_mean"] = statistics.mean_drawn;
  json["objects_max"] = statistics.most_objects;
  json["dropped_mean"] = statistics.dropped;
  json["kept_share"] = statistics.kept;
  json["moved_mean_m"] = statistics.moved;
  json["penetration_max_m"] = statistics.penetration;
  json["drift_max_m"] = statistics.drift;
  json["drawn_by_objects"] = statistics.drawn_counts;
  json["scenes_by_objects"] = statistics.scene_counts;
  if (statistics.elsewhere > 0) json["parts_elsewhere"] = statistics.elsewhere;
  return core::JsonText(json);
}

}  // namespace simwright::workflows
