#include "capture/mat_sharpness.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "capture/capture_mat.h"

namespace simwright::capture {
namespace {

// Shares of a square's side: how far the profile across an edge reaches to both sides (markers
// begin farther from it), and the positions along the edge where it is measured.
constexpr double kProfileReach = 0.14;
constexpr double kAlong[] = {0.35, 0.5, 0.65};
constexpr double kLeastSide = 12.0;       // pixels, of a square whose edges are measured
constexpr double kLeastContrast = 25.0;   // of 255
constexpr double kWide = 0.0014;          // m, from which an edge is blurred, where it is ...
constexpr double kWiderThanOthers = 1.4;  // ... this many times as wide as the median
constexpr double kAllWide = 0.0022;       // m, of the median: all photos are blurred

double GreyAt(const core::Image& photo, const Eigen::Vector2d& at) {
  const double x = std::clamp(at.x() - 0.5, 0.0, photo.width - 1.001);
  const double y = std::clamp(at.y() - 0.5, 0.0, photo.height - 1.001);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const auto grey = [&](int px, int py) {
    const std::uint8_t* p = photo.At(px, py);
    return photo.channels < 3 ? static_cast<double>(p[0])
                              : 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
  };
  const double a = x - i, b = y - j;
  return (1 - b) * ((1 - a) * grey(i, j) + a * grey(i + 1, j)) +
         b * ((1 - a) * grey(i, j + 1) + a * grey(i + 1, j + 1));
}

// Returns the width of the step across the edge from p to q as a share of its length; -1 if there
// is no step.
double StepWidth(const core::Image& photo, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  const Eigen::Vector2d way = q - p;
  const double side = way.norm();
  if (side < kLeastSide) return -1.0;
  const Eigen::Vector2d across = Eigen::Vector2d(-way.y(), way.x()) / side;
  const int steps = std::max(2, static_cast<int>(std::lround(kProfileReach * side * 2.0)));
  const double pixels = kProfileReach * side / steps;  // between samples
  std::vector<double> profile(2 * static_cast<std::size_t>(steps) + 1, 0.0);
  for (const double along : kAlong) {
    for (int k = -steps; k <= steps; ++k) {
      profile[static_cast<std::size_t>(k + steps)] +=
          GreyAt(photo, p + along * way + k * pixels * across) / std::size(kAlong);
    }
  }
  const auto [low, high] = std::minmax_element(profile.begin(), profile.end());
  const double contrast = *high - *low;
  if (contrast < kLeastContrast) return -1.0;
  double steepest = 0.0;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    steepest = std::max(steepest, std::abs(profile[k + 1] - profile[k]) / pixels);
  }
  return contrast / steepest / side;
}

std::string Millimetres(double width) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f mm", 1000.0 * width);
  return text;
}

}  // namespace

double EdgeWidthOnMat(const core::Image& photo, const MatObservation& mat) {
  const CaptureMat& page = CaptureMatOf(mat.paper);
  const int row = page.columns - 1;  // inner corners of a row
  std::map<int, Eigen::Vector2d> pixel_of;
  for (std::size_t i = 0; i < mat.corners.size(); ++i) pixel_of[mat.corners[i]] = mat.pixels[i];
  std::vector<double> widths;
  for (const auto& [corner, pixel] : pixel_of) {
    for (const int next : {corner + 1, corner + row}) {
      const auto other = pixel_of.find(next);
      if (other == pixel_of.end() || (next == corner + 1 && next % row == 0)) continue;
      const double width = StepWidth(photo, pixel, other->second);
      if (width > 0.0) widths.push_back(width * page.square);
    }
  }
  if (widths.empty()) return 0.0;
  std::nth_element(widths.begin(), widths.begin() + std::ssize(widths) / 2, widths.end());
  return widths[widths.size() / 2];
}

core::Findings BlurredPhotos(const std::vector<double>& widths,
                             const std::vector<std::string>& names) {
  std::vector<double> known;
  for (const double width : widths) {
    if (width > 0.0) known.push_back(width);
  }
  if (known.empty()) return {};
  std::nth_element(known.begin(), known.begin() + std::ssize(known) / 2, known.end());
  const double median = known[known.size() / 2];
  constexpr const char* kRemedy = "take it again with a steady hand and more light";
  if (median > kAllWide) {
    return {{"photo-blurred", core::Severity::kWarning, "",
             "most photos are blurred: edges of the mat are " + Millimetres(median) +
                 " wide in the median photo, so outline and texture are as coarse",
             median, "take them again with a steady hand, more light, and the mat in focus"}};
  }
  core::Findings findings;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (widths[i] < kWide || widths[i] < kWiderThanOthers * median) continue;
    findings.push_back({"photo-blurred", core::Severity::kWarning, names[i],
                        "the photo is blurred: edges of the mat are " + Millimetres(widths[i]) +
                            " wide, in the median photo " + Millimetres(median),
                        widths[i], kRemedy});
  }
  return findings;
}

}  // namespace simwright::capture
