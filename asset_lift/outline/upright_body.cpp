#include "asset_lift/outline/upright_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace simwright::asset_lift {
namespace {

constexpr int kLevels = 110;

struct Sights {
  std::vector<Eigen::Vector3d> outline;  // ray directions through background pixels next to the
                                         // mask
  std::vector<Eigen::Vector3d> inside;   // through sampled mask pixels
};

Sights CollectSights(const cv::Mat& mask, const core::Camera& camera) {
  Sights sights;
  cv::Mat grown;
  cv::dilate(mask, grown, cv::Mat::ones(3, 3, CV_8U));
  const int stride = std::max(1, static_cast<int>(std::sqrt(cv::countNonZero(mask) / 3000.0)));
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const bool in = mask.at<uchar>(y, x) != 0;
      const Eigen::Vector2d center(x + 0.5, y + 0.5);
      if (!in && grown.at<uchar>(y, x)) {
        sights.outline.push_back(camera.Ray(center));
      } else if (in && x % stride == 0 && y % stride == 0) {
        sights.inside.push_back(camera.Ray(center));
      }
    }
  }
  return sights;
}

// Computes the radius per level for one axis.
void FillRadii(const Sights& sights, const cv::Mat& mask, const core::Camera& camera,
               UprightBody* body) {
  const Eigen::Vector3d eye = camera.position();
  for (size_t level = 0; level < body->radius.size(); ++level) {
    const double z = body->bottom + body->step * static_cast<double>(level);
    const Eigen::Vector3d pixel = camera.Project({body->axis_x, body->axis_y, z});
    const int px = static_cast<int>(std::floor(pixel.x())),
              py = static_cast<int>(std::floor(pixel.y()));
    body->radius[level] = 0.0;
    if (px < 0 || py < 0 || px >= mask.cols || py >= mask.rows) continue;
    if (mask.at<uchar>(py, px) == 0) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& ray : sights.outline) {
      const double t = (z - eye.z()) / ray.z();
      if (!(t > 0.0)) continue;
      const double dx = eye.x() + t * ray.x() - body->axis_x;
      const double dy = eye.y() + t * ray.y() - body->axis_y;
      nearest = std::min(nearest, dx * dx + dy * dy);
    }
    if (std::isfinite(nearest)) body->radius[level] = std::sqrt(nearest);
  }
}

// Returns the share of the sampled inside rays that the body covers. Per ray it finds the range of
// levels that cover it, as [first, last], and whether any does.
double Coverage(const Sights& sights, const core::Camera& camera, const UprightBody& body,
                size_t first, size_t last) {
  const Eigen::Vector3d eye = camera.position();
  int covered = 0;
  for (const Eigen::Vector3d& ray : sights.inside) {
    for (size_t level = first; level <= last; ++level) {
      if (body.radius[level] <= 0.0) continue;
      const double z = body.bottom + body.step * static_cast<double>(level);
      const double t = (z - eye.z()) / ray.z();
      if (!(t > 0.0)) continue;
      const double dx = eye.x() + t * ray.x() - body.axis_x;
      const double dy = eye.y() + t * ray.y() - body.axis_y;
      // Half a level's depth of slack: levels sample a continuous body.
      const double slack = 0.5 * body.step * std::abs(ray.head<2>().norm() / ray.z());
      const double reach = body.radius[level] + std::min(slack, 0.5 * body.radius[level]);
      if (dx * dx + dy * dy <= reach * reach) {
        ++covered;
        break;
      }
    }
  }
  return static_cast<double>(covered) /
         static_cast<double>(std::max<size_t>(1, sights.inside.size()));
}

// Cuts levels from one end while the silhouette is unchanged; binary search on the number cut.
void TrimEnds(const Sights& sights, const core::Camera& camera, UprightBody* body) {
  size_t first = 0, last = body->radius.size() - 1;
  while (first < last && body->radius[first] <= 0.0) ++first;
  while (last > first && body->radius[last] <= 0.0) --last;
  constexpr double kLoss = 0.004;
  const double whole = Coverage(sights, camera, *body, first, last);
  for (const bool lower : {true, false}) {
    size_t keep = 0, cut = last - first;
    while (keep < cut) {
      const size_t middle = (keep + cut + 1) / 2;
      const size_t a = lower ? first + middle : first, b = lower ? last : last - middle;
      if (b > a && Coverage(sights, camera, *body, a, b) >= whole - kLoss) {
        keep = middle;
      } else {
        cut = middle - 1;
      }
    }
    (lower ? first : last) += lower ? keep : -keep;
  }
  const double bottom = body->bottom + body->step * static_cast<double>(first);
  body->radius = std::vector<double>(body->radius.begin() + static_cast<long>(first),
                                     body->radius.begin() + static_cast<long>(last) + 1);
  body->bottom = bottom;
}

