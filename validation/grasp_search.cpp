#include "validation/grasp_search.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/distance.h"

namespace simwright::validation {
namespace {

constexpr int kClosingAxes = 4;        // about an approach direction, over half a turn
constexpr double kClosingStep = 1e-3;  // m, of each finger
constexpr double kTouch = 1.0e-3;      // m: a finger closer than this touches

using Parts = std::vector<core::TriangleMesh>;

geometry::ConvexShape BoxShape(const Eigen::Vector3d& center, const Eigen::Matrix3d& axes,
                               const Eigen::Vector3d& half) {
  geometry::ConvexShape shape;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    shape.vertices.push_back(center + axes * sign.cwiseProduct(half));
  }
  return shape;
}

double Distance(const Parts& parts, const geometry::ConvexShape& body) {
  if (parts.empty()) return std::numeric_limits<double>::infinity();
  return geometry::SignedDistanceToParts(parts, body).distance;
}

// One gripper pose: the columns of `axes` are the approach direction, the closing axis, and the
// third.
struct Pose {
  Eigen::Vector3d grip;
  Eigen::Matrix3d axes;
};

class Search {
 public:
  Search(const Parts& handle, const Parts& others, const Gripper& gripper)
      : handle_(handle), gripper_(gripper) {
    Eigen::AlignedBox3d reach;
    for (const core::TriangleMesh& part : handle) reach.extend(core::Bounds(part));
    const double far = gripper.approach + gripper.length + gripper.opening;
    reach.min().array() -= far;
    reach.max().array() += far;
    for (const core::TriangleMesh& part : others) {
      if (reach.intersects(core::Bounds(part))) others_.push_back(part);
    }
  }

  bool IsGrasp(const Pose& pose) const {
    return IsApproachFree(pose) && Closes(pose, 1.0) && Closes(pose, -1.0);
  }

 private:
  // Returns the box of a finger, extended by `back` away from the tip and shifted by `shift` m
  // towards the centre; side +1 or -1.
  geometry::ConvexShape Finger(const Pose& p, double side, double back, double shift) const {
    const double length = gripper_.length + back;
    const double along = gripper_.overlap - 0.5 * length;
    const double across = side * (0.5 * (gripper_.opening + gripper_.thickness) - shift);
    return BoxShape(p.grip + along * p.axes.col(0) + across * p.axes.col(1), p.axes,
                    0.5 * Eigen::Vector3d(length, gripper_.thickness, gripper_.width));
  }
  bool Free(const geometry::ConvexShape& body) const {
    return Distance(others_, body) > 0.0 && Distance(handle_, body) > 0.0;
  }
  bool IsApproachFree(const Pose& p) const {
    const double palm = gripper_.overlap - gripper_.length - 0.5 * gripper_.approach;
    return Free(Finger(p, 1.0, gripper_.approach, 0.0)) &&
           Free(Finger(p, -1.0, gripper_.approach, 0.0)) &&
           Free(BoxShape(
               p.grip + palm * p.axes.col(0), p.axes,
               0.5 * Eigen::Vector3d(gripper_.approach, gripper_.opening + 2.0 * gripper_.thickness,
                                     gripper_.width)));
  }
  bool Closes(const Pose& p, double side) const {
    for (double shift = 0.0; shift <= 0.5 * gripper_.opening; shift += kClosingStep) {
      const geometry::ConvexShape finger = Finger(p, side, 0.0, shift);
      if (!(Distance(others_, finger) > 0.0)) return false;
      if (Distance(handle_, finger) < kTouch) return true;
    }
    return false;
  }

  const Parts& handle_;
  Parts others_;  // within reach
  Gripper gripper_;
};

// Returns the centres of the parts and, for a long part, also the centres of its two halves.
std::vector<Eigen::Vector3d> GripPoints(const Parts& handle) {
  std::vector<Eigen::Vector3d> points;
  for (const core::TriangleMesh& part : handle) {
    const Eigen::AlignedBox3d box = core::Bounds(part);
    points.push_back(box.center());
    for (int axis = 0; axis < 3; ++axis) {
      if (box.sizes()[axis] < 0.05) continue;
      for (const double share : {-0.25, 0.25}) {
        points.push_back(box.center());
        points.back()[axis] += share * box.sizes()[axis];
      }
    }
  }
  return points;
}

}  // namespace

GraspSearch SearchGrasps(const Parts& handle, const Parts& others, const Gripper& gripper) {
  const Search search(handle, others, gripper);
  const std::vector<Eigen::Vector3d> points = GripPoints(handle);
  GraspSearch result;
  for (int code = 0; code < 27; ++code) {
    const Eigen::Vector3d direction(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
    if (direction.norm() < 0.5) continue;
    ++result.tried;
    bool held = false;
    for (int i = 0; i < kClosingAxes && !held; ++i) {
      Pose pose;
      pose.axes.col(0) = direction.normalized();
      const Eigen::Vector3d side = pose.axes.col(0).unitOrthogonal();
      pose.axes.col(1) =
          Eigen::AngleAxisd(std::numbers::pi * i / kClosingAxes, pose.axes.col(0)) * side;
      pose.axes.col(2) = pose.axes.col(0).cross(pose.axes.col(1));
      for (size_t k = 0; k < points.size() && !held; ++k) {
        pose.grip = points[k];
        held = search.IsGrasp(pose);
      }
    }
    result.found += held;
  }
  return result;
}

}  // namespace simwright::validation
