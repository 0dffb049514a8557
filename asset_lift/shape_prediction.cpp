// Evaluates a shape prior's prediction at points, along rays and as a surface.
#include <algorithm>
#include <cmath>

#include "asset_lift/priors/shape_example.h"
#include "asset_lift/priors/shape_prior.h"
#include "core/error.h"
#include "core/parallel.h"
#include "geometry/isosurface.h"

namespace simwright::asset_lift {
namespace {

constexpr float kOutside = -8.0f;
constexpr size_t kPredictionPixels = static_cast<size_t>(kCropSide) * kCropSide;
// Log odds per unit of alpha: the silhouette is as sharp as a crop's pixel, and its half level
// coincides with the surface's.
constexpr float kOutlineSharpness = 10.0f;

// The interpolation position between cell centres: cells `low` and `low` + 1, and the share of the
// upper.
struct Between {
  int low, high;
  float share;
};

Between Cells(double at, int count) {
  const double c = std::clamp(at, 0.0, count - 1.0);
  const int low = std::min(static_cast<int>(c), count - 2);
  return {low, low + 1, static_cast<float>(c - low)};
}

float Mix(float a, float b, float share) {
  return a + share * (b - a);
}

// Returns the image's value at (u, v), bilinear. `Value(pixel index)` returns a number or a vector
// of a declared type: Eigen's lazy sums would refer to expired temporaries.
template <typename Value>
auto OverPicture(double u, double v, const Value& value) {
  using Result = decltype(value(size_t{0}));
  const Between x = Cells((u + 1.0) * 0.5 * kCropSide - 0.5, kCropSide);
  const Between y = Cells((v + 1.0) * 0.5 * kCropSide - 0.5, kCropSide);
  const auto at = [&](int column, int row) -> Result {
    return value(static_cast<size_t>(row) * kCropSide + static_cast<size_t>(column));
  };
  const Result top = (1.0f - x.share) * at(x.low, y.low) + x.share * at(x.high, y.low);
  const Result low = (1.0f - x.share) * at(x.low, y.high) + x.share * at(x.high, y.high);
  return Result((1.0f - y.share) * top + y.share * low);
}

bool InBlock(const Eigen::Vector3d& uvw) {
  return std::abs(uvw.x()) <= 1.0 && std::abs(uvw.y()) <= 1.0 && std::abs(uvw.z()) <= kDepthReach;
}

float LogitAt(const ShapePrediction& prediction, const Eigen::Vector3d& uvw) {
  if (!InBlock(uvw)) return kOutside;
  const Between w = Cells((uvw.z() / kDepthReach + 1.0) * 0.5 * kDepthCells - 0.5, kDepthCells);
  const float* near = &prediction.logits[static_cast<size_t>(w.low) * kPredictionPixels];
  const float* far = near + kPredictionPixels;
  const float logit = OverPicture(
      uvw.x(), uvw.y(), [&](size_t pixel) { return Mix(near[pixel], far[pixel], w.share); });
  const float alpha = OverPicture(uvw.x(), uvw.y(), [&](size_t pixel) {
    return static_cast<float>(prediction.crop.pixels[4 * pixel + 3]) / 255.0f;
  });
  return std::min(logit, kOutlineSharpness * (alpha - 0.5f));
}

Eigen::Vector3f ColorAt(const ShapePrediction& prediction, const Eigen::Vector3d& uvw) {
  const double u = std::clamp(uvw.x(), -1.0, 1.0), v = std::clamp(uvw.y(), -1.0, 1.0);
  // Weighted by alpha: pixels outside the silhouette have no colour.
  const Eigen::Vector4f front = OverPicture(u, v, [&](size_t pixel) -> Eigen::Vector4f {
    const std::uint8_t* p = &prediction.crop.pixels[4 * pixel];
    const float alpha = static_cast<float>(p[3]) / 255.0f + 1e-4f;
    return Eigen::Vector4f(p[0], p[1], p[2], 255.0f) * (alpha / 255.0f);
  });
  const Eigen::Vector3f seen = front.head<3>() / front[3];
  const Eigen::Vector3f hidden = OverPicture(u, v, [&](size_t pixel) -> Eigen::Vector3f {
    const std::uint8_t* p = &prediction.back.pixels[3 * pixel];
    return Eigen::Vector3f(p[0], p[1], p[2]) / 255.0f;
  });
  const float first = OverPicture(u, v, [&](size_t p) { return prediction.front_w[p]; });
  const float last = OverPicture(u, v, [&](size_t p) { return prediction.back_w[p]; });
  const float through = (static_cast<float>(uvw.z()) - first) / std::max(last - first, 1e-3f);
  const float share = std::clamp((through - 0.35f) / 0.3f, 0.0f, 1.0f);
  return seen + share * (hidden - seen);
}

struct PredictionSpan {
  double near = 0.0, far = -1.0;
};

// Returns the intersection of a ray with an AABB.
PredictionSpan Crossing(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
                        const Eigen::Vector3d& ray) {
  PredictionSpan span{0.0, 1e30};
  for (int k = 0; k < 3; ++k) {
    const double inverse = 1.0 / (std::abs(ray[k]) > 1e-12 ? ray[k] : 1e-12);
    const double a = (box.min()[k] - origin[k]) * inverse, b = (box.max()[k] - origin[k]) * inverse;
    span.near = std::max(span.near, std::min(a, b));
    span.far = std::min(span.far, std::max(a, b));
  }
  return span;
}

}  // namespace

float ShapePrediction::Logit(const Eigen::Vector3d& point) const {
  return LogitAt(*this, frame.Locate(point));
}

Eigen::Vector3f ShapePrediction::Color(const Eigen::Vector3d& point) const {
  return ColorAt(*this, frame.Locate(point));
}

Eigen::AlignedBox3d FilledBox(const ShapePrediction& prediction) {
  Eigen::AlignedBox3d box;
  const double step = 2.0 / kCropSide, deep = 2.0 * kDepthReach / kDepthCells;
  for (size_t i = 0; i < prediction.logits.size(); ++i) {
    if (prediction.logits[i] <= 0.0f) continue;
    const size_t pixel = i % kPredictionPixels;
    const Eigen::Vector3d middle(
        step * (static_cast<double>(pixel % kCropSide) + 0.5) - 1.0,
        step * (static_cast<double>(pixel / kCropSide) + 0.5) - 1.0,
        deep * (static_cast<double>(i / kPredictionPixels) + 0.5) - kDepthReach);
    for (int corner = 0; corner < 8; ++corner) {
      box.extend(prediction.frame.PointAt(middle + Eigen::Vector3d((corner & 1 ? 1 : -1) * step,
                                                                   (corner & 2 ? 1 : -1) * step,
                                                                   (corner & 4 ? 1 : -1) * deep)));
    }
  }
  return box;
}

RenderedPrediction RenderPrediction(const ShapePrediction& prediction, const core::Camera& camera,
                                    int samples) {
  RenderedPrediction rendered;
  rendered.picture.color = core::FloatImage(camera.width, camera.height, 3);
  rendered.picture.opacity = core::FloatImage(camera.width, camera.height, 1);
  rendered.depth = core::FloatImage(camera.width, camera.height, 1);
  const Eigen::AlignedBox3d box = prediction.box;
  if (box.isEmpty() || samples < 1) return rendered;
  // A cell of even odds transmits half the light; other step lengths follow Beer-Lambert.
  const double cell = 2.0 * kDepthReach / kDepthCells * prediction.frame.Radius();
  core::ParallelFor(camera.height, [&](int y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d ray = camera.Ray({x + 0.5, y + 0.5});
      const PredictionSpan span = Crossing(box, camera.position(), ray);
      if (span.far <= span.near) continue;
      const double step = (span.far - span.near) / samples;
      const auto cells = static_cast<float>(step * ray.norm() / cell);
      float through = 1.0f, depth = 0.0f;
      Eigen::Vector3f color = Eigen::Vector3f::Zero();
      for (int s = 0; s < samples && through > 0.01f; ++s) {
        const double t = span.near + (s + 0.5) * step;
        const Eigen::Vector3d uvw = prediction.frame.Locate(camera.position() + t * ray);
        const float logit = LogitAt(prediction, uvw);
        if (logit < -1.5f) continue;
        // 1 - (1 - p)^cells with 1 - p = 1 / (1 + e^logit), sharpened: walls are opaque, and a ray
        // passes through cells that are less likely filled than not.
        const float opacity = 1.0f - std::pow(1.0f + std::exp(4.0f * logit), -cells);
        color += through * opacity * ColorAt(prediction, uvw);
        depth += through * opacity * static_cast<float>(t);
        through *= 1.0f - opacity;
      }
      for (int c = 0; c < 3; ++c) rendered.picture.color.At(x, y)[c] = color[c];
      rendered.picture.opacity.At(x, y)[0] = 1.0f - through;
      rendered.depth.At(x, y)[0] = depth;
    }
  });
  return rendered;
}

