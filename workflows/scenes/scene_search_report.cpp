#include <algorithm>
#include <cstdio>

#include "core/json.h"
#include "core/line_plot.h"
#include "workflows/scenes/scene_search.h"

namespace simwright::workflows {
namespace {

core::OrderedJson RecordsJson(const std::vector<steering::SearchRecord>& records) {
  core::OrderedJson list = core::OrderedJson::array();
  for (const steering::SearchRecord& one : records) {
    list.push_back({{"best", one.best},
                    {"reward", one.reward},
                    {"nodes", one.nodes},
                    {"samples", one.samples}});
  }
  return list;
}

core::PlotPoints BestBySamples(double start, const std::vector<steering::SearchRecord>& records) {
  core::PlotPoints points = {{1.0, start}};
  for (const size_t i : core::PlotIndices(records.size())) {
    points.emplace_back(records[i].samples, std::max(start, records[i].best));
  }
  return points;
}

std::string MovedText(const LargestDisplacement& moved) {
  if (moved.name.empty()) return "no free object";
  char text[128];
  std::snprintf(text, sizeof text, "%.3f mm (%s)", 1e3 * moved.moved, moved.name.c_str());
  return text;
}

}  // namespace

std::string SearchCurves(const SceneSearchReport& report) {
  core::PlotPanel panel{50.0, 380.0, 0.0, 1.0, 1.0};
  panel.high = std::max({report.goal, report.best_reward, 1e-9}) * 1.03;
  panel.low = std::min(0.0, report.start_reward);
  for (const auto* records : {&report.records, &report.random_records}) {
    if (!records->empty()) panel.last = std::max(panel.last, 1.0 * records->back().samples);
  }
  std::string body = PlotAxes(panel, report.objective);
  if (!report.random_records.empty()) {
    const double first = report.random_records.front().best;
    body += PlotCurve(panel, BestBySamples(first, report.random_records), "random");
  }
  body += PlotCurve(panel, BestBySamples(report.start_reward, report.records), "search");
  const bool both = !report.random_records.empty();
  return core::PlotPage(std::string("Best reward by scenes sampled") +
                            (both ? ": tree search blue, random search grey" : ""),
                        ".search{fill:none;stroke:#1f6fb2;stroke-width:2}"
                        ".random{fill:none;stroke:#999;stroke-width:2}",
                        body, 420.0);
}

std::string SearchTable(const SceneSearchReport& report) {
  const int samples = report.records.empty() ? 1 : report.records.back().samples;
  const double iterations = std::max(1, report.iterations_run);
  char text[1024];
  std::snprintf(text, sizeof text,
                "%s: %s, best %g of %g after %d iterations (%d scenes sampled), from %g\n"
                "the best scene was found in iteration %d at depth %d; feasible objects in the "
                "search %d\n",
                report.output.c_str(), report.objective.c_str(), report.best_reward, report.goal,
                static_cast<int>(report.records.size()), samples, report.start_reward,
                report.best_iteration, report.depth, report.feasible_in_search);
  std::string table = text;
  if (!report.random_records.empty()) {
    std::snprintf(text, sizeof text, "random search: best %g of as many scenes\n",
                  report.random_records.back().best);
    table += text;
  }
  if (!report.interrupted) {
    std::snprintf(
        text, sizeof text,
        "after full physics: %d objects, reward %g; largest displacement in Bullet %s, in "
        "MuJoCo %s\n",
        report.objects, report.final_reward, MovedText(report.stability.bullet).c_str(),
        MovedText(report.stability.mujoco).c_str());
    table += text;
  }
  std::snprintf(text, sizeof text, "%.1f s; an iteration takes %.2f s: model %.2f, physics %.2f\n",
                report.seconds, (report.model_seconds + report.physics_seconds) / iterations,
                report.model_seconds / iterations, report.physics_seconds / iterations);
  return table + text;
}

std::string SearchJson(const SceneSearchReport& report) {
  core::OrderedJson json;
  json["output"] = report.output.string();
  json["objective"] = report.objective;
  json["goal"] = report.goal;
  json["reached_goal"] = report.reached_goal;
  json["interrupted"] = report.interrupted;
  json["start_reward"] = report.start_reward;
  json["best_reward"] = report.best_reward;
  json["best_iteration"] = report.best_iteration;
  json["best_depth"] = report.depth;
  json["feasible_in_search"] = report.feasible_in_search;
  json["objects"] = report.objects;
  json["final_reward"] = report.final_reward;
  if (!report.interrupted) {
    json["still"] = report.stability.Still();
    json["moved_mm"] = {{"bullet", 1e3 * report.stability.bullet.moved},
                        {"mujoco", 1e3 * report.stability.mujoco.moved}};
  }
  json["iterations"] = RecordsJson(report.records);
  if (!report.random_records.empty()) json["random"] = RecordsJson(report.random_records);
  json["seconds"] = report.seconds;
  json["seconds_of"] = {{"model", report.model_seconds}, {"physics", report.physics_seconds}};
  return core::JsonText(json);
}

}  // namespace simwright::workflows
