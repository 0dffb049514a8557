#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace simwright::core {

// Pieces of a picture (SVG) of curves over a number that counts up from 0: panels above each other,
// each with axes of its own. Lengths in pixels of a page 760 wide.
inline constexpr double kPlotLeft = 80.0, kPlotRight = 740.0;

struct PlotPanel {
  double top = 60.0, bottom = 240.0;  // on the page
  double low = 0.0, high = 1.0;       // the numbers there, low < high
  double last = 1.0;                  // the number at the right end, above 0

  double X(double value) const { return kPlotLeft + (kPlotRight - kPlotLeft) * value / last; }
  double Y(double value) const { return bottom - (bottom - top) * (value - low) / (high - low); }
};

// Points of a curve, (x, y) in the panel's numbers; those that are not finite are left out.
using PlotPoints = std::vector<std::pair<double, double>>;

// A page of that height: the title and what is on it. `styles` is CSS for classes of its own,
// beside those of this header.
std::string PlotPage(const std::string& title, const std::string& styles, const std::string& body,
                     double height);
// Grid, numbers and the label of a panel.
std::string PlotAxes(const PlotPanel& panel, const std::string& label);
// A curve; `style` is its class. A lone point is a stroke as wide as a dot.
std::string PlotCurve(const PlotPanel& panel, const PlotPoints& points, const std::string& style);
// The area between two curves.
std::string PlotBand(const PlotPanel& panel, const PlotPoints& low, const PlotPoints& high,
                     const std::string& style);
std::string PlotDots(const PlotPanel& panel, const PlotPoints& points, const std::string& style);
// `anchor` is SVG's: "start", "middle" or "end"; the text is escaped.
std::string PlotText(double x, double y, const std::string& anchor, const std::string& text);

// Which of `count` records to show, the last among them: more than 600 no screen shows.
std::vector<std::size_t> PlotIndices(std::size_t count);

}  // namespace simwright::core
