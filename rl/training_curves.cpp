#include "rl/training_curves.h"

#include <algorithm>
#include <cmath>

#include "core/line_plot.h"

namespace simwright::rl {
namespace {

constexpr double kHeight = 560.0;  // pixels

using Value = double TrainingRecord::*;

core::PlotPoints Points(const std::vector<TrainingRecord>& records, Value value) {
  core::PlotPoints points;
  for (const TrainingRecord& record : records) points.emplace_back(record.samples, record.*value);
  return points;
}

// Returns the records that a curve shows, without those before the first finished episode.
std::vector<TrainingRecord> Thinned(const std::vector<TrainingRecord>& records) {
  std::vector<TrainingRecord> ended;
  for (const TrainingRecord& record : records) {
    if (std::isfinite(record.mean_return)) ended.push_back(record);
  }
  std::vector<TrainingRecord> thinned;
  for (const std::size_t i : core::PlotIndices(ended.size())) thinned.push_back(ended[i]);
  return thinned;
}

core::PlotPanel ReturnPanel(const std::vector<TrainingRecord>& records, double samples) {
  core::PlotPanel panel{310.0, 490.0, 0.0, 1.0, samples};
  if (records.empty()) return panel;
  const auto [low, high] = std::minmax_element(
      records.begin(), records.end(), [](const TrainingRecord& a, const TrainingRecord& b) {
        return a.mean_return < b.mean_return;
      });
  const double room = std::max(0.05 * (high->mean_return - low->mean_return),
                               0.01 * std::max(1.0, std::abs(high->mean_return)));
  panel.low = low->mean_return - room;
  panel.high = high->mean_return + room;
  return panel;
}

}  // namespace

std::string TrainingCurves(const std::string& title, const std::vector<TrainingRecord>& records) {
  const std::vector<TrainingRecord> shown = Thinned(records);
  const double samples = records.empty() ? 1.0 : std::max(1.0, records.back().samples);
  const core::PlotPanel success{60.0, 240.0, 0.0, 1.0, samples};
  const core::PlotPanel rewards = ReturnPanel(shown, samples);
  std::string body = PlotAxes(success, "success rate, 95 % interval");
  body += PlotBand(success, Points(shown, &TrainingRecord::success_low),
                   Points(shown, &TrainingRecord::success_high), "band");
  body += PlotCurve(success, Points(shown, &TrainingRecord::success), "curve");
  body += PlotDots(success, Points(records, &TrainingRecord::examined), "dot");  // examinations
  body += PlotAxes(rewards, "mean return of an episode");
  body += PlotCurve(rewards, Points(shown, &TrainingRecord::mean_return), "curve");
  body += core::PlotText(0.5 * (core::kPlotLeft + core::kPlotRight), rewards.bottom + 42.0,
                         "middle", "samples");
  return core::PlotPage(title,
                        ".curve{stroke:#1f5fa8;stroke-width:1.8;fill:none}"
                        ".band{fill:#1f5fa8;fill-opacity:.2}.dot{fill:#c2571a}",
                        body, kHeight);
}

}  // namespace simwright::rl
