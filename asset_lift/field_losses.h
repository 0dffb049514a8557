#pragma once

#include <string>
#include <vector>

#include "asset_lift/field_targets.h"
#include "asset_lift/volume_rendering.h"

namespace simwright::asset_lift {

// Weights of a field's losses; each is a mean over the rays of a picture. Those of threestudio's
// Zero-1-to-3 (`depth` is ours: squared distances are counted in half sides of the cube).
struct FieldLossWeights {
  double color = 500.0;
  double mask = 50.0;
  double depth = 50.0;
  double objective = 0.1;  // the picture objective's own loss, as it comes
  double orientation = 1.0;
  double sparsity = 0.1;
  double opaque = 0.1;
  // Published: 8, with pictures of more pixels. Here 8 wears thin parts away: a chair from 8 views
  // reaches a volume IoU of 0.54 with it, 0.65 with 1; from one view there is no difference.
  double normal_smoothness = 1.0;

  bool IsValid(std::string* error) const;  // finite and not negative
  bool UseNormals() const { return orientation > 0.0 || normal_smoothness > 0.0; }
};

// The squared errors of colour (both sides laid over `background`, sRGB, so that what is half
// transparent cannot pass for dark), opacity and known depths (m; `half_side` in m). Returns the
// weighted sum; the gradient is added to `gradient`, which has the pictures' size.
double AddObservationLoss(const RayTargets& targets, const RayPictures<float>& pictures,
                          const Eigen::Vector3f& background, double half_side,
                          const FieldLossWeights& weights, RayPictures<float>* gradient);

// What any picture of an object should be like, weighted, its gradient added to `gradient`:
//   orientation  normals face the eye: opacity * max(0, n . ray)^2 (Verbin et al., "Ref-NeRF",
//                2022), at the ray's median point
//   sparsity     sqrt(opacity^2 + 0.01)
//   opaque       the entropy of the opacity: either there or not
//   smoothness   |n_a - n_b|^2 / 4 of neighbouring pixels, by the product of their opacities (taken
//   as constants, as in the first)
double AddShapeLoss(const PixelRays& pixels, const RayPictures<float>& pictures,
                    const FieldLossWeights& weights, RayPictures<float>* gradient);

}  // namespace simwright::asset_lift
