#include "asset_lift/radiance_field/field_targets.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace simwright::asset_lift {
namespace {

bool Finite(const core::FloatImage& image) {
  return std::all_of(image.values.begin(), image.values.end(),
                     [](float x) { return std::isfinite(x); });
}

bool Fits(const core::FloatImage& image, const core::Camera& camera, int channels) {
  return image.width == camera.width && image.height == camera.height &&
         image.channels == channels &&
         image.values.size() == static_cast<std::size_t>(image.width) * image.height * channels;
}

const char* FaultOf(const ObservedView& view) {
  const core::Camera& camera = view.camera;
  if (camera.width < 1 || camera.height < 1 || !(camera.fx > 0.0) || !(camera.fy > 0.0) ||
      !std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy) ||
      !camera.world_from_camera.matrix().allFinite()) {
    return "the camera has no pixels, no focal length, or is not finite";
  }
  if (!Fits(view.color, camera, 3) || !Fits(view.opacity, camera, 1) ||
      (!view.depth.empty() && !Fits(view.depth, camera, 1))) {
    return "colour, opacity, depth and camera have different sizes";
  }
  if (!Finite(view.color) || !Finite(view.opacity) || !Finite(view.depth)) {
    return "a pixel is not finite";
  }
  const auto seen = [](float x) { return x > 0.5f; };
  if (std::none_of(view.opacity.values.begin(), view.opacity.values.end(), seen)) {
    return "the mask is empty";
  }
  return nullptr;
}

// The shares of the source pixels [first, first + share.size()) that target pixel `i` covers.
struct Cover {
  int first;
  std::vector<double> share;
};

std::vector<Cover> Covers(int from, int to) {
  std::vector<Cover> covers(to);
  const double scale = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    const double low = i * scale, high = (i + 1) * scale;
    covers[i].first = static_cast<int>(low);
    const int last = std::min(from - 1, static_cast<int>(std::ceil(high)) - 1);
    for (int x = covers[i].first; x <= last; ++x) {
      covers[i].share.push_back(std::min(high, x + 1.0) - std::max(low, static_cast<double>(x)));
    }
  }
  return covers;
}

void AveragePixel(const ObservedView& view, const Cover& across, const Cover& down,
                  ObservedView* small, int x, int y) {
  double area = 0.0, opacity = 0.0, color[3] = {0, 0, 0}, depth = 0.0, known = 0.0;
  for (std::size_t j = 0; j < down.share.size(); ++j) {
    for (std::size_t i = 0; i < across.share.size(); ++i) {
      const int sx = across.first + static_cast<int>(i), sy = down.first + static_cast<int>(j);
      const double share = across.share[i] * down.share[j];
      const double alpha = share * *view.opacity.At(sx, sy);
      area += share;
      opacity += alpha;
      for (int c = 0; c < 3; ++c) color[c] += alpha * view.color.At(sx, sy)[c];
      if (view.depth.empty() || *view.depth.At(sx, sy) <= 0.0f) continue;
      depth += alpha * *view.depth.At(sx, sy);
      known += alpha;
    }
  }
  *small->opacity.At(x, y) = static_cast<float>(opacity / area);
  for (int c = 0; c < 3; ++c) {
    small->color.At(x, y)[c] = opacity > 0.0 ? static_cast<float>(color[c] / opacity) : 0.0f;
  }
  if (!view.depth.empty()) {
    *small->depth.At(x, y) = known > 0.0 ? static_cast<float>(depth / known) : 0.0f;
  }
}

}  // namespace

void PixelRays::Clear() {
  rays.clear();
  right.clear();
  below.clear();
  pixel.clear();
}

void PixelRays::AppendPatch(const core::Camera& camera, int x, int y, core::Rng* rng) {
  const int columns = std::min(kPatch, camera.width - x),
            rows = std::min(kPatch, camera.height - y);
  const Eigen::Vector3d eye = camera.position();
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double dx = rng != nullptr ? core::Uniform(*rng) : 0.5;
      const double dy = rng != nullptr ? core::Uniform(*rng) : 0.5;
      const int at = static_cast<int>(rays.size());
      rays.push_back({eye, camera.Ray({x + i + dx, y + j + dy})});
      right.push_back(i + 1 < columns ? at + 1 : -1);
      below.push_back(j + 1 < rows ? at + columns : -1);
      pixel.push_back((y + j) * camera.width + x + i);
    }
  }
}

void PixelRays::AppendImage(const core::Camera& camera) {
  for (int y = 0; y < camera.height; y += kPatch) {
    for (int x = 0; x < camera.width; x += kPatch) AppendPatch(camera, x, y, nullptr);
  }
}

