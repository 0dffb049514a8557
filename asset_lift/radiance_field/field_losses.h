#pragma once

#include <string>
#include <vector>

#include "asset_lift/radiance_field/field_fit_options.h"
#include "asset_lift/radiance_field/field_targets.h"
#include "asset_lift/radiance_field/volume_rendering.h"

namespace simwright::asset_lift {

// Returns the weighted sum of the squared errors of colour (both sides composited over
// `background`, sRGB, so that a half transparent object is not mistaken for a dark one), opacity
// and known depths (m; `half_side` in m). Adds the gradient to `gradient`, which has the images'
// size.
double AddObservationLoss(const RayTargets& targets, const RayRenderings<float>& pictures,
                          const Eigen::Vector3f& background, double half_side,
                          const FieldLossWeights& weights, RayRenderings<float>* gradient);

// Returns the weighted sum of the losses that regularize any image of an object, and adds its
// gradient to `gradient`:
//   orientation  normals face the eye: opacity * max(0, n . ray)^2 (Verbin et al., "Ref-NeRF",
//                2022), at the ray's median point
//   sparsity     sqrt(opacity^2 + 0.01)
//   opaque       the entropy of the opacity, which favours 0 and 1
//   smoothness   |n_a - n_b|^2 / 4 of neighbouring pixels, weighted by the product of their
//                opacities, which is taken as constant, as in the orientation loss
double AddShapeLoss(const PixelRays& pixels, const RayRenderings<float>& pictures,
                    const FieldLossWeights& weights, RayRenderings<float>* gradient);

}  // namespace simwright::asset_lift
