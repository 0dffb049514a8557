#pragma once

#include <string>

#include <Eigen/Core>

namespace simwright::assets {

// How a body touches others in Drake, whose hydroelastic contact spreads a force over the patch in
// which two bodies overlap. Point contact, which Drake falls back to, has one point for each pair
// of parts: a thin flat body spins and sinks on it.
struct HydroelasticContact {
  double modulus = 5e7;          // Pa, the pressure at full depth
  double resolution_hint = 0.1;  // m, the longest edge of what Drake meshes itself
  double dissipation = 20.0;     // s/m, Hunt and Crossley's
  double friction = 0.5;         // of Coulomb, static and sliding
};

// For a body of `mass` (kg) whose largest part in `material` (docs/formats.md) measures `extents`
// (m). Soft matter has the order of its Young's modulus; everything else 50 MPa, stiff enough that
// a lying spoon does not turn as it sinks in, and soft enough that the depth at which a domino rests
// is well above rounding. A heavy body is stiffer: round below, where it touches in a point, it
// sinks in by 0.1 mm at most (up to 100 MPa).
HydroelasticContact HydroelasticContactOf(const std::string& material, double mass,
                                          const Eigen::Vector3d& extents, double friction);

}  // namespace simwright::assets
