#include "capture/patch_match.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace simwright::capture {
namespace {

constexpr float kNoMatch = 1.3f;       // cost in a neighbour that does not show the window
constexpr float kLeastFacing = 0.15f;  // cosine between a plane's normal and the view
constexpr float kSourceShare = 0.4f;   // of the least deviation, in a neighbour's window
constexpr float kLeastUsed = 0.7f;     // share of a window inside the mask
constexpr int kFirstBehind = 3;        // first hypotheses behind the hull, with its normal ...
constexpr int kFirstLevel = 3;         // ... and with a vertical one

Eigen::Matrix3d IntrinsicsOf(const core::Camera& camera) {
  Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
  k(0, 0) = camera.fx;
  k(1, 1) = camera.fy;
  k(0, 2) = camera.cx;
  k(1, 2) = camera.cy;
  return k;
}

// Returns the sums over a square window around each pixel.
std::vector<float> WindowSums(const std::vector<float>& values, int width, int height, int radius) {
  std::vector<double> total(static_cast<std::size_t>(width + 1) * (height + 1), 0.0);
  const auto at = [&](int x, int y) -> double& {
    return total[static_cast<std::size_t>(y) * (width + 1) + x];
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      at(x + 1, y + 1) =
          at(x, y + 1) + at(x + 1, y) - at(x, y) + values[static_cast<std::size_t>(y) * width + x];
    }
  }
  std::vector<float> sums(values.size());
  for (int y = 0; y < height; ++y) {
    const int top = std::max(0, y - radius), bottom = std::min(height, y + radius + 1);
    for (int x = 0; x < width; ++x) {
      const int left = std::max(0, x - radius), right = std::min(width, x + radius + 1);
      sums[static_cast<std::size_t>(y) * width + x] =
          static_cast<float>(at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top));
    }
  }
  return sums;
}

}  // namespace

MatchView::MatchView(const asset_lift::ObservedView& view, int blur_radius)
    : width_(view.camera.width),
      height_(view.camera.height),
      camera_(view.camera),
      inverse_intrinsics_(IntrinsicsOf(view.camera).inverse()) {
  const std::size_t pixels = static_cast<std::size_t>(width_) * height_;
  std::vector<float> grey(pixels, 0.0f), inside(pixels, 0.0f);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (view.color.values.empty() || view.opacity.values[i] < 0.95f) continue;
    const float* rgb = &view.color.values[3 * i];
    grey[i] = 255.0f * (0.3f * rgb[0] + 0.59f * rgb[1] + 0.11f * rgb[2]);
    inside[i] = 1.0f;
  }
  const std::vector<float> sums = WindowSums(grey, width_, height_, blur_radius);
  const std::vector<float> counts = WindowSums(inside, width_, height_, blur_radius);
  values_.assign(pixels, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < pixels; ++i) {
    if (inside[i] > 0.0f) values_[i] = grey[i] - sums[i] / counts[i];
  }
}

PatchMatch::PatchMatch(const MatchView& view, const std::vector<const MatchView*>& neighbors,
                       const std::vector<HullInterval>& hull, const Eigen::Vector3f& up,
                       double diagonal, const PatchMatchOptions& options)
    : view_(view),
      hull_(hull),
      up_(up),
      diagonal_(static_cast<float>(diagonal)),
      options_(options),
      inverse_(view.inverse_intrinsics().cast<float>()),
      inverse_transposed_(inverse_.transpose()),
      costs_(neighbors.size()) {
  for (const MatchView* neighbor : neighbors) {
    const Eigen::Isometry3d pose =
        neighbor->camera().world_from_camera.inverse() * view.camera().world_from_camera;
    const Eigen::Matrix3d intrinsics = IntrinsicsOf(neighbor->camera());
    warps_.push_back({neighbor,
                      (intrinsics * pose.linear() * view.inverse_intrinsics()).cast<float>(),
                      (intrinsics * pose.translation()).cast<float>()});
  }
  const int side = 2 * (options.radius / options.stride) + 1;
  window_.resize(static_cast<std::size_t>(side) * side);
  counts_.resize(window_.size());
}

Eigen::Vector3f PatchMatch::RayAt(int x, int y) const {
  return inverse_ * Eigen::Vector3f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 1);
}

