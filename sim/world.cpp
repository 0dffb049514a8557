#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <btBulletDynamicsCommon.h>

#include "core/error.h"
#include "sim/bullet_shape.h"

namespace simwright::sim {
namespace {

struct LoadedBody {
  const BulletShape* shape = nullptr;
  std::unique_ptr<btRigidBody> rigid;
  double friction = 0.0, rolling_friction = 0.0;
};

// The plane z = 0 with an AABB that ends `reach` (m) above it.
class Floor : public btStaticPlaneShape {
 public:
  explicit Floor(double reach) : btStaticPlaneShape(btVector3(0, 0, 1), 0), reach_(reach) {}
  void getAabb(const btTransform& at, btVector3& low, btVector3& high) const override {
    btStaticPlaneShape::getAabb(at, low, high);
    high.setZ(reach_);
  }

 private:
  double reach_;
};

}  // namespace

struct World::Bullet {
  explicit Bullet(double floor_reach) : floor_shape(floor_reach) {}

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  Floor floor_shape;
  std::unique_ptr<btRigidBody> floor;
  // One shape for all bodies with the same description: a table has nine steamers, and the faces of
  // hulls take long to compute.
  std::map<const RigidBody*, std::unique_ptr<BulletShape>> shapes;
  std::vector<LoadedBody> bodies;

  const BulletShape& ShapeOf(const RigidBody& body, double margin) {
    std::unique_ptr<BulletShape>& shape = shapes[&body];
    if (!shape) shape = std::make_unique<BulletShape>(body, margin, HullContact::kFaces);
    return *shape;
  }

  void Remove(const LoadedBody& body) {
    if (body.rigid->getWorldArrayIndex() >= 0) world.removeRigidBody(body.rigid.get());
  }

  ~Bullet() {
    for (const LoadedBody& body : bodies) Remove(body);
    if (floor) world.removeRigidBody(floor.get());
  }
};

World::World(const WorldOptions& options)
    : bullet_(std::make_unique<Bullet>(options.floor_reach)), options_(options) {
  if (!(options.time_step > 0.0) || options.solver_iterations < 1 || !(options.margin >= 0.0) ||
      !(options.floor_reach > 0.0)) {
    throw core::Error(
        "a world needs a positive time step and reach of its floor, and at least one solver "
        "iteration");
  }
  bullet_->world.setGravity(btVector3(0, 0, -options.gravity));
  btContactSolverInfo& solver = bullet_->world.getSolverInfo();
  solver.m_numIterations = options.solver_iterations;
  if (options.full_warm_start) {
    solver.m_warmstartingFactor = 1.0;
    solver.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  }
  solver.m_splitImpulse = 1;  // depenetration without added velocity
  // The default of 4 cm would let small objects sink in before they are depenetrated.
  solver.m_splitImpulsePenetrationThreshold = 0.0;
  // A hull has only its deepest vertex in contact with a plane: without perturbation, an object on
  // a small facet trembles forever. Perturbed iterations find the contacts of the whole facet; but
  // with four cached points no more are searched, or those of many parts drive each other along the
  // floor.
  bullet_->configuration.setPlaneConvexMultipointIterations(8, 4);
  bullet_->floor_shape.setMargin(0.0);
  btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, &bullet_->floor_shape);
  info.m_friction = options.floor_friction;
  info.m_restitution = 1.0;  // multiplied with the body's own
  bullet_->floor = std::make_unique<btRigidBody>(info);
  bullet_->world.addRigidBody(bullet_->floor.get());
}

World::~World() = default;

int World::Add(const RigidBody& body, const Eigen::Isometry3d& world_from_body) {
  if (body.parts.empty() || !(body.inertial.mass > 0.0)) {
    throw core::Error("a body needs collision parts and a mass", body.name);
  }
  return AddBody(body, world_from_body, body.inertial.mass);
}

int World::AddFixed(const RigidBody& body, const Eigen::Isometry3d& world_from_body) {
  if (body.parts.empty()) throw core::Error("a body needs collision parts", body.name);
  return AddBody(body, world_from_body, 0.0);
}

