#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace simwright::geometry {

// Points by coordinate, for tests of four at once. The last point is repeated up to a multiple of
// four.
class PointLanes {
 public:
  PointLanes() = default;
  explicit PointLanes(const std::vector<Eigen::Vector3d>& points);

  int size() const { return size_; }  // points

  // Returns the largest normal . p; minus infinity without points.
  double Support(const Eigen::Vector3d& normal) const;

  // Returns the points in `box`, borders included, in their order.
  PointLanes Within(const Eigen::AlignedBox3d& box) const;

  // Returns the largest depth of a point below the planes (normal . p <= offset), >= 0: the least
  // of offset - normal . p; infinite without planes. Stops at the first point that is deeper than
  // `enough` and returns its depth.
  double Depth(const std::vector<Eigen::Vector4d>& planes, double enough) const;

  // Returns the number of points that are strictly below all planes; all without planes.
  int CountBelow(const std::vector<Eigen::Vector4d>& planes) const;

 private:
  void FillUp();

  std::array<std::vector<double>, 3> rows_;
  int size_ = 0;
};

}  // namespace simwright::geometry
