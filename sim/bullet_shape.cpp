#include "sim/bullet_shape.h"

#include <algorithm>

#include <btBulletDynamicsCommon.h>

#include "core/error.h"
#include "geometry/convex_hull.h"
#include "geometry/mass_properties.h"

namespace simwright::sim {

btVector3 ToBullet(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

btTransform ToBullet(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()),
                     ToBullet(Eigen::Vector3d(pose.translation())));
}

Eigen::Vector3d FromBullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

Eigen::Isometry3d FromBullet(const btTransform& transform) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const btQuaternion q = transform.getRotation();
  pose.linear() = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
  pose.translation() = FromBullet(transform.getOrigin());
  return pose;
}

namespace {

// Returns the area share of the largest flat face: about a third for a box, a tenth for a can's
// base, a fortieth for a round fruit of fifty vertices.
double LargestFaceShare(const core::TriangleMesh& part) {
  std::vector<Eigen::Vector3d> areas;  // m^2, along each triangle's normal
  double all = 0.0, largest = 0.0;
  for (const Eigen::Vector3i& t : part.triangles) {
    const Eigen::Vector3d& a = part.vertices[static_cast<size_t>(t[0])];
    areas.push_back(0.5 * (part.vertices[static_cast<size_t>(t[1])] - a)
                              .cross(part.vertices[static_cast<size_t>(t[2])] - a));
    all += areas.back().norm();
  }
  for (const Eigen::Vector3d& area : areas) {
    double face = 0.0;
    for (const Eigen::Vector3d& other : areas) {
      // Within about a thousandth of a radian.
      if (area.dot(other) >= (1.0 - 1e-6) * area.norm() * other.norm()) face += other.norm();
    }
    largest = std::max(largest, face);
  }
  return all > 0.0 ? largest / all : 0.0;
}

constexpr double kFlat = 0.06;  // the LargestFaceShare of shapes that rest on a face

}  // namespace

BulletShape::BulletShape(const RigidBody& body, double margin, HullContact contact) {
  if (body.inertial.mass > 0.0) {
    const geometry::PrincipalInertia principal =
        geometry::PrincipalInertiaOf(body.inertial.inertia);
    body_from_principal_ =
        Eigen::Translation3d(body.inertial.center_of_mass) * Eigen::Isometry3d(principal.axes);
    moments_ = principal.moments;
  }
  const Eigen::Isometry3d principal_from_body = body_from_principal_.inverse();
  compound_ = std::make_unique<btCompoundShape>(true, static_cast<int>(body.parts.size()));
  for (size_t i = 0; i < body.parts.size(); ++i) {
    if (i < body.capsules.size() && body.capsules[i]) {
      AddCapsule(*body.capsules[i], principal_from_body);
    } else {
      AddHull(body.parts[i], principal_from_body, body.name, margin, contact);
    }
  }
  compound_->setMargin(margin);
  compound_->setUserPointer(this);
  AddFloorPoints(body, principal_from_body, margin);
  for (const FloorPoint& point : floor_points_) {
    floor_radius_ = std::max(floor_radius_, point.center.norm() + point.radius);
  }
}

void BulletShape::AddCapsule(const Capsule& capsule, const Eigen::Isometry3d& principal_from_body) {
  const Eigen::Vector3d along = capsule.b - capsule.a;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = 0.5 * (capsule.a + capsule.b);
  if (along.norm() > 0.0) {
    pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along).toRotationMatrix();
    convex_.push_back(std::make_unique<btCapsuleShapeZ>(capsule.radius, along.norm()));
  } else {
    convex_.push_back(std::make_unique<btSphereShape>(capsule.radius));
  }
  // Both shapes are their own margin: setting one would change their size.
  compound_->addChildShape(ToBullet(Eigen::Isometry3d(principal_from_body * pose)),
                           convex_.back().get());
}

void BulletShape::AddHull(const core::TriangleMesh& part,
                          const Eigen::Isometry3d& principal_from_body, const std::string& name,
                          double margin, HullContact contact) {
  if (part.vertices.size() < 4) {
    throw core::Error("a collision part has fewer than four vertices", name);
  }
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Eigen::Vector3d& vertex : part.vertices) {
    hull->addPoint(ToBullet(Eigen::Vector3d(principal_from_body * vertex)), false);
  }
  hull->setMargin(margin);
  hull->recalcLocalAabb();
  // Round objects roll on one point in any pose, at half the cost.
  if (contact == HullContact::kFaces && LargestFaceShare(part) > kFlat) {
    hull->initializePolyhedralFeatures();
  }
  compound_->addChildShape(btTransform::getIdentity(), hull.get());
  convex_.push_back(std::move(hull));
}

void BulletShape::AddFloorPoints(const RigidBody& body,
                                 const Eigen::Isometry3d& principal_from_body, double margin) {
  std::vector<Eigen::Vector3d> corners;
  for (size_t i = 0; i < body.parts.size(); ++i) {
    if (i < body.capsules.size() && body.capsules[i]) {
      const Capsule& capsule = *body.capsules[i];
      floor_points_.push_back({principal_from_body * capsule.a, capsule.radius});
      if (capsule.a != capsule.b) {
        floor_points_.push_back({principal_from_body * capsule.b, capsule.radius});
      }
    } else {
      corners.insert(corners.end(), body.parts[i].vertices.begin(), body.parts[i].vertices.end());
    }
  }
  if (corners.empty()) return;
  for (const Eigen::Vector3d& corner : geometry::ConvexHull(corners).vertices) {
    floor_points_.push_back({principal_from_body * corner, margin});
  }
}

BulletShape::~BulletShape() = default;

}  // namespace simwright::sim