int World::AddBody(const RigidBody& body, const Eigen::Isometry3d& world_from_body, double mass) {
  const BulletShape& shape = bullet_->ShapeOf(body, options_.margin);
  const btVector3 moments = mass > 0.0 ? ToBullet(shape.moments()) : btVector3(0, 0, 0);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.compound(), moments);
  info.m_startWorldTransform = ToBullet(world_from_body * shape.body_from_principal());
  info.m_friction = body.friction;
  info.m_restitution = body.restitution;
  info.m_rollingFriction = body.rolling_friction;
  info.m_spinningFriction = body.rolling_friction;
  auto rigid = std::make_unique<btRigidBody>(info);
  rigid->setActivationState(DISABLE_DEACTIVATION);
  // Scaled to the body: Bullet's fixed 2 cm would merge contacts of small objects.
  rigid->setContactProcessingThreshold(1e30);
  bullet_->world.addRigidBody(rigid.get());
  bullet_->bodies.push_back({&shape, std::move(rigid), body.friction, body.rolling_friction});
  return static_cast<int>(bullet_->bodies.size()) - 1;
}

void World::Remove(int body) {
  bullet_->Remove(bullet_->bodies.at(static_cast<size_t>(body)));
}

void World::SetGravity(const Eigen::Vector3d& gravity) {
  bullet_->world.setGravity(ToBullet(gravity));  // also of all bodies
}

void World::ScaleFriction(double scale) {
  const double share = std::sqrt(scale);  // Bullet multiplies the coefficients of both bodies
  for (const LoadedBody& body : bullet_->bodies) {
    body.rigid->setFriction(share * body.friction);
    body.rigid->setRollingFriction(share * body.rolling_friction);
    body.rigid->setSpinningFriction(share * body.rolling_friction);
  }
  bullet_->floor->setFriction(share * options_.floor_friction);
}

void World::ZeroVelocities() {
  const btVector3 zero(0, 0, 0);
  btOverlappingPairCache* const pairs = bullet_->broadphase.getOverlappingPairCache();
  for (const LoadedBody& body : bullet_->bodies) {
    body.rigid->setLinearVelocity(zero);
    body.rigid->setAngularVelocity(zero);
    if (body.rigid->getWorldArrayIndex() < 0) continue;  // removed
    pairs->cleanProxyFromPairs(body.rigid->getBroadphaseHandle(), &bullet_->dispatcher);
  }
}

void World::Step() {
  bullet_->world.stepSimulation(options_.time_step, 0, options_.time_step);
  time_ += options_.time_step;
}

Eigen::Isometry3d World::Pose(int body) const {
  const LoadedBody& loaded = bullet_->bodies.at(static_cast<size_t>(body));
  return FromBullet(loaded.rigid->getWorldTransform()) *
         loaded.shape->body_from_principal().inverse();
}

Eigen::Vector3d World::LinearVelocity(int body) const {
  return FromBullet(bullet_->bodies.at(static_cast<size_t>(body)).rigid->getLinearVelocity());
}

Eigen::Vector3d World::AngularVelocity(int body) const {
  return FromBullet(bullet_->bodies.at(static_cast<size_t>(body)).rigid->getAngularVelocity());
}

double World::DeepestPenetration() const {
  double deepest = 0.0;
  for (int i = 0; i < bullet_->dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold* manifold = bullet_->dispatcher.getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold->getNumContacts(); ++k) {
      deepest = std::max(deepest, -manifold->getContactPoint(k).getDistance());
    }
  }
  return deepest;
}

assets::Inertial World::LoadedInertial(int body) const {
  const LoadedBody& loaded = bullet_->bodies.at(static_cast<size_t>(body));
  assets::Inertial inertial;
  inertial.mass = 1.0 / loaded.rigid->getInvMass();
  inertial.center_of_mass = loaded.shape->body_from_principal().translation();
  const Eigen::Vector3d moments = FromBullet(loaded.rigid->getInvInertiaDiagLocal()).cwiseInverse();
  const Eigen::Matrix3d R = loaded.shape->body_from_principal().linear();
  inertial.inertia = R * moments.asDiagonal() * R.transpose();
  return inertial;
}

}  // namespace simwright::sim
