#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "core/finding_json.h"
#include "core/json.h"
#include "core/line_plot.h"
#include "workflows/scenes/scene_post_training.h"

namespace simwright::workflows {
namespace {

std::string FormattedLine(const char* format, ...) {
  char line[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  return line;
}

std::string SamplesLine(const char* name, const PostTrainingSamples& samples) {
  return FormattedLine("%-7s %8.2f %8.2f %8d %10.0f %8.1f %8.0f %8.2f %8d\n", name, samples.reward,
                       samples.objects, samples.most_objects, 100.0 * samples.furnished,
                       100.0 * samples.accuracy, 100.0 * samples.valid, samples.kept_objects,
                       samples.most_kept_objects);
}

core::OrderedJson SamplesJson(const PostTrainingSamples& samples) {
  core::OrderedJson json;
  json["scenes"] = samples.scenes;
  json["reward"] = samples.reward;
  json["objects"] = samples.objects;
  json["most_objects"] = samples.most_objects;
  json["furnished"] = samples.furnished;
  json["classifier_accuracy"] = samples.accuracy;
  json["settled"] = samples.settled;
  json["valid"] = samples.valid;
  json["objects_after_physics"] = samples.kept_objects;
  json["most_objects_after_physics"] = samples.most_kept_objects;
  return json;
}

// Returns a vertical or horizontal line across a panel.
std::string LineAcross(double x1, double y1, double x2, double y2, const char* style) {
  return FormattedLine("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" class=\"%s\"/>\n", x1,
                       y1, x2, y2, style);
}

// Returns the panel of the rewards, with the data's maximum and the chosen round.
std::string RewardPanel(const ScenePostTrainingReport& report, double last) {
  core::PlotPoints mean, low, high;
  core::PlotPanel panel{60.0, 320.0, 0.0, 1.0, last};
  for (const size_t i : core::PlotIndices(report.training.rounds.size())) {
    const steering::RoundRecord& one = report.training.rounds[i];
    mean.emplace_back(one.round, one.reward);
    low.emplace_back(one.round, one.least);
    high.emplace_back(one.round, one.largest);
    panel.high = std::max(panel.high, one.largest);
    panel.low = std::min(panel.low, one.least);
  }
  const bool counts = report.objective == "objects";
  if (counts) panel.high = std::max<double>(panel.high, report.data_most_objects);
  panel.high += 0.05 * (panel.high - panel.low);
  const auto& checkpoints = report.training.checkpoints;
  const int chosen = checkpoints[static_cast<size_t>(report.training.chosen)].round;
  std::string text =
      PlotAxes(panel, "reward: " + report.objective) + PlotBand(panel, low, high, "range") +
      PlotCurve(panel, mean, "mean") +
      LineAcross(panel.X(chosen), panel.top, panel.X(chosen), panel.bottom, "chosen") +
      "<g class=\"name_chosen\">" +
      core::PlotText(panel.X(chosen) - 6.0, panel.bottom - 8.0, "end",
                     FormattedLine("chosen: round %d", chosen)) +
      "</g>\n";
  if (counts) {
    const double y = panel.Y(report.data_most_objects);
    text +=
        LineAcross(core::kPlotLeft, y, core::kPlotRight, y, "most") + "<g class=\"name_most\">" +
        core::PlotText(core::kPlotLeft + 8.0, y - 6.0, "start",
                       FormattedLine("most objects in the data: %d", report.data_most_objects)) +
        "</g>\n";
  }
  return text;
}

}  // namespace

std::string PostTrainingTable(const ScenePostTrainingReport& report) {
  const steering::PostTrainingReport& training = report.training;
  const steering::Checkpoint& chosen = training.checkpoints[static_cast<size_t>(training.chosen)];
  std::string text =
      FormattedLine("%s: reward \"%s\", %s model, %zu rounds, %.0f s\n", report.output.c_str(),
                    report.objective.c_str(), report.continuous ? "continuous" : "mixed",
                    training.rounds.size(), report.seconds);
  const char* const rule = chosen.score.accuracy <= report.largest_accuracy
                               ? "the largest reward with a classifier accuracy of at most "
                               : "the smallest classifier accuracy, because none is at most ";
  text += FormattedLine("chosen: round %d, %s%.1f %% (%.1f %%)\n", chosen.round, rule,
                        100.0 * report.largest_accuracy, 100.0 * chosen.score.accuracy);
  text += FormattedLine("objects in the data: mean %.2f, most %d\n", report.data_objects,
                        report.data_most_objects);
  text += "samples   reward  objects     most furnished%  class.%   whole%  settled     most\n";
  text += SamplesLine("before", report.before) + SamplesLine("after", report.after);
  text +=
      FormattedLine("time: sampling %.0f s, rewards %.0f s, updates %.0f s, checkpoints %.0f s\n",
                    training.sampling_seconds, training.reward_seconds, training.update_seconds,
                    training.scoring_seconds);
  return text;
}

std::string PostTrainingJson(const ScenePostTrainingReport& report) {
  const steering::PostTrainingReport& training = report.training;
  core::OrderedJson json;
  json["output"] = report.output.string();
  json["objective"] = report.objective;
  json["continuous"] = report.continuous;
  json["largest_accuracy"] = report.largest_accuracy;
  json["data"] = {{"mean_objects", report.data_objects},
                  {"most_objects", report.data_most_objects}};
  json["before"] = SamplesJson(report.before);
  json["after"] = SamplesJson(report.after);
  json["chosen_round"] = training.checkpoints[static_cast<size_t>(training.chosen)].round;
  core::OrderedJson checkpoints = core::OrderedJson::array();
  for (const steering::Checkpoint& one : training.checkpoints) {
    checkpoints.push_back({{"round", one.round},
                           {"reward", one.score.reward},
                           {"classifier_accuracy", one.score.accuracy}});
  }
  json["checkpoints"] = checkpoints;
  json["sampling_seconds"] = training.sampling_seconds;
  json["reward_seconds"] = training.reward_seconds;
  json["update_seconds"] = training.update_seconds;
  json["scoring_seconds"] = training.scoring_seconds;
  json["seconds"] = report.seconds;
  json["findings"] = core::FindingsJson(report.findings);
  return core::JsonText(json);
}

std::string PostTrainingCurves(const ScenePostTrainingReport& report) {
  const double last = std::max<double>(1.0, static_cast<double>(report.training.rounds.size()));
  core::PlotPanel panel{390.0, 570.0, 0.5, 1.0, last};
  core::PlotPoints accuracy;
  for (const steering::Checkpoint& one : report.training.checkpoints) {
    accuracy.emplace_back(one.round, one.score.accuracy);
  }
  const double y = panel.Y(report.largest_accuracy);
  const std::string body =
      RewardPanel(report, last) + PlotAxes(panel, "classifier accuracy against data") +
      PlotCurve(panel, accuracy, "mean") + PlotDots(panel, accuracy, "dot") +
      LineAcross(core::kPlotLeft, y, core::kPlotRight, y, "chosen") +
      core::PlotText(0.5 * (core::kPlotLeft + core::kPlotRight), 612.0, "middle", "rounds");
  return core::PlotPage("Post-training",
                        ".mean{stroke:#1f5fa8;stroke-width:1.8;fill:none}"
                        ".range{fill:#1f5fa8;fill-opacity:0.15;stroke:none}.dot{fill:#1f5fa8}"
                        ".most{stroke:#b3261e;stroke-width:1.2}.name_most{fill:#b3261e}"
                        ".chosen{stroke:#2e7d32;stroke-width:1.2}.name_chosen{fill:#2e7d32}",
                        body, 640.0);
}

}  // namespace simwright::workflows