// Returns the middle, in pixels, of the mask's run around column `x` of a row; negative where there
// is none.
double MiddleOfRun(const cv::Mat& mask, int row, int x) {
  if (row < 0 || row >= mask.rows || x < 0 || x >= mask.cols || mask.at<uchar>(row, x) == 0) {
    return -1.0;
  }
  int left = x, right = x;
  while (left > 0 && mask.at<uchar>(row, left - 1) != 0) --left;
  while (right + 1 < mask.cols && mask.at<uchar>(row, right + 1) != 0) ++right;
  return 0.5 * (left + right + 1);
}

// Returns the axis position that is in the middle of most levels' rows. Rows that a handle widens
// on one side are a minority, since the hole inside the handle ends the row's run.
double MiddleAxis(const cv::Mat& mask, const core::Camera& camera, const UprightBody& body) {
  std::vector<double> shifts;  // world
  for (size_t level = 0; level < body.radius.size(); ++level) {
    if (body.radius[level] <= 0.0) continue;
    const double z = body.bottom + body.step * static_cast<double>(level);
    const Eigen::Vector3d pixel = camera.Project({body.axis_x, body.axis_y, z});
    const double middle =
        MiddleOfRun(mask, static_cast<int>(pixel.y()), static_cast<int>(pixel.x()));
    if (middle < 0.0) continue;
    const Eigen::Vector3d aside = camera.Project({body.axis_x + body.step, body.axis_y, z});
    shifts.push_back((middle - pixel.x()) * body.step / (aside.x() - pixel.x()));
  }
  if (shifts.empty()) return body.axis_x;
  std::nth_element(shifts.begin(), shifts.begin() + static_cast<long>(shifts.size() / 2),
                   shifts.end());
  return body.axis_x + shifts[shifts.size() / 2];
}

// Returns the uppermost row, in pixels, that a disc reaches.
double TopRow(const core::Camera& camera, const UprightBody& body, double z, double radius) {
  double top = std::numeric_limits<double>::infinity();
  constexpr int kSides = 72;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2.0 * M_PI * k / kSides;
    const Eigen::Vector3d p = camera.Project(
        {body.axis_x + radius * std::cos(angle), body.axis_y + radius * std::sin(angle), z});
    top = std::min(top, p.y());
  }
  return top;
}

}  // namespace

double UprightBody::RadiusAt(double z) const {
  const double at = (z - bottom) / step;
  if (at < 0.0 || at > static_cast<double>(radius.size() - 1)) return 0.0;
  const size_t low = std::min(radius.size() - 2, static_cast<size_t>(at));
  const double f = at - static_cast<double>(low);
  return (1.0 - f) * radius[low] + f * radius[low + 1];
}

double UprightBody::MaxRadius() const {
  return *std::max_element(radius.begin(), radius.end());
}

UprightBody FitUprightBody(const cv::Mat& mask, const core::Camera& camera) {
  const Sights sights = CollectSights(mask, camera);
  const cv::Rect box = cv::boundingRect(mask);
  // The mask's bounding box at the object's distance bounds the body; discs extend in front and
  // behind.
  const double unit = camera.position().norm();
  const double pixel = unit / camera.fy;
  const double half = pixel * std::max(box.width, box.height);
  UprightBody body;
  body.bottom = -half;
  body.step = 2.0 * half / (kLevels - 1);
  body.radius.assign(kLevels, 0.0);
  UprightBody best = body;
  const double left = pixel * (box.x - 0.5 * mask.cols), width = pixel * box.width;
  const Eigen::Vector3d middle = camera.world_from_camera.inverse() * Eigen::Vector3d::Zero();
  const double center_x = middle.x();  // lateral position of the origin before the camera
  const double left_world = left - (camera.cx - 0.5 * mask.cols) * pixel - center_x;
  double from = left_world + 0.15 * width, to = left_world + 0.85 * width;
  for (int round_of_search = 0; round_of_search < 3; ++round_of_search) {
    const double stride = (to - from) / 14.0;
    for (int i = 0; i <= 14; ++i) {
      body.axis_x = from + stride * i;
      FillRadii(sights, mask, camera, &body);
      body.coverage = Coverage(sights, camera, body, 0, body.radius.size() - 1);
      if (body.coverage > best.coverage) best = body;
    }
    from = best.axis_x - stride;
    to = best.axis_x + stride;
  }
  if (best.coverage <= 0.0) return best;
  body.axis_x = MiddleAxis(mask, camera, best);
  FillRadii(sights, mask, camera, &body);
  body.coverage = Coverage(sights, camera, body, 0, body.radius.size() - 1);
  constexpr double kAsMuch = 0.01;
  if (body.coverage >= best.coverage - kAsMuch) best = body;
  TrimEnds(sights, camera, &best);
  return best;
}