bool PatchMatch::TakeWindow(int x, int y) {
  if (std::isnan(view_.At(x, y))) return false;
  const int reach = options_.radius / options_.stride * options_.stride;
  std::size_t i = 0;
  float sum = 0.0f, squares = 0.0f;
  used_ = 0;
  for (int dy = -reach; dy <= reach; dy += options_.stride) {
    for (int dx = -reach; dx <= reach; dx += options_.stride, ++i) {
      const int u = x + dx, v = y + dy;
      counts_[i] = 0;
      window_[i] = 0.0f;
      if (u < 0 || v < 0 || u >= view_.width() || v >= view_.height()) continue;
      const float value = view_.At(u, v);
      if (std::isnan(value)) continue;
      counts_[i] = 1;
      window_[i] = value;
      sum += value;
      squares += value * value;
      ++used_;
    }
  }
  const auto used = static_cast<float>(used_);
  if (used < kLeastUsed * static_cast<float>(window_.size())) return false;
  const float mean = sum / used, spread = squares - sum * mean;
  if (spread < options_.least_deviation * options_.least_deviation * used) return false;
  const float by = 1.0f / std::sqrt(spread);
  for (std::size_t k = 0; k < window_.size(); ++k) {
    if (counts_[k] != 0) window_[k] = (window_[k] - mean) * by;
  }
  return true;
}

bool PatchMatch::VariesAllAround(int x, int y) const {
  const int reach = options_.radius;
  float xx = 0.0f, xy = 0.0f, yy = 0.0f;
  int count = 0;
  for (int v = std::max(1, y - reach); v <= std::min(view_.height() - 2, y + reach); ++v) {
    for (int u = std::max(1, x - reach); u <= std::min(view_.width() - 2, x + reach); ++u) {
      const float across = 0.5f * (view_.At(u + 1, v) - view_.At(u - 1, v));
      const float down = 0.5f * (view_.At(u, v + 1) - view_.At(u, v - 1));
      if (std::isnan(across) || std::isnan(down)) continue;
      xx += across * across;
      xy += across * down;
      yy += down * down;
      ++count;
    }
  }
  const float spread = std::sqrt((xx - yy) * (xx - yy) + 4.0f * xy * xy);
  const float least = 0.5f * (xx + yy - spread), most = 0.5f * (xx + yy + spread);
  return least > options_.least_gradient * static_cast<float>(count) &&
         least > options_.least_roundness * most;
}

float PatchMatch::CostIn(const Warp& warp, const Eigen::Vector3f& start,
                         const Eigen::Vector3f& across, const Eigen::Vector3f& down) const {
  const MatchView& other = *warp.view;
  const int cells = options_.radius / options_.stride;
  const int side = 2 * cells + 1;
  const auto right = static_cast<float>(other.width() - 1),
             bottom = static_cast<float>(other.height() - 1);
  float sum = 0.0f, squares = 0.0f, product = 0.0f;
  std::size_t i = 0;
  for (int row = 0; row < side; ++row) {
    const auto rows = static_cast<float>(row - cells);
    Eigen::Vector3f at = start + rows * down - static_cast<float>(cells) * across;
    for (int column = 0; column < side; ++column, ++i, at += across) {
      if (counts_[i] == 0) continue;
      const float by = 1.0f / at.z();
      const float u = at.x() * by - 0.5f, v = at.y() * by - 0.5f;
      if (!(at.z() > 0.0f && u >= 0.0f && v >= 0.0f && u < right && v < bottom)) return kNoMatch;
      const int x = static_cast<int>(u), y = static_cast<int>(v);
      const float fx = u - static_cast<float>(x), fy = v - static_cast<float>(y);
      const float* top = other.Row(y) + x;
      const float* low = top + other.width();
      const float upper = top[0] + fx * (top[1] - top[0]), lower = low[0] + fx * (low[1] - low[0]);
      const float value = upper + fy * (lower - upper);
      sum += value;
      squares += value * value;
      product += value * window_[i];
    }
  }
  const auto used = static_cast<float>(used_);
  const float spread = squares - sum * sum / used;
  const float least = kSourceShare * options_.least_deviation;
  // Not a number where the window leaves the mask.
  if (!(spread > least * least * used)) return kNoMatch;
  return std::min(kNoMatch, 1.0f - product / std::sqrt(spread));
}

float PatchMatch::CostAt(int x, int y, float depth, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f pixel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 1.0f);
  const float offset = depth * normal.dot(inverse_ * pixel);
  const Eigen::Vector3f plane = inverse_transposed_ * normal / offset;
  const float along = plane.dot(pixel);
  const auto stride = static_cast<float>(options_.stride);
  for (std::size_t i = 0; i < warps_.size(); ++i) {
    const Warp& warp = warps_[i];
    costs_[i] = CostIn(warp, warp.turn * pixel + along * warp.shift,
                       stride * (warp.turn.col(0) + plane.x() * warp.shift),
                       stride * (warp.turn.col(1) + plane.y() * warp.shift));
  }
  const int count = std::min<int>(options_.best_views, static_cast<int>(costs_.size()));
  std::partial_sort(costs_.begin(), costs_.begin() + count, costs_.end());
  float sum = 0.0f;
  for (int i = 0; i < count; ++i) sum += costs_[static_cast<std::size_t>(i)];
  return count > 0 ? sum / static_cast<float>(count) : kNoMatch;
}

