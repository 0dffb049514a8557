#include "sim/floor_contact.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "sim/bullet_shape.h"

namespace simwright::sim {
namespace {

// m: cached contacts are kept until a point is deeper than all of them by this. The deepest corner
// of a flat base changes from step to step, and each new contact starts without an impulse.
constexpr double kKeep = 2e-5;

class ShapeOnPlane : public btCollisionAlgorithm {
 public:
  ShapeOnPlane(const btCollisionAlgorithmConstructionInfo& info,
               const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second,
               bool swapped)
      : btCollisionAlgorithm(info), swapped_(swapped) {
    const btCollisionObjectWrapper* shape = swapped ? second : first;
    const btCollisionObjectWrapper* plane = swapped ? first : second;
    if (m_dispatcher->needsCollision(shape->getCollisionObject(), plane->getCollisionObject())) {
      manifold_ =
          m_dispatcher->getNewManifold(shape->getCollisionObject(), plane->getCollisionObject());
    }
  }
  ~ShapeOnPlane() override {
    if (manifold_ != nullptr) m_dispatcher->releaseManifold(manifold_);
  }

  void processCollision(const btCollisionObjectWrapper* first,
                        const btCollisionObjectWrapper* second, const btDispatcherInfo&,
                        btManifoldResult* result) override;
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1.0;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    if (manifold_ != nullptr) manifolds.push_back(manifold_);
  }

 private:
  bool swapped_;
  btPersistentManifold* manifold_ = nullptr;
};

// A plane in the shape's frame: the height of a point p is normal . p - offset.
struct LocalPlane {
  btVector3 normal;
  double offset;
  double Height(const btVector3& point) const { return normal.dot(point) - offset; }
};

LocalPlane PlaneInFrame(const btTransform& world_from_shape, const btStaticPlaneShape& plane,
                        const btTransform& world_from_plane) {
  const btTransform plane_from_shape = world_from_plane.inverse() * world_from_shape;
  const btVector3 normal = plane.getPlaneNormal() * plane_from_shape.getBasis();
  return {normal,
          plane.getPlaneConstant() - plane.getPlaneNormal().dot(plane_from_shape.getOrigin())};
}

double Lowest(const std::vector<FloorPoint>& points, const LocalPlane& plane) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const FloorPoint& point : points) {
    lowest = std::min(lowest, plane.Height(ToBullet(point.center)) - point.radius);
  }
  return lowest;
}

double DeepestOf(const btPersistentManifold& manifold) {
  double deepest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    deepest = std::min<double>(deepest, manifold.getContactPoint(i).getDistance());
  }
  return deepest;
}

void ShapeOnPlane::processCollision(const btCollisionObjectWrapper* first,
                                    const btCollisionObjectWrapper* second, const btDispatcherInfo&,
                                    btManifoldResult* result) {
  if (manifold_ == nullptr) return;
  const btCollisionObjectWrapper* object = swapped_ ? second : first;
  const btCollisionObjectWrapper* floor = swapped_ ? first : second;
  const auto& plane_shape = static_cast<const btStaticPlaneShape&>(*floor->getCollisionShape());
  const btTransform& world_from_shape = object->getWorldTransform();
  const LocalPlane plane = PlaneInFrame(world_from_shape, plane_shape, floor->getWorldTransform());
  const auto& shape =
      *static_cast<const BulletShape*>(object->getCollisionShape()->getUserPointer());
  result->setPersistentManifold(manifold_);
  result->refreshContactPoints();
  const double reach = manifold_->getContactBreakingThreshold();
  if (plane.Height(btVector3(0, 0, 0)) - shape.floor_radius() > reach) return;
  const double lowest = Lowest(shape.floor_points(), plane);
  if (lowest > reach) return;
  if (manifold_->getNumContacts() >= 3 && lowest > DeepestOf(*manifold_) - kKeep) return;
  const btVector3 normal = floor->getWorldTransform().getBasis() * plane_shape.getPlaneNormal();
  for (const FloorPoint& point : shape.floor_points()) {
    const btVector3 center = ToBullet(point.center);
    const double height = plane.Height(center);
    if (height - point.radius > reach) continue;
    result->addContactPoint(normal, world_from_shape * center - normal * height,
                            height - point.radius);
  }
}

struct CreateShapeOnPlane : btCollisionAlgorithmCreateFunc {
  explicit CreateShapeOnPlane(bool swapped) { m_swapped = swapped; }
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* first,
                                                 const btCollisionObjectWrapper* second) override {
    void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(ShapeOnPlane));
    return new (memory) ShapeOnPlane(info, first, second, m_swapped);
  }
};

}  // namespace

void CollideShapesWithFloor(btCollisionDispatcher* dispatcher) {
  static CreateShapeOnPlane shape_first(false), plane_first(true);  // stateless
  dispatcher->registerCollisionCreateFunc(COMPOUND_SHAPE_PROXYTYPE, STATIC_PLANE_PROXYTYPE,
                                          &shape_first);
  dispatcher->registerCollisionCreateFunc(STATIC_PLANE_PROXYTYPE, COMPOUND_SHAPE_PROXYTYPE,
                                          &plane_first);
}

}  // namespace simwright::sim
