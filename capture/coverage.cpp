#include "capture/coverage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace simwright::capture {
namespace {

constexpr double kDegreesInRadian = 180.0 / std::numbers::pi;
constexpr double kWidestGap = 60.0, kLow = 25.0, kHigh = 50.0;  // degrees
constexpr double kOneSided = 150.0;                             // of a gap, degrees

core::Finding MorePhotos(const std::string& sentence, double figure, const std::string& remedy) {
  return {"more-photos", core::Severity::kInfo, "", sentence, figure, remedy};
}

}  // namespace

ViewDirection DirectionTo(const Eigen::Vector3d& object, const Eigen::Vector3d& camera) {
  const Eigen::Vector3d d = camera - object;
  return {std::atan2(d.y(), d.x()), std::atan2(d.z(), std::hypot(d.x(), d.y()))};
}

core::Findings MissingViews(const std::vector<ViewDirection>& directions) {
  core::Findings findings;
  if (directions.empty()) return findings;
  std::vector<double> azimuths;
  double lowest = 90.0, highest = -90.0;
  for (const ViewDirection& direction : directions) {
    azimuths.push_back(kDegreesInRadian * direction.azimuth);
    lowest = std::min(lowest, kDegreesInRadian * direction.elevation);
    highest = std::max(highest, kDegreesInRadian * direction.elevation);
  }
  std::sort(azimuths.begin(), azimuths.end());
  double widest = 0.0, from = 0.0;
  for (std::size_t i = 0; i < azimuths.size(); ++i) {
    const double next = i + 1 < azimuths.size() ? azimuths[i + 1] : azimuths[0] + 360.0;
    if (next - azimuths[i] <= widest) continue;
    widest = next - azimuths[i];
    from = azimuths[i];
  }
  if (widest > kWidestGap) {
    findings.push_back(MorePhotos("no photo shows the object from azimuths between " +
                                      std::to_string(std::lround(from)) + " and " +
                                      std::to_string(std::lround(from + widest)) + " degrees",
                                  widest, "move all around the object"));
    if (widest > kOneSided) findings.back().severity = core::Severity::kWarning;
  }
  if (lowest > kLow) {
    findings.push_back(
        MorePhotos("no photo is taken from below 25 degrees, so the height of flat "
                   "tops is uncertain",
                   lowest, "add a ring of photos from 10 to 20 degrees"));
  }
  if (highest < kHigh) {
    findings.push_back(
        MorePhotos("no photo is taken from above 50 degrees, so hollows and tops are "
                   "uncertain",
                   highest, "add some photos from 60 degrees"));
  }
  return findings;
}

}  // namespace simwright::capture