void PatchMatch::Try(int x, int y, float depth, const Eigen::Vector3f& normal, PatchPlane* best) {
  const HullInterval& hull = hull_[Index(x, y)];
  const float slack = options_.slack * diagonal_;
  if (!(depth > hull.enter - slack && depth < hull.leave + slack)) return;
  const Eigen::Vector3f ray = RayAt(x, y);
  if (!(normal.dot(ray) < -kLeastFacing * ray.norm())) return;
  const float cost = CostAt(x, y, depth, normal);
  if (cost < best->cost) *best = {depth, normal, cost};
}

// Tries a neighbour's plane where the pixel's ray meets it.
void PatchMatch::TryNeighbor(int x, int y, int from_x, int from_y, PatchPlane* best) {
  if (from_x < 0 || from_y < 0 || from_x >= view_.width() || from_y >= view_.height()) return;
  const PatchPlane& from = planes_[Index(from_x, from_y)];
  if (!(from.depth > 0.0f)) return;
  const float offset = from.depth * from.normal.dot(RayAt(from_x, from_y));
  Try(x, y, offset / from.normal.dot(RayAt(x, y)), from.normal, best);
}

void PatchMatch::Start(int x, int y, core::Rng* rng) {
  const HullInterval& hull = hull_[Index(x, y)];
  PatchPlane best;
  best.depth = 0.0f;
  if (hull.enter > 0.0f && TakeWindow(x, y) && VariesAllAround(x, y)) {
    const float reach = hull.leave - hull.enter;
    Try(x, y, hull.enter, hull.normal, &best);
    for (int i = 0; i < kFirstBehind; ++i) {
      const auto share = static_cast<float>(core::Uniform(*rng));
      Try(x, y, hull.enter + reach * share * share, hull.normal, &best);
    }
    for (int i = 0; i < kFirstLevel; ++i) {
      Try(x, y, hull.enter + reach * static_cast<float>(core::Uniform(*rng)), up_, &best);
    }
    if (best.depth == 0.0f) best = {hull.enter, hull.normal, kNoMatch};
  }
  planes_[Index(x, y)] = best;
}

void PatchMatch::Refine(int x, int y, core::Rng* rng, PatchPlane* best) {
  for (int i = 0; i < 3; ++i) {
    const auto scale = static_cast<float>(std::pow(10.0, core::Uniform(*rng, -2.2, 0.0)));
    float depth = best->depth;
    Eigen::Vector3f normal = best->normal;
    if (i != 1) {
      depth += 0.06f * scale * diagonal_ * static_cast<float>(core::Uniform(*rng, -1.0, 1.0));
    }
    if (i != 0) normal = (normal + scale * core::UniformDirection(*rng).cast<float>()).normalized();
    Try(x, y, depth, normal, best);
  }
}

void PatchMatch::Sweep(bool forward, core::Rng* rng) {
  const int step = forward ? 1 : -1;
  for (int row = 0; row < view_.height(); ++row) {
    const int y = forward ? row : view_.height() - 1 - row;
    for (int column = 0; column < view_.width(); ++column) {
      const int x = forward ? column : view_.width() - 1 - column;
      PatchPlane best = planes_[Index(x, y)];
      if (!(best.depth > 0.0f)) continue;
      TakeWindow(x, y);
      TryNeighbor(x, y, x - step, y, &best);
      TryNeighbor(x, y, x, y - step, &best);
      TryNeighbor(x, y, x + 5 * step, y, &best);
      TryNeighbor(x, y, x, y + 5 * step, &best);
      Refine(x, y, rng, &best);
      planes_[Index(x, y)] = best;
    }
  }
}

bool PatchMatch::IsDistinct(int x, int y) {
  const PatchPlane& plane = planes_[Index(x, y)];
  if (!(plane.depth > 0.0f && plane.cost < options_.most_cost)) return false;
  TakeWindow(x, y);
  const float shift = options_.distinct_shift * diagonal_;
  const float least = plane.cost + options_.distinct_cost;
  return CostAt(x, y, plane.depth - shift, plane.normal) > least &&
         CostAt(x, y, plane.depth + shift, plane.normal) > least;
}

std::vector<PatchPlane> PatchMatch::Run(core::Rng* rng) {
  planes_.assign(hull_.size(), {});
  for (int y = 0; y < view_.height(); ++y) {
    for (int x = 0; x < view_.width(); ++x) Start(x, y, rng);
  }
  for (int sweep = 0; sweep < options_.sweeps; ++sweep) Sweep(sweep % 2 == 0, rng);
  for (int y = 0; y < view_.height(); ++y) {
    for (int x = 0; x < view_.width(); ++x) {
      if (!IsDistinct(x, y)) planes_[Index(x, y)].depth = 0.0f;
    }
  }
  return planes_;
}

}  // namespace simwright::capture
