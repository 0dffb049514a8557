#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/rigid_body.h"

class btCompoundShape;
class btConvexShape;
class btTransform;
class btVector3;

namespace simwright::sim {

btVector3 ToBullet(const Eigen::Vector3d& v);
btTransform ToBullet(const Eigen::Isometry3d& pose);
Eigen::Vector3d FromBullet(const btVector3& v);
Eigen::Isometry3d FromBullet(const btTransform& transform);

// A point of a shape that can be the first to touch a plane: the lowest of a ball about it.
struct FloorPoint {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // m, principal frame
  double radius = 0.0;                               // m
};

// How two hulls touch. Bullet finds one pair of nearest points a step and keeps up to four of the
// last ones: what lies flat on another then stands on points of many steps, and stacks of boxes
// that were still for a tenth of a second creep by millimetres. With faces it clips the two that
// look at each other, and a step has all of their corners; that needs each hull's faces.
enum class HullContact { kPoints, kFaces };

// A rigid body's parts as Bullet wants them: the centre of mass at the origin and the inertia
// diagonal, so the body's frame is turned to the principal axes. A body without a mass keeps its
// own frame. Throws core::Error for parts of fewer than four vertices.
class BulletShape {
 public:
  // `margin`: m, about each hull.
  BulletShape(const RigidBody& body, double margin, HullContact contact = HullContact::kPoints);
  ~BulletShape();
  BulletShape(const BulletShape&) = delete;
  BulletShape& operator=(const BulletShape&) = delete;

  btCompoundShape* compound() const { return compound_.get(); }  // may be empty
  const Eigen::Isometry3d& body_from_principal() const { return body_from_principal_; }
  const Eigen::Vector3d& moments() const { return moments_; }  // kg m^2, principal
  // The corners of the parts' common hull, and the ends of its capsules.
  const std::vector<FloorPoint>& floor_points() const { return floor_points_; }

 private:
  void AddCapsule(const Capsule& capsule, const Eigen::Isometry3d& principal_from_body);
  void AddHull(const core::TriangleMesh& part, const Eigen::Isometry3d& principal_from_body,
               const std::string& name, double margin, HullContact contact);
  void AddFloorPoints(const RigidBody& body, const Eigen::Isometry3d& principal_from_body,
                      double margin);

  std::vector<std::unique_ptr<btConvexShape>> convex_;
  std::unique_ptr<btCompoundShape> compound_;
  std::vector<FloorPoint> floor_points_;
  Eigen::Isometry3d body_from_principal_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d moments_ = Eigen::Vector3d::Zero();
};

}  // namespace simwright::sim