core::TriangleMesh PredictedSurface(const ShapePrediction& prediction, int resolution) {
  const Eigen::AlignedBox3d box = prediction.box;
  if (box.isEmpty()) throw core::Error("the shape prior sees nothing in the picture");
  if (resolution < 8) throw core::Error("a surface needs at least 8 cells");
  geometry::ScalarGrid grid;
  grid.cell = box.sizes().maxCoeff() / resolution;
  grid.origin = box.min() - Eigen::Vector3d::Constant(grid.cell);
  grid.nx = static_cast<int>(box.sizes().x() / grid.cell) + 4;
  grid.ny = static_cast<int>(box.sizes().y() / grid.cell) + 4;
  grid.nz = static_cast<int>(box.sizes().z() / grid.cell) + 4;
  grid.values.resize(static_cast<size_t>(grid.nx) * grid.ny * grid.nz);
  core::ParallelFor(grid.nz, [&](int k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        grid.values[grid.Index(i, j, k)] =
            -prediction.Logit(grid.origin + grid.cell * Eigen::Vector3d(i, j, k));
      }
    }
  });
  core::TriangleMesh surface = geometry::ExtractIsosurface(grid, 0.0f);
  if (surface.empty()) throw core::Error("the shape prior sees nothing in the picture");
  return surface;
}

}  // namespace simwright::asset_lift
