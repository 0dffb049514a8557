#include "scene/model/loss_records.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/files.h"
#include "core/line_plot.h"

namespace simwright::scene {
namespace {

constexpr char kHeader[] = "step,total,translation,rotation,classes,cross_entropy,held_out\n";

using Value = double LossRecord::*;

// Returns the points of a curve, clamped to the top of the panel.
core::PlotPoints Points(const core::PlotPanel& panel, const std::vector<LossRecord>& losses,
                        Value value) {
  core::PlotPoints points;
  for (const std::size_t i : core::PlotIndices(losses.size())) {
    points.emplace_back(losses[i].step, std::min(panel.high, losses[i].*value));
  }
  return points;
}

// Returns a panel from 0 to the maximum of both curves after a twentieth of the updates: the large
// initial losses would hide the later ones.
core::PlotPanel PanelOf(double top, double bottom, const std::vector<LossRecord>& losses, Value one,
                        Value other) {
  core::PlotPanel panel{top, bottom, 0.0, 1.0, 1.0};
  if (losses.empty()) return panel;
  panel.last = std::max(1, losses.back().step);
  double highest = 0.0;
  for (const LossRecord& loss : losses) {
    if (loss.step < losses.back().step && 20 * loss.step <= losses.back().step) continue;
    for (const double value : {loss.*one, loss.*other}) {
      if (std::isfinite(value)) highest = std::max(highest, value);
    }
  }
  if (highest > 0.0) panel.high = 1.1 * highest;
  return panel;
}

// Returns a panel with two curves and their names in matching colours.
std::string TwoCurves(double top, double bottom, const std::vector<LossRecord>& losses,
                      const std::string& label, Value one, const std::string& one_name, Value other,
                      const std::string& other_name) {
  const core::PlotPanel panel = PanelOf(top, bottom, losses, one, other);
  const double x = core::kPlotRight - 8.0;
  return PlotAxes(panel, label) + PlotCurve(panel, Points(panel, losses, one), "one") +
         PlotCurve(panel, Points(panel, losses, other), "other") + "<g class=\"name_one\">" +
         core::PlotText(x, top + 16.0, "end", one_name) + "</g><g class=\"name_other\">" +
         core::PlotText(x, top + 32.0, "end", other_name) + "</g>\n";
}

}  // namespace

std::string LossesText(const std::vector<LossRecord>& losses) {
  std::string text = kHeader;
  for (const LossRecord& one : losses) {
    char line[192];
    std::snprintf(line, sizeof line, "%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", one.step, one.total,
                  one.translation, one.rotation, one.classes, one.cross_entropy, one.held_out);
    text += line;
  }
  return text;
}

std::vector<LossRecord> ReadLosses(const std::filesystem::path& path, int step) {
  std::vector<LossRecord> losses;
  if (step == 0 || !std::filesystem::exists(path)) return losses;
  std::istringstream text(core::ReadFile(path));
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    LossRecord one;
    const int read = std::sscanf(line.c_str(), "%d,%lf,%lf,%lf,%lf,%lf,%lf", &one.step, &one.total,
                                 &one.translation, &one.rotation, &one.classes, &one.cross_entropy,
                                 &one.held_out);
    if (read == 7 && one.step <= step) losses.push_back(one);
  }
  return losses;
}

std::string LossCurves(const std::string& title, const std::vector<LossRecord>& losses) {
  const std::string body =
      TwoCurves(60.0, 280.0, losses, "loss", &LossRecord::total, "of updates",
                &LossRecord::held_out, "of the averaged weights, on held-out scenes") +
      TwoCurves(350.0, 570.0, losses, "error in the noise", &LossRecord::translation,
                "of translations", &LossRecord::rotation, "of rotations") +
      core::PlotText(0.5 * (core::kPlotLeft + core::kPlotRight), 612.0, "middle", "updates");
  return core::PlotPage(title,
                        ".one{stroke:#1f5fa8;stroke-width:1.8;fill:none}"
                        ".other{stroke:#c2571a;stroke-width:1.8;fill:none}"
                        ".name_one{fill:#1f5fa8}.name_other{fill:#c2571a}",
                        body, 640.0);
}

}  // namespace simwright::scene
