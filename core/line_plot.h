#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace simwright::core {

// Building blocks of SVG line plots over a number that counts up from 0: stacked panels, each with
// its own axes. Lengths are in pixels of a page 760 wide.
inline constexpr double kPlotLeft = 80.0, kPlotRight = 740.0;

struct PlotPanel {
  double top = 60.0, bottom = 240.0;  // on the page
  double low = 0.0, high = 1.0;       // the values at `bottom` and `top`, low < high
  double last = 1.0;                  // the value at the right end, above 0

  double X(double value) const { return kPlotLeft + (kPlotRight - kPlotLeft) * value / last; }
  double Y(double value) const { return bottom - (bottom - top) * (value - low) / (high - low); }
};

// The points (x, y) of a curve in the panel's values; points that are not finite are left out.
using PlotPoints = std::vector<std::pair<double, double>>;

// Returns an SVG page of the given height with a title and a body. `styles` is CSS for additional
// classes besides those of this header.
std::string PlotPage(const std::string& title, const std::string& styles, const std::string& body,
                     double height);
// Returns a panel's grid, tick labels and axis label.
std::string PlotAxes(const PlotPanel& panel, const std::string& label);
// Returns a curve; `style` is its class. A single point becomes a stroke as wide as a dot.
std::string PlotCurve(const PlotPanel& panel, const PlotPoints& points, const std::string& style);
// Returns the area between two curves.
std::string PlotBand(const PlotPanel& panel, const PlotPoints& low, const PlotPoints& high,
                     const std::string& style);
std::string PlotDots(const PlotPanel& panel, const PlotPoints& points, const std::string& style);
// Returns a text element. `anchor` is SVG's "start", "middle" or "end"; the text is escaped.
std::string PlotText(double x, double y, const std::string& anchor, const std::string& text);

// Selects at most about 600 of `count` records to plot, the last among them: a screen shows no
// more.
std::vector<std::size_t> PlotIndices(std::size_t count);

}  // namespace simwright::core
