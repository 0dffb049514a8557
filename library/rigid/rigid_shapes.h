#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::library {

// The closed, outward-oriented surfaces from which rigid objects are made. Metres or any unit:
// FitOf sets the size.

// A cross-section of a loft: its outline scaled to x and y, at height z. `look` indexes the colour
// of the band between the previous ring and this one.
struct Ring {
  double x = 0.0, y = 0.0, z = 0.0;
  int look = 0;
};

// Returns an outline in [-1, 1]^2, counter-clockwise, touching each side of the square.
std::vector<Eigen::Vector2d> CircleOutline(int points = 48);  // a multiple of 4
// Returns a square whose corners are rounded by `corner` (of its half side, in (0, 1]).
std::vector<Eigen::Vector2d> RoundedSquareOutline(double corner, int points_a_corner = 5);

// Returns the surface through the rings. It starts and ends in a point (a ring of x = y = 0);
// otherwise the last ring joins the first. Seen from above, rings of increasing height are on the
// outside.
core::TexturedMesh Loft(const std::vector<Ring>& rings, const std::vector<Eigen::Vector2d>& outline,
                        const std::vector<core::Material>& looks);

// A point of a profile (r, z) about the z axis.
struct ProfilePoint {
  double r = 0.0, z = 0.0;
  int look = 0;
};
core::TexturedMesh Revolved(const std::vector<ProfilePoint>& profile,
                            const std::vector<core::Material>& looks);
// Returns a curve through the points, `steps` per segment (Catmull and Rom 1974); r is at least 0.
std::vector<ProfilePoint> Smooth(const std::vector<ProfilePoint>& points, int steps = 6);
// Returns a vessel's profile: the outer wall (from its base's edge to its rim), a wall whose
// `thickness` is measured horizontally, and the inside down to the floor, which is `floor` thick.
std::vector<ProfilePoint> VesselProfile(const std::vector<ProfilePoint>& outer, double thickness,
                                        double floor);

// Returns the mesh with its axis along x.
core::TexturedMesh AlongX(core::TexturedMesh mesh);
// Returns the mesh with its axis along y, towards -y.
core::TexturedMesh AlongY(core::TexturedMesh mesh);

// A bent sheet along x: each station has the half width `half_width`, its middle at z and its edges
// `dish` higher than its middle.
struct Station {
  double x = 0.0, half_width = 0.0, z = 0.0, dish = 0.0;
  int look = 0;
};
core::TexturedMesh Sheet(const std::vector<Station>& stations, double thickness,
                         const std::vector<core::Material>& looks);

// Returns a bar of elliptic section along a path in the plane y = 0, with flat ends.
core::TexturedMesh Tube(const std::vector<Eigen::Vector2d>& path_xz, double half_across,
                        double half_thick, const core::Material& look);

// A section of a tube with its own size at each point of the path.
struct TubeSection {
  double x = 0.0, z = 0.0, half_across = 0.0, half_thick = 0.0;
};
core::TexturedMesh TaperedTube(const std::vector<TubeSection>& path, const core::Material& look);

// A section of a bar along x with flat ends: the outline fills y_low to y_high and z_low to z_high.
struct BarSection {
  double x = 0.0, y_low = 0.0, y_high = 0.0, z_low = 0.0, z_high = 0.0;
  int look = 0;
};
core::TexturedMesh Bar(const std::vector<BarSection>& sections,
                       const std::vector<Eigen::Vector2d>& outline,
                       const std::vector<core::Material>& looks);

// Returns a box about the origin with chamfered edges; `look_of` maps a face's normal to a colour.
core::TexturedMesh PaintedBox(const Eigen::Vector3d& size, double bevel,
                              const std::vector<core::Material>& looks,
                              const std::function<int(const Eigen::Vector3d&)>& look_of);

// Adds `addition` as another closed surface of the same object; the two may intersect.
void Join(const core::TexturedMesh& addition, core::TexturedMesh* mesh);
void Move(const Eigen::Vector3d& by, core::TexturedMesh* mesh);

// Flattens the lowest `share` of the height, so that round objects have a flat base.
void Flatten(double share, core::TexturedMesh* mesh);

// Returns the transform that scales these bounds to this size, standing on z = 0 about the z axis.
Eigen::Affine3d FitOf(const Eigen::Vector3d& size, const Eigen::AlignedBox3d& bounds);

}  // namespace simwright::library