bool RestoreRim(const cv::Mat& mask, const core::Camera& camera, UprightBody* body) {
  const double height = body->top() - body->bottom;
  const auto at = [&](double share) { return body->RadiusAt(body->bottom + share * height); };
  // The wall is a line through the radii at 0.6 and 0.82 of the height.
  constexpr double kLow = 0.6, kHigh = 0.82, kShoulder = 0.97;
  const double slope = (at(kHigh) - at(kLow)) / ((kHigh - kLow) * height);
  const auto wall = [&](double z) {
    return at(kHigh) + slope * (z - body->bottom - kHigh * height);
  };
  if (body->radius.size() < 12 || !(at(kLow) > 0.0)) return false;
  if (body->radius.back() >= kShoulder * wall(body->top())) return false;
  const double row = cv::boundingRect(mask).y;
  double top = body->bottom + kHigh * height;
  const double fine = 0.1 * body->step;
  while (top < body->top() && wall(top) > 0.0 && TopRow(camera, *body, top, wall(top)) > row) {
    top += fine;
  }
  UprightBody sharp = *body;
  sharp.step = (top - body->bottom) / static_cast<double>(body->radius.size() - 1);
  for (size_t level = 0; level < sharp.radius.size(); ++level) {
    const double z = sharp.bottom + sharp.step * static_cast<double>(level);
    const bool below = z <= body->bottom + kHigh * height;
    sharp.radius[level] = below ? body->RadiusAt(z) : wall(z);
  }
  *body = sharp;
  return true;
}

WallLine FitWallLine(const UprightBody& body) {
  // Feet are rounded, and discs shrink towards a rim (RestoreRim).
  const size_t first = body.radius.size() * 15 / 100, last = body.radius.size() * 82 / 100;
  double count = 0.0, at = 0.0, radius = 0.0, at_at = 0.0, at_radius = 0.0;
  for (size_t level = first; level <= last; ++level) {
    const double share = static_cast<double>(level) / static_cast<double>(body.radius.size() - 1);
    count += 1.0;
    at += share;
    radius += body.radius[level];
    at_at += share * share;
    at_radius += share * body.radius[level];
  }
  WallLine line;
  const double mean = radius / count;
  if (!(mean > 0.0)) return {0.0, 1.0};
  const double slope = (at_radius - at * mean) / (at_at - at * at / count);
  double squares = 0.0;
  for (size_t level = first; level <= last; ++level) {
    const double share = static_cast<double>(level) / static_cast<double>(body.radius.size() - 1);
    const double off = body.radius[level] - mean - slope * (share - at / count);
    squares += off * off;
  }
  line.taper = slope / mean;
  line.deviation = std::sqrt(squares / count) / mean;
  return line;
}

cv::Mat Silhouette(const UprightBody& body, const core::Camera& camera) {
  cv::Mat mask = cv::Mat::zeros(camera.height, camera.width, CV_8U);
  constexpr int kSides = 64;
  std::vector<cv::Point> polygon(kSides);
  // Twice as many discs as levels close the gaps between them.
  for (size_t i = 0; i + 1 < 2 * body.radius.size(); ++i) {
    const double z = body.bottom + 0.5 * body.step * static_cast<double>(i);
    const double radius = body.RadiusAt(z);
    if (radius <= 0.0) continue;
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2.0 * M_PI * k / kSides;
      const Eigen::Vector3d p = camera.Project(
          {body.axis_x + radius * std::cos(angle), body.axis_y + radius * std::sin(angle), z});
      polygon[static_cast<size_t>(k)] =
          cv::Point(static_cast<int>(std::lround(16.0 * (p.x() - 0.5))),
                    static_cast<int>(std::lround(16.0 * (p.y() - 0.5))));
    }
    cv::fillConvexPoly(mask, polygon, cv::Scalar(255), cv::LINE_8, 4);
  }
  return mask;
}

}  // namespace simwright::asset_lift