void RequireValidViews(const std::vector<ObservedView>& views) {
  if (views.empty()) throw core::Error("a fit needs at least one view of the object");
  for (std::size_t v = 0; v < views.size(); ++v) {
    const char* fault = FaultOf(views[v]);
    if (fault != nullptr) throw core::Error(fault, "view " + std::to_string(v + 1));
  }
}

ObservedView ScaledView(const ObservedView& view, int longer_side) {
  const int side = std::max(view.camera.width, view.camera.height);
  if (side <= longer_side) return view;
  ObservedView small;
  small.camera = view.camera;
  const double scale = static_cast<double>(longer_side) / side;
  const auto scaled = [&](int n) { return std::max(1, static_cast<int>(std::lround(scale * n))); };
  small.camera.width = scaled(view.camera.width);
  small.camera.height = scaled(view.camera.height);
  const double sx = static_cast<double>(small.camera.width) / view.camera.width;
  const double sy = static_cast<double>(small.camera.height) / view.camera.height;
  small.camera.fx *= sx;
  small.camera.cx *= sx;
  small.camera.fy *= sy;
  small.camera.cy *= sy;
  small.color = core::FloatImage(small.camera.width, small.camera.height, 3);
  small.opacity = core::FloatImage(small.camera.width, small.camera.height, 1);
  if (!view.depth.empty()) {
    small.depth = core::FloatImage(small.camera.width, small.camera.height, 1);
  }
  const std::vector<Cover> across = Covers(view.camera.width, small.camera.width);
  const std::vector<Cover> down = Covers(view.camera.height, small.camera.height);
  for (int y = 0; y < small.camera.height; ++y) {
    for (int x = 0; x < small.camera.width; ++x) {
      AveragePixel(view, across[x], down[y], &small, x, y);
    }
  }
  return small;
}

PatchSampler::PatchSampler(std::vector<ObservedView> views, bool everything)
    : views_(std::move(views)) {
  constexpr int kPatch = PixelRays::kPatch;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const core::FloatImage& opacity = views_[v].opacity;
    for (int y = 0; y < opacity.height; y += kPatch) {
      for (int x = 0; x < opacity.width; x += kPatch) {
        bool near_object = everything;
        for (int j = std::max(0, y - kPatch); j < std::min(opacity.height, y + 2 * kPatch); ++j) {
          for (int i = std::max(0, x - kPatch); i < std::min(opacity.width, x + 2 * kPatch); ++i) {
            near_object = near_object || *opacity.At(i, j) > 0.01f;
          }
        }
        if (near_object) patches_.push_back({static_cast<int>(v), x, y});
      }
    }
  }
  next_ = patches_.size();
}

int PatchSampler::size() const {
  return static_cast<int>(patches_.size()) * PixelRays::kPatch * PixelRays::kPatch;
}

void PatchSampler::NextBatch(int rays, core::Rng* rng, RayTargets* batch) {
  batch->pixels.Clear();
  batch->color.clear();
  batch->opacity.clear();
  batch->depth.clear();
  const std::size_t wanted = std::max<std::size_t>(
      1, static_cast<std::size_t>(rays) / (PixelRays::kPatch * PixelRays::kPatch));
  for (std::size_t n = 0; n < std::min(wanted, patches_.size()); ++n) {
    if (next_ == patches_.size()) {
      // The patches of this batch are at the end already and are excluded from the shuffle.
      for (std::size_t i = patches_.size() - n; i > 1; --i) {
        std::swap(patches_[i - 1],
                  patches_[core::UniformIndex(*rng, static_cast<std::int64_t>(i))]);
      }
      next_ = 0;
    }
    Append(patches_[next_++], rng, batch);
  }
}

void PatchSampler::Append(const Patch& patch, core::Rng* rng, RayTargets* batch) const {
  const ObservedView& view = views_[patch.view];
  const std::size_t first = batch->pixels.rays.size();
  batch->pixels.AppendPatch(view.camera, patch.x, patch.y, rng);
  for (std::size_t r = first; r < batch->pixels.rays.size(); ++r) {
    const int pixel = batch->pixels.pixel[r];
    const float opacity = view.opacity.values[pixel];
    for (int c = 0; c < 3; ++c) batch->color.push_back(opacity * view.color.values[3 * pixel + c]);
    batch->opacity.push_back(opacity);
    batch->depth.push_back(view.depth.empty() ? 0.0f : view.depth.values[pixel]);
  }
}

}  // namespace simwright::asset_lift
