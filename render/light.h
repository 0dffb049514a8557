#pragma once

#include <Eigen/Core>

namespace simwright::render {

// A distant light in real spherical harmonics up to degree 2, linear RGB radiance.
struct SphericalHarmonicsLight {
  // (9 x 3): bands 0, 1 (y, z, x), 2 (xy, yz, 3z^2-1, xz, x^2-y^2); one row per coefficient.
  Eigen::Matrix<float, 9, 3> radiance = Eigen::Matrix<float, 9, 3>::Zero();

  // Returns the irradiance over pi at a surface with unit normal `n`, which multiplies a Lambertian
  // albedo. Linear RGB, never negative. Ramamoorthi and Hanrahan, "An efficient representation for
  // irradiance environment maps", 2001: the cosine lobe weighs the bands by pi, 2 pi/3, pi/4.
  Eigen::Vector3f Shade(const Eigen::Vector3f& n) const;

  // Returns uniform light from all directions: Shade() is `level` for each normal.
  static SphericalHarmonicsLight Uniform(float level);
  // Returns a studio light: a bright sky above, and a key light from the direction `key` (unit,
  // towards the light).
  static SphericalHarmonicsLight Studio(const Eigen::Vector3f& key);
};

// Return the contribution of each coefficient to Shade(n) before clamping at zero (9), and its
// Jacobian with respect to n (9 x 3), where n need not stay on the unit sphere.
Eigen::Matrix<float, 9, 1> IrradianceWeights(const Eigen::Vector3f& n);
Eigen::Matrix<float, 9, 3> IrradianceWeightsJacobian(const Eigen::Vector3f& n);

// Apply the sRGB transfer function (IEC 61966-2-1) component-wise; `linear` in [0, 1].
float LinearFromSrgb(float srgb);
float SrgbFromLinear(float linear);

}  // namespace simwright::render
