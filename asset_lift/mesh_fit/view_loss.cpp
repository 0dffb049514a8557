#include "asset_lift/mesh_fit/view_loss.h"

#include <algorithm>
#include <cmath>

namespace simwright::asset_lift {
namespace {

// The weights of the source pixels along one axis for a target pixel.
struct LossSpan {
  int first = 0, last = 0;
  double from = 0.0, to = 0.0;

  LossSpan(int at, double ratio, int size)
      : first(static_cast<int>(at * ratio)),
        last(std::min(size - 1, static_cast<int>(std::ceil((at + 1) * ratio)) - 1)),
        from(at * ratio),
        to(std::min<double>(size, (at + 1) * ratio)) {}
  double Weight(int i) const { return std::min(i + 1.0, to) - std::max<double>(i, from); }
};

// Calls add(x, y, weight) for the source pixels of a target pixel.
template <typename Add>
void OverPixel(const ObservedView& view, double ratio, int x, int y, const Add& add) {
  const LossSpan across(x, ratio, view.camera.width), down(y, ratio, view.camera.height);
  for (int j = down.first; j <= down.last; ++j) {
    for (int i = across.first; i <= across.last; ++i) add(i, j, across.Weight(i) * down.Weight(j));
  }
}

void FillPixel(const ObservedView& view, double ratio, int x, int y, ViewTarget* target) {
  double weight = 0.0, opacity = 0.0, depth = 0.0;
  bool known = true;
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  OverPixel(view, ratio, x, y, [&](int i, int j, double w) {
    const double share = *view.opacity.At(i, j);
    weight += w;
    opacity += w * share;
    if (!view.color.empty() && share > 0.0) {
      color += w * share * Eigen::Map<const Eigen::Vector3f>(view.color.At(i, j)).cast<double>();
    }
    if (!view.depth.empty()) {
      depth += w * *view.depth.At(i, j);
      known = known && *view.depth.At(i, j) > 0.0f;
    }
  });
  *target->opacity.At(x, y) = static_cast<float>(opacity / weight);
  if (!view.color.empty()) {
    Eigen::Map<Eigen::Vector3f>(target->color.At(x, y)) = (color / weight).cast<float>();
  }
  if (!view.depth.empty()) *target->depth.At(x, y) = known ? static_cast<float>(depth / weight) : 0;
}

}  // namespace

ViewTarget MakeTarget(const ObservedView& view, int max_side) {
  const double ratio = std::max(
      1.0, static_cast<double>(std::max(view.camera.width, view.camera.height)) / max_side);
  ViewTarget target;
  target.camera = view.camera;
  target.camera.width = static_cast<int>(std::ceil(view.camera.width / ratio - 1e-9));
  target.camera.height = static_cast<int>(std::ceil(view.camera.height / ratio - 1e-9));
  for (double* value :
       {&target.camera.fx, &target.camera.fy, &target.camera.cx, &target.camera.cy}) {
    *value /= ratio;
  }
  const int w = target.camera.width, h = target.camera.height;
  target.opacity = core::FloatImage(w, h, 1);
  if (!view.color.empty()) target.color = core::FloatImage(w, h, 3);
  if (!view.depth.empty()) target.depth = core::FloatImage(w, h, 1);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) FillPixel(view, ratio, x, y, &target);
  }
  for (const float share : target.opacity.values) target.area += share;
  return target;
}

double ViewLoss(const ViewTarget& target, const render::DifferentiableBuffers& picture,
                const ViewLossWeights& weights, render::DifferentiableBuffers* gradient) {
  const int w = target.camera.width, h = target.camera.height;
  const auto fit = [&](core::FloatImage* image, int channels, bool given) {
    const std::size_t size = given ? static_cast<std::size_t>(w) * h * channels : 0;
    image->width = w;
    image->height = h;
    image->channels = channels;
    image->values.assign(size, 0.0f);
  };
  const bool color = !target.color.empty() && weights.color > 0.0;
  const bool depth = !target.depth.empty() && weights.depth > 0.0;
  fit(&gradient->mask, 1, true);
  fit(&gradient->color, 3, color);
  fit(&gradient->depth, 1, depth);
  const double share = 1.0 / std::max(1.0, target.area);
  double loss = 0.0;
  const auto square = [&](double weight, float difference, float* slope) {
    loss += weight * difference * difference;
    *slope = static_cast<float>(2.0 * weight * difference);
  };
  const std::size_t pixels = static_cast<std::size_t>(w) * h;
  for (std::size_t i = 0; i < pixels; ++i) {
    square(weights.mask * share, picture.mask.values[i] - target.opacity.values[i],
           &gradient->mask.values[i]);
    for (std::size_t c = 3 * i; color && c < 3 * i + 3; ++c) {
      square(weights.color * share / 3.0, picture.color.values[c] - target.color.values[c],
             &gradient->color.values[c]);
    }
    if (depth && target.depth.values[i] > 0.0f && target.opacity.values[i] > 0.999f &&
        picture.mask.values[i] > 0.999f) {
      const double weight = weights.depth * share / (weights.length * weights.length);
      const double difference = picture.depth.values[i] - target.depth.values[i];
      const double most =
          weights.depth_tolerance > 0.0 ? weights.depth_tolerance : std::abs(difference);
      const double held = std::clamp(difference, -most, most);
      loss += weight * held * (2.0 * difference - held);
      gradient->depth.values[i] = static_cast<float>(2.0 * weight * held);
    }
  }
  return loss;
}

double MaskIou(const ViewTarget& target, const render::DifferentiableBuffers& picture) {
  double both = 0.0, either = 0.0;
  for (std::size_t i = 0; i < target.opacity.values.size(); ++i) {
    both += std::min(target.opacity.values[i], picture.mask.values[i]);
    either += std::max(target.opacity.values[i], picture.mask.values[i]);
  }
  return either > 0.0 ? both / either : 1.0;
}

double ColorError(const ViewTarget& target, const render::DifferentiableBuffers& picture) {
  double sum = 0.0;
  for (std::size_t i = 0; i < target.color.values.size(); ++i) {
    sum += std::abs(target.color.values[i] - picture.color.values[i]);
  }
  return sum / (3.0 * std::max(1.0, target.area));
}

}  // namespace simwright::asset_lift
