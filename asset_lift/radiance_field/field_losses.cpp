#include "asset_lift/radiance_field/field_losses.h"

#include <algorithm>
#include <cmath>

namespace simwright::asset_lift {
namespace {

using Vector = Eigen::Map<const Eigen::Vector3f>;
using Target = Eigen::Map<Eigen::Vector3f>;

// Adds half the squared distance of the normals of rays a and b, weighted by their opacities as
// constants.
double AddSmoothness(const RayRenderings<float>& pictures, int a, int b, float scale,
                     RayRenderings<float>* gradient) {
  if (b < 0) return 0.0;
  const float weight = scale * pictures.opacity[a] * pictures.opacity[b];
  const Eigen::Vector3f difference =
      Vector(&pictures.normal[3 * a]) - Vector(&pictures.normal[3 * b]);
  if (weight == 0.0f || Vector(&pictures.normal[3 * a]).isZero(0.0f) ||
      Vector(&pictures.normal[3 * b]).isZero(0.0f)) {
    return 0.0;
  }
  Target(&gradient->normal[3 * a]) += 0.5f * weight * difference;
  Target(&gradient->normal[3 * b]) -= 0.5f * weight * difference;
  return 0.25 * weight * difference.squaredNorm();
}

}  // namespace

bool FieldLossWeights::IsValid(std::string* error) const {
  for (const double weight :
       {color, mask, depth, objective, orientation, sparsity, opaque, normal_smoothness}) {
    if (std::isfinite(weight) && weight >= 0.0) continue;
    if (error != nullptr) *error = "loss weights must be finite and not negative";
    return false;
  }
  return true;
}

double AddObservationLoss(const RayTargets& targets, const RayRenderings<float>& pictures,
                          const Eigen::Vector3f& background, double half_side,
                          const FieldLossWeights& weights, RayRenderings<float>* gradient) {
  const std::size_t count = targets.opacity.size();
  const auto of_color = static_cast<float>(weights.color / (3.0 * count));
  const auto of_mask = static_cast<float>(weights.mask / count);
  const auto of_depth = static_cast<float>(weights.depth / (count * half_side * half_side));
  double loss = 0.0;
  for (std::size_t r = 0; r < count; ++r) {
    const float surplus = pictures.opacity[r] - targets.opacity[r];
    float of_opacity = 2.0f * of_mask * surplus;
    loss += of_mask * surplus * surplus;
    for (int c = 0; c < 3; ++c) {
      const float error =
          pictures.color[3 * r + c] - targets.color[3 * r + c] - surplus * background[c];
      loss += of_color * error * error;
      gradient->color[3 * r + c] += 2.0f * of_color * error;
      of_opacity -= 2.0f * of_color * error * background[c];
    }
    if (targets.depth[r] > 0.0f && targets.opacity[r] > 0.5f) {
      const float error = pictures.depth[r] - pictures.opacity[r] * targets.depth[r];
      loss += of_depth * error * error;
      gradient->depth[r] += 2.0f * of_depth * error;
      of_opacity -= 2.0f * of_depth * error * targets.depth[r];
    }
    gradient->opacity[r] += of_opacity;
  }
  return loss;
}

double AddShapeLoss(const PixelRays& pixels, const RayRenderings<float>& pictures,
                    const FieldLossWeights& weights, RayRenderings<float>* gradient) {
  const std::size_t count = pixels.rays.size();
  const auto of_orientation = static_cast<float>(weights.orientation / count);
  const auto of_sparsity = static_cast<float>(weights.sparsity / count);
  const auto of_entropy = static_cast<float>(weights.opaque / count);
  const auto of_smoothness = static_cast<float>(weights.normal_smoothness / count);
  double loss = 0.0;
  for (std::size_t r = 0; r < count; ++r) {
    const float opacity = pictures.opacity[r];
    const float length = std::sqrt(opacity * opacity + 0.01f);
    loss += of_sparsity * length;
    gradient->opacity[r] += of_sparsity * opacity / length;
    const float share = std::clamp(opacity, 1e-3f, 1.0f - 1e-3f);
    const float rest = 1.0f - share;
    loss -= of_entropy * (share * std::log(share) + rest * std::log(rest));
    if (share == opacity) gradient->opacity[r] += of_entropy * std::log(rest / share);
    if (!weights.UseNormals() || opacity == 0.0f) continue;
    const Eigen::Vector3f along = pixels.rays[r].direction.normalized().cast<float>();
    const float away = Vector(&pictures.normal[3 * r]).dot(along);
    if (away > 0.0f) {
      loss += of_orientation * opacity * away * away;
      Target(&gradient->normal[3 * r]) += 2.0f * of_orientation * opacity * away * along;
    }
    const int a = static_cast<int>(r);
    loss += AddSmoothness(pictures, a, pixels.right[r], of_smoothness, gradient);
    loss += AddSmoothness(pictures, a, pixels.below[r], of_smoothness, gradient);
  }
  return loss;
}

}  // namespace simwright::asset_lift
