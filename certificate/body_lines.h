#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "certificate/placed_scene.h"
#include "core/random.h"
#include "manipulation/convex_part.h"

namespace simwright::certificate {

// The part of a line inside a body, with the outward normals at both ends. Body frame.
struct Chord {
  double enter = 0.0, leave = 0.0;  // m along the line
  Eigen::Vector3d enter_normal = Eigen::Vector3d::UnitZ(), leave_normal = Eigen::Vector3d::UnitZ();
};

// A point on a surface, with its outward normal.
struct SurfaceSample {
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitZ();
};

// Intersects lines with a body, the union of its convex parts.
class BodyLines {
 public:
  explicit BodyLines(const BodyModel& body);

  // Returns the chord of the line origin + t * direction (unit) that contains t = 0, or, if there
  // is none, the nearest one. Parts that overlap along the line make one chord.
  std::optional<Chord> ChordAt(const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction) const;
  // Samples a point on the body's surface by area; none if it lies inside of another part.
  std::optional<SurfaceSample> SampleSurface(core::Rng& rng) const;

 private:
  const BodyModel& body_;
  std::vector<manipulation::ConvexPart> parts_;
  std::vector<double> areas_;                   // cumulative, m^2
  std::vector<std::pair<int, int>> triangles_;  // part and triangle, by entry of `areas_`
};

}  // namespace simwright::certificate
