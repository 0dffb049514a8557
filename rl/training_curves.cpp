#include "rl/training_curves.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace simwright::rl {
namespace {

constexpr double kWidth = 760.0, kHeight = 560.0;  // pixels
constexpr double kLeft = 80.0, kRight = 740.0;
constexpr double kStroke = 6.0;           // pixels, half of it
constexpr std::size_t kMostPoints = 600;  // more than that no screen shows

// Where a panel's numbers lie on the page.
struct Panel {
  double top, bottom;  // pixels
  double low, high;    // the numbers there
  double samples;      // at the right end

  double X(double value) const { return kLeft + (kRight - kLeft) * value / samples; }
  double Y(double value) const { return bottom - (bottom - top) * (value - low) / (high - low); }
};

std::string Format(const char* format, double a, double b = 0.0, double c = 0.0, double d = 0.0) {
  char buffer[256];
  std::snprintf(buffer, sizeof(buffer), format, a, b, c, d);
  return buffer;
}

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

// 1, 2 or 5 times a power of ten, so that about five steps span the range.
double TickStep(double range) {
  const double rough = range / 5.0, power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (rough <= factor * power) return factor * power;
  }
  return 10.0 * power;
}

std::string SampleLabel(double samples) {
  if (samples >= 1e6) return Format("%.3gM", samples / 1e6);
  if (samples >= 1e3) return Format("%.3gk", samples / 1e3);
  return Format("%.0f", samples);
}

std::string Text(double x, double y, const char* anchor, const std::string& text) {
  return Format("<text x=\"%.1f\" y=\"%.1f\"", x, y) + " text-anchor=\"" + anchor + "\">" + text +
         "</text>\n";
}

std::string Axes(const Panel& panel, const std::string& label) {
  std::string out;
  const double step = TickStep(panel.high - panel.low);
  for (double v = std::ceil(panel.low / step) * step; v <= panel.high + 1e-9 * step; v += step) {
    const double y = panel.Y(v);
    out += Format("<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", kLeft, y, kRight);
    out += Text(kLeft - 8.0, y + 4.0, "end", Format("%.4g", std::abs(v) < 1e-9 * step ? 0.0 : v));
  }
  const double across = TickStep(panel.samples);
  for (double v = 0.0; v <= panel.samples * (1.0 + 1e-9); v += across) {
    out += Format("<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", panel.X(v), panel.top,
                  panel.bottom);
    out += Text(panel.X(v), panel.bottom + 18.0, "middle", SampleLabel(v));
  }
  const double middle = 0.5 * (panel.top + panel.bottom);
  out += Format("<g transform=\"translate(22 %.1f) rotate(-90)\">", middle) +
         Text(0.0, 0.0, "middle", label) + "</g>\n";
  return out;
}

using Value = double TrainingRecord::*;

// A lone record is a stroke as wide as a dot, from its left end to its right one or, with `sense`
// -1, back: of a point nothing would be seen.
std::string Points(const Panel& panel, const std::vector<TrainingRecord>& records, Value value,
                   double sense = 1.0) {
  std::string out;
  const auto add = [&](const TrainingRecord& record, double aside) {
    if (!std::isfinite(record.*value)) return;
    out += Format("%.1f,%.1f ", panel.X(record.samples) + aside, panel.Y(record.*value));
  };
  if (records.size() == 1) {
    for (const double side : {-1.0, 1.0}) add(records[0], side * sense * kStroke);
    return out;
  }
  for (const TrainingRecord& record : records) add(record, 0.0);
  return out;
}

std::string Curve(const Panel& panel, const std::vector<TrainingRecord>& records, Value value) {
  return "<polyline class=\"curve\" points=\"" + Points(panel, records, value) + "\"/>\n";
}

// The examinations, as dots.
std::string Dots(const Panel& panel, const std::vector<TrainingRecord>& records) {
  std::string out;
  for (const TrainingRecord& record : records) {
    if (!std::isfinite(record.examined)) continue;
    out += Format("<circle class=\"dot\" cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\"/>\n",
                  panel.X(record.samples), panel.Y(record.examined));
  }
  return out;
}

std::string Band(const Panel& panel, const std::vector<TrainingRecord>& records, Value low,
                 Value high) {
  const std::vector<TrainingRecord> back(records.rbegin(), records.rend());
  return "<polygon class=\"band\" points=\"" + Points(panel, records, high) +
         Points(panel, back, low, -1.0) + "\"/>\n";
}

// Every so many of the records, the last one among them; those without an ended episode left out.
std::vector<TrainingRecord> Thinned(const std::vector<TrainingRecord>& records) {
  std::vector<TrainingRecord> ended;
  for (const TrainingRecord& record : records) {
    if (std::isfinite(record.mean_return)) ended.push_back(record);
  }
  const std::size_t every = ended.size() / kMostPoints + 1;
  std::vector<TrainingRecord> thinned;
  for (std::size_t i = 0; i < ended.size(); ++i) {
    if ((ended.size() - 1 - i) % every == 0) thinned.push_back(ended[i]);
  }
  return thinned;
}

Panel ReturnPanel(const std::vector<TrainingRecord>& records, double samples) {
  Panel panel{310.0, 490.0, 0.0, 1.0, samples};
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
  const Panel success{60.0, 240.0, 0.0, 1.0, samples};
  const Panel rewards = ReturnPanel(shown, samples);
  std::string out =
      Format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" ", kWidth,
             kHeight) +
      "font-family=\"sans-serif\" font-size=\"12\" fill=\"#333\">\n"
      "<style>.grid{stroke:#ddd;fill:none}.curve{stroke:#1f5fa8;stroke-width:1.8;fill:none}"
      ".band{fill:#1f5fa8;fill-opacity:.2}.dot{fill:#c2571a}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  out += "<g font-size=\"15\">" + Text(0.5 * (kLeft + kRight), 32.0, "middle", Escaped(title)) +
         "</g>\n";
  out += Axes(success, "success rate, 95 % interval");
  out += Band(success, shown, &TrainingRecord::success_low, &TrainingRecord::success_high);
  out += Curve(success, shown, &TrainingRecord::success);
  out += Dots(success, records);
  out += Axes(rewards, "mean return of an episode");
  out += Curve(rewards, shown, &TrainingRecord::mean_return);
  out += Text(0.5 * (kLeft + kRight), rewards.bottom + 42.0, "middle", "samples");
  return out + "</svg>\n";
}

}  // namespace simwright::rl
