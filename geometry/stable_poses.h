#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

// One way in which a rigid body can lie on the plane z = 0.
struct StablePose {
  Eigen::Isometry3d resting_from_body =
      Eigen::Isometry3d::Identity();  // smallest turn; then the
                                      // centre of mass is over the origin and the face at z = 0
  Eigen::Vector3d face_normal =
      Eigen::Vector3d::Zero();  // of the face lain on, outward, body frame
  double probability = 0.0;     // share of all directions in which the body may come down
  double margin = 0.0;          // m, from the projected centre of mass to the support's edge
  double tipping_angle = 0.0;   // rad, the least tilt that makes it topple over an edge
  double center_height = 0.0;   // m, of the centre of mass above the plane
  std::vector<Eigen::Vector3d> support;  // (K x 3) corners of the face, body frame, in order
};

// The stable poses, most probable first (probabilities sum to 1). Faces of the convex hull within
// 0.5 degrees and 1e-4 of the diagonal of one plane count as one. A face is stable when the centre
// of mass projects inside it by more than 1e-6 of the diagonal; the share of any other one (the
// solid angle that it takes up seen from the centre of mass: Goldberg et al., "Part pose
// statistics", 1999) goes to the face across the edge over which it tips, and so on.
// Throws core::Error for an invalid or flat mesh, or a centre of mass that is not inside the hull.
std::vector<StablePose> StablePoses(const core::TriangleMesh& solid,
                                    const Eigen::Vector3d& center_of_mass);

// Whether a body that rests with `down` (body frame, unit) pointing at the floor rolls there: from
// face to face it turns by more than 75 degrees while its centre of mass stays within 5 % of the
// height that it rests at, which is the barrier of an edge 18 degrees away. A ball, a lying
// cylinder of 10 or more facets and a lying cone do; a die, an icosahedron and a hexagonal pencil
// do not, nor does a bowl on its round side, which rocks. Throws as StablePoses.
bool Rolls(const core::TriangleMesh& solid, const Eigen::Vector3d& center_of_mass,
           const Eigen::Vector3d& down);

// How stable the body is resting with direction `down` (body frame, unit) pointing at the floor:
// the least tilt (rad) that topples it, 0 or less when it does not stand that way. The support
// is the hull of all vertices within `slack` (m) of the lowest.
double TippingAngle(const core::TriangleMesh& solid, const Eigen::Vector3d& center_of_mass,
                    const Eigen::Vector3d& down, double slack);

}  // namespace simwright::geometry
