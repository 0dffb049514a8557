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

// A point of a shape that can be its first contact with a plane: the lowest point of a ball about
// it.
struct FloorPoint {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // m, principal frame
  double radius = 0.0;                               // m
};

// The contact generation between two hulls. With kPoints Bullet finds one pair of nearest points
// per step and caches up to four, so that the contacts of resting faces come from different steps
// and stacks of boxes creep by millimetres. With kFaces it clips the two facing polygons and gets
// the full contact manifold in one step; this needs each hull's faces.
enum class HullContact { kPoints, kFaces };

// The collision shape of a rigid body in Bullet's form: the centre of mass at the origin and a
// diagonal inertia, so the body's frame is rotated to the principal axes. A body without a mass
// keeps its own frame. Throws core::Error for parts with fewer than four vertices.
class BulletShape {
 public:
  // `margin`: m, around each hull.
  BulletShape(const RigidBody& body, double margin, HullContact contact = HullContact::kPoints);
  ~BulletShape();
  BulletShape(const BulletShape&) = delete;
  BulletShape& operator=(const BulletShape&) = delete;

  btCompoundShape* compound() const { return compound_.get(); }  // may be empty
  const Eigen::Isometry3d& body_from_principal() const { return body_from_principal_; }
  const Eigen::Vector3d& moments() const { return moments_; }  // kg m^2, principal
  // Returns the vertices of the convex hull of all parts, and the ends of its capsules.
  const std::vector<FloorPoint>& floor_points() const { return floor_points_; }
  // Returns the radius (m) of a ball about the principal frame's origin that contains their balls.
  double floor_radius() const { return floor_radius_; }

 private:
  void AddCapsule(const Capsule& capsule, const Eigen::Isometry3d& principal_from_body);
  void AddHull(const core::TriangleMesh& part, const Eigen::Isometry3d& principal_from_body,
               const std::string& name, double margin, HullContact contact);
  void AddFloorPoints(const RigidBody& body, const Eigen::Isometry3d& principal_from_body,
                      double margin);

  std::vector<std::unique_ptr<btConvexShape>> convex_;
  std::unique_ptr<btCompoundShape> compound_;
  std::vector<FloorPoint> floor_points_;
  double floor_radius_ = 0.0;
  Eigen::Isometry3d body_from_principal_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d moments_ = Eigen::Vector3d::Zero();
};

}  // namespace simwright::sim
