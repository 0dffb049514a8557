#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/radiance_field/field_fit_options.h"
#include "asset_lift/radiance_field/occupancy_grid.h"
#include "asset_lift/radiance_field/radiance_field.h"

namespace simwright::asset_lift {

// The points origin + t * direction, t > 0, in the world (m). With a direction of
// core::Camera::Ray, t is the depth along the optical axis.
struct FieldRay {
  Eigen::Vector3d origin, direction;
};

// The rendered values of n rays, or the gradient of a loss with respect to them.
template <typename Real>
struct RayRenderings {
  std::vector<Real> color;        // (n x 3), sum of w c: sRGB, premultiplied by opacity
  std::vector<Real> opacity;      // (n), sum of w
  std::vector<Real> depth;        // (n), sum of w t: premultiplied by opacity
  std::vector<Real> normal;       // (n x 3), world, unit, outward; 0 for rays of opacity below 0.1
  void Resize(std::size_t rays);  // all zero
};

// The gradients of a field's parameters, summed separately by each worker: no locks, and the same
// sums for the same number of threads.
template <typename Real>
struct FieldGradient {
  std::vector<std::vector<Real>> parts;
  // Allocates one zeroed part per thread, unless the parts already fit the field.
  void Prepare(const BasicRadianceField<Real>& field);
};

// Renders a field along rays and backpropagates losses on the rendered values to its parameters.
//
// Max 1995; Mildenhall et al., "NeRF", 2020: a ray is divided into strata with one random point in
// each; alpha_i = 1 - exp(-sigma_i delta), w_i = alpha_i prod_{j<i} (1 - alpha_j), and each
// rendered value is a sum with these weights. Strata in empty cells of the occupancy grid are
// skipped. The normal is that of the density around the ray's median point (where half of its
// opacity is reached): minus the gradient of the density's raw value before softplus, whose
// direction is the density's own, by differences between the corners of a small tetrahedron.
// Gradients are exact derivatives of the rendering at its sample points.
template <typename Real>
class VolumeRenderer {
 public:
  // Throws core::Error for invalid options.
  explicit VolumeRenderer(const VolumeRenderOptions& options);
  ~VolumeRenderer();
  VolumeRenderer(const VolumeRenderer&) = delete;
  VolumeRenderer& operator=(const VolumeRenderer&) = delete;

  // Renders `rays`. Points within the strata are sampled from `seed`; the result does not depend on
  // the threads. Keeps the state that AddGradient needs. Throws core::Error for a ray that is not
  // finite.
  void Render(const BasicRadianceField<Real>& field, const OccupancyGrid& occupancy,
              const std::vector<FieldRay>& rays, std::uint64_t seed, RayRenderings<Real>* pictures);

  // Adds dL/d(parameters), given dL/d(pictures) of the last Render; `field` must not have changed.
  void AddGradient(const BasicRadianceField<Real>& field, const RayRenderings<Real>& gradient,
                   FieldGradient<Real>* sum) const;

  // Returns the number of field evaluations of the last Render.
  std::int64_t samples() const;

 private:
  struct Tiles;

  VolumeRenderOptions options_;
  std::unique_ptr<Tiles> tiles_;
};

extern template class VolumeRenderer<float>;
extern template class VolumeRenderer<double>;

}  // namespace simwright::asset_lift
