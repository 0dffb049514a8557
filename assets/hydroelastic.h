#pragma once

#include <string>

#include <Eigen/Core>

namespace simwright::assets {

// A body's contact properties in Drake, whose hydroelastic contact distributes a force over the
// patch in which two bodies overlap. Drake's fallback, point contact, has one point per pair of
// parts: a thin flat body spins and sinks on it.
struct HydroelasticContact {
  double modulus = 5e7;          // Pa, the pressure at full depth
  double resolution_hint = 0.1;  // m, the longest edge of primitives that Drake meshes
  double dissipation = 20.0;     // s/m, Hunt and Crossley's
  double friction = 0.5;         // of Coulomb, static and sliding
};

// Returns the properties of a body of `mass` (kg) whose largest part in `material`
// (docs/formats.md) measures `extents` (m). Soft materials get the order of their Young's modulus;
// all others 50 MPa, stiff enough that a lying spoon does not rotate as it sinks in, and soft
// enough that the rest depth of a domino is well above rounding. A heavy body is stiffer, up to 100
// MPa: a round one, which touches at a point, sinks in by at most 0.1 mm.
HydroelasticContact HydroelasticContactOf(const std::string& material, double mass,
                                          const Eigen::Vector3d& extents, double friction);

}  // namespace simwright::assets
