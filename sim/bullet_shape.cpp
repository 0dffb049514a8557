#include "sim/bullet_shape.h"

#include <btBulletDynamicsCommon.h>

#include "core/error.h"
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

BulletShape::BulletShape(const RigidBody& body, double margin) {
  if (body.inertial.mass > 0.0) {
    const geometry::PrincipalInertia principal =
        geometry::PrincipalInertiaOf(body.inertial.inertia);
    body_from_principal_ =
        Eigen::Translation3d(body.inertial.center_of_mass) * Eigen::Isometry3d(principal.axes);
    moments_ = principal.moments;
  }
  const Eigen::Isometry3d principal_from_body = body_from_principal_.inverse();
  compound_ = std::make_unique<btCompoundShape>(true, static_cast<int>(body.parts.size()));
  for (const core::TriangleMesh& part : body.parts) {
    if (part.vertices.size() < 4) {
      throw core::Error("a collision part has fewer than four vertices", body.name);
    }
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Eigen::Vector3d& vertex : part.vertices) {
      hull->addPoint(ToBullet(Eigen::Vector3d(principal_from_body * vertex)), false);
    }
    hull->setMargin(margin);
    hull->recalcLocalAabb();
    compound_->addChildShape(btTransform::getIdentity(), hull.get());
    hulls_.push_back(std::move(hull));
  }
  compound_->setMargin(margin);
}

BulletShape::~BulletShape() = default;

}  // namespace simwright::sim
