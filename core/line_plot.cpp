#include "core/line_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/text_template.h"

namespace simwright::core {
namespace data {

std::string_view line_plot_svg();

}  // namespace data
namespace {

constexpr double kWidth = 760.0;
constexpr double kStroke = 6.0;           // half the stroke of a single point
constexpr std::size_t kMostPoints = 600;  // per curve

std::string Format(const char* format, double a, double b = 0.0, double c = 0.0) {
  char buffer[256];
  std::snprintf(buffer, sizeof(buffer), format, a, b, c);
  return buffer;
}

// Returns 1, 2 or 5 times a power of ten, so that about five steps span the range.
double TickStep(double range) {
  const double rough = range / 5.0, power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (rough <= factor * power) return factor * power;
  }
  return 10.0 * power;
}

std::string CountLabel(double count) {
  if (count >= 1e6) return Format("%.3gM", count / 1e6);
  if (count >= 1e3) return Format("%.3gk", count / 1e3);
  return Format("%.0f", count);
}

// Returns SVG coordinates. A single point becomes a segment from left to right or, with `sense` -1,
// back.
std::string Points(const PlotPanel& panel, const PlotPoints& points, double sense) {
  std::string out;
  const auto add = [&](const std::pair<double, double>& point, double aside) {
    if (!std::isfinite(point.second)) return;
    out += Format("%.1f,%.1f ", panel.X(point.first) + aside, panel.Y(point.second));
  };
  if (points.size() == 1) {
    for (const double side : {-1.0, 1.0}) add(points[0], side * sense * kStroke);
    return out;
  }
  for (const auto& point : points) add(point, 0.0);
  return out;
}

}  // namespace

std::string PlotText(double x, double y, const std::string& anchor, const std::string& text) {
  return Format("<text x=\"%.1f\" y=\"%.1f\"", x, y) + " text-anchor=\"" + anchor + "\">" +
         EscapedMarkup(text) + "</text>\n";
}

std::string PlotPage(const std::string& title, const std::string& styles, const std::string& body,
                     double height) {
  return FillTemplate(
      data::line_plot_svg(),
      {{"width", Format("%.0f", kWidth)},
       {"height", Format("%.0f", height)},
       {"styles", Markup{styles}},
       {"title", Markup{PlotText(0.5 * (kPlotLeft + kPlotRight), 32.0, "middle", title)}},
       {"body", Markup{body}}});
}

std::string PlotAxes(const PlotPanel& panel, const std::string& label) {
  std::string out;
  const double step = TickStep(panel.high - panel.low);
  for (double v = std::ceil(panel.low / step) * step; v <= panel.high + 1e-9 * step; v += step) {
    const double y = panel.Y(v);
    out += Format("<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", kPlotLeft, y, kPlotRight);
    out += PlotText(kPlotLeft - 8.0, y + 4.0, "end",
                    Format("%.4g", std::abs(v) < 1e-9 * step ? 0.0 : v));
  }
  const double across = TickStep(panel.last);
  for (double v = 0.0; v <= panel.last * (1.0 + 1e-9); v += across) {
    out += Format("<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", panel.X(v), panel.top,
                  panel.bottom);
    out += PlotText(panel.X(v), panel.bottom + 18.0, "middle", CountLabel(v));
  }
  const double middle = 0.5 * (panel.top + panel.bottom);
  return out + Format("<g transform=\"translate(22 %.1f) rotate(-90)\">", middle) +
         PlotText(0.0, 0.0, "middle", label) + "</g>\n";
}

std::string PlotCurve(const PlotPanel& panel, const PlotPoints& points, const std::string& style) {
  return "<polyline class=\"" + style + "\" points=\"" + Points(panel, points, 1.0) + "\"/>\n";
}

std::string PlotBand(const PlotPanel& panel, const PlotPoints& low, const PlotPoints& high,
                     const std::string& style) {
  const PlotPoints back(low.rbegin(), low.rend());
  return "<polygon class=\"" + style + "\" points=\"" + Points(panel, high, 1.0) +
         Points(panel, back, -1.0) + "\"/>\n";
}

std::string PlotDots(const PlotPanel& panel, const PlotPoints& points, const std::string& style) {
  std::string out;
  for (const auto& [x, y] : points) {
    if (!std::isfinite(y)) continue;
    out += "<circle class=\"" + style + "\" " +
           Format("cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\"/>\n", panel.X(x), panel.Y(y));
  }
  return out;
}

std::vector<std::size_t> PlotIndices(std::size_t count) {
  const std::size_t every = count / kMostPoints + 1;
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < count; ++i) {
    if ((count - 1 - i) % every == 0) shown.push_back(i);
  }
  return shown;
}

}  // namespace simwright::core
