#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/occupancy_grid.h"
#include "asset_lift/radiance_field.h"

namespace simwright::asset_lift {

struct VolumeRenderOptions {
  int max_samples = 64;        // a ray; more than 64 are not kept
  double finest_step = 0.016;  // half sides: half a cell of the occupancy grid
  // A ray ends where less than this share of the light comes through: what lies behind a surface
  // costs nothing.
  double least_transmittance = 1e-3;
  // Normals are finite differences over this distance (half sides): about a cell of the finest
  // level that pictures of 128 pixels can train.
  double normal_step = 0.02;
  bool normals = false;

  bool IsValid(std::string* error) const;
};

// Points origin + t * direction, t > 0, in the world (m). With a direction of core::Camera::Ray,
// t is the depth along the optical axis.
struct FieldRay {
  Eigen::Vector3d origin, direction;
};

// What n rays saw, or the gradient of a loss with respect to it.
template <typename Real>
struct RayPictures {
  std::vector<Real> color;        // (n x 3), sum of w c: sRGB, premultiplied by opacity
  std::vector<Real> opacity;      // (n), sum of w
  std::vector<Real> depth;        // (n), sum of w t: premultiplied by opacity
  std::vector<Real> normal;       // (n x 3), world, unit, outward; 0 for rays of opacity below 0.1
  void Resize(std::size_t rays);  // all zero
};

// Gradients of a field's parameters, summed apart by each worker: no locks, and the same sums for
// the same number of threads.
template <typename Real>
struct FieldGradient {
  std::vector<std::vector<Real>> parts;
  // One part a thread, zero, where they do not fit the field yet.
  void Prepare(const BasicRadianceField<Real>& field);
};

// Draws a field along rays and takes losses on the pictures back to its parameters.
//
// Max 1995; Mildenhall et al., "NeRF", 2020: a ray is cut into strata, one random point in each;
// alpha_i = 1 - exp(-sigma_i delta), w_i = alpha_i prod_{j<i} (1 - alpha_j), and all that is seen
// is a sum with these weights. Strata in empty cells of the occupancy grid are left out.
// The normal is that of the density around the ray's median point (where half of its opacity is
// reached): minus the gradient of the density's logit-like raw value, whose direction is the
// density's own, by differences between the corners of a small tetrahedron.
// Gradients are exact derivatives of what was drawn, at the points where it was drawn.
template <typename Real>
class VolumeRenderer {
 public:
  // Throws core::Error for options that are not valid.
  explicit VolumeRenderer(const VolumeRenderOptions& options);
  ~VolumeRenderer();
  VolumeRenderer(const VolumeRenderer&) = delete;
  VolumeRenderer& operator=(const VolumeRenderer&) = delete;

  // Points within the strata are drawn from `seed`; the pictures do not depend on the threads.
  // Keeps what AddGradient needs. Throws core::Error for a ray that is not finite.
  void Render(const BasicRadianceField<Real>& field, const OccupancyGrid& occupancy,
              const std::vector<FieldRay>& rays, std::uint64_t seed, RayPictures<Real>* pictures);

  // Adds dL/d(parameters), given dL/d(pictures) of the last Render; `field` must not have changed.
  void AddGradient(const BasicRadianceField<Real>& field, const RayPictures<Real>& gradient,
                   FieldGradient<Real>* sum) const;

  // Points of the field that the last Render looked at.
  std::int64_t samples() const;

 private:
  struct Tiles;

  VolumeRenderOptions options_;
  std::unique_ptr<Tiles> tiles_;
};

extern template class VolumeRenderer<float>;
extern template class VolumeRenderer<double>;

}  // namespace simwright::asset_lift
