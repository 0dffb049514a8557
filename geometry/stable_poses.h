#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

// A stable pose of a rigid body on the plane z = 0.
struct StablePose {
  Eigen::Isometry3d resting_from_body =
      Eigen::Isometry3d::Identity();  // the smallest rotation; then the centre of mass is over the
                                      // origin and the face at z = 0
  Eigen::Vector3d face_normal =
      Eigen::Vector3d::Zero();  // of the supporting face, outward, body frame
  double probability = 0.0;     // share of initial orientations that end in this pose
  double margin = 0.0;          // m, from the projected centre of mass to the support polygon's
                                // edge
  double tipping_angle = 0.0;   // rad, smallest tilt that topples it over an edge
  double center_height = 0.0;   // m, of the centre of mass above the plane
  std::vector<Eigen::Vector3d> support;  // (K x 3) support polygon: the face's corners, body frame,
                                         // in order
};

// Returns the stable poses, most probable first (probabilities sum to 1). Faces of the convex hull
// within 0.5 degrees and 1e-4 of the diagonal of one plane count as one. A face is stable if the
// centre of mass projects inside it by more than 1e-6 of the diagonal. The share of an unstable
// face (its solid angle seen from the centre of mass: Goldberg et al., "Part pose statistics",
// 1999) goes to the face across the edge over which it tips, recursively. Throws core::Error for an
// invalid or flat mesh, or a centre of mass that is not inside the hull.
std::vector<StablePose> StablePoses(const core::TriangleMesh& solid,
                                    const Eigen::Vector3d& center_of_mass);

// Returns true if a body at rest with `down` (body frame, unit) pointing at the floor rolls: from
// face to face it rotates by more than 75 degrees while its centre of mass stays within 5 % of its
// rest height, which is the barrier of an edge 18 degrees away. A ball, a lying cylinder of 10 or
// more facets and a lying cone roll; a die, an icosahedron and a hexagonal pencil do not, nor does
// a bowl on its round side, which rocks. Throws like StablePoses.
bool Rolls(const core::TriangleMesh& solid, const Eigen::Vector3d& center_of_mass,
           const Eigen::Vector3d& down);

// Returns the smallest tilt (rad) that topples the body when `down` (body frame, unit) points at
// the floor; 0 or less if it is not stable there. The support polygon is the hull of all vertices
// within `slack` (m) of the lowest.
double TippingAngle(const core::TriangleMesh& solid, const Eigen::Vector3d& center_of_mass,
                    const Eigen::Vector3d& down, double slack);

}  // namespace simwright::geometry
