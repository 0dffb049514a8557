#include "sim/articulated_world.h"

#include <algorithm>
#include <memory>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>

#include "core/error.h"
#include "sim/bullet_shape.h"
#include "sim/compact_solver.h"
#include "sim/exclusion_filter.h"
#include "sim/floor_contact.h"
#include "sim/link_setup.h"
#include "sim/loaded_tree.h"

namespace simwright::sim {
namespace {

constexpr int kFloorGroup = btBroadphaseProxy::SensorTrigger << 1;  // the first unused group
constexpr int kFloorUserIndex = -1;  // Bullet's own default for unnumbered bodies

// m: Bullet keeps a contact point while its bodies slide past each other by less than this. With
// the default of 2 cm a closing oven door was blocked by a point that it had already passed.
constexpr double kContactReach = 0.002;

double FrictionOf(const RigidBody& link, int index, const Placement& placement) {
  for (const auto& [given, friction] : placement.link_friction) {
    if (given == index) return placement.friction_scale * friction;
  }
  return placement.friction_scale * link.friction;
}

void RequireMass(const ArticulatedBody& body, bool fixed) {
  for (size_t i = 0; i < body.links.size(); ++i) {
    const bool moves = i == 0 ? !fixed : body.joints()[i - 1].Moves();
    if (moves && !(body.links[i].inertial.mass > 0.0)) {
      throw core::Error("a moving link has no mass",
                        body.name() + " link '" + body.links[i].name + "'",
                        "add an <inertial> element");
    }
  }
}

// Returns pool sizes. Bullet allocates 4096 of each, 7 MB per world, and writes to all of them when
// a world is created; beyond a smaller pool it allocates from the heap.
btDefaultCollisionConstructionInfo Pools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 64;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 256;
  return info;
}

}  // namespace

struct ArticulatedWorld::Bullet {
  explicit Bullet(const WorldOptions& options)
      : compact(options.compact_solver), sleeping(options.sleeping && options.compact_solver) {
    world = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher, &broadphase, &solver,
                                                       &configuration);
    broadphase.getOverlappingPairCache()->setOverlapFilterCallback(exclusion.callback());
  }

  btDefaultCollisionConfiguration configuration{Pools()};
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  ExclusionFilter exclusion;
  bool compact, sleeping;
  CompactSolver compact_solver;        // if so
  btMultiBodyConstraintSolver solver;  // else
  std::unique_ptr<btMultiBodyDynamicsWorld> world;
  btStaticPlaneShape floor_shape{btVector3(0, 0, 1), 0};
  std::unique_ptr<btRigidBody> floor;
  std::vector<std::unique_ptr<LoadedTree>> bodies;
  std::vector<std::vector<btCollisionObject*>> moving_colliders;  // by body, for PutToSleep
  btAlignedObjectArray<btQuaternion> scratch_turns;
  btAlignedObjectArray<btVector3> scratch_origins;

  ~Bullet() {
    for (const auto& body : bodies) {
      for (const LoadedJoint& joint : body->joints) {
        if (joint.motor_constraint)
          world->removeMultiBodyConstraint(joint.motor_constraint->constraint());
        if (joint.limit) world->removeMultiBodyConstraint(joint.limit.get());
        if (joint.gear) world->removeMultiBodyConstraint(joint.gear.get());
      }
      for (const auto& collider : body->colliders) {
        if (collider) world->removeCollisionObject(collider.get());
      }
      world->removeMultiBody(body->multi.get());
    }
    world->removeRigidBody(floor.get());
  }

  LoadedTree& Body(int index) { return *bodies.at(static_cast<size_t>(index)); }
  void WakeAll() {
    for (size_t i = 0; i < bodies.size(); ++i) Wake(static_cast<int>(i));
  }
  // Returns the body, awake for the next fifth of a second.
  LoadedTree& Wake(int index) {
    LoadedTree& loaded = Body(index);
    if (loaded.dynamics) loaded.dynamics->Disturb();
    return loaded;
  }

  void AddColliders(const ArticulatedBody& body, const Placement& placement, LoadedTree* loaded);
  void AddJoints(const ArticulatedBody& body, double scale, LoadedTree* loaded);
  void AddBulletConstraints(const assets::Joint& joint, int link, LoadedTree* loaded,
                            LoadedJoint* entry);
  void Step(double dt);
  void UpdatePoses(LoadedTree* loaded) {
    if (compact) {
      if (!loaded->FollowDynamics()) return;
    } else {
      loaded->multi->forwardKinematics(scratch_turns, scratch_origins);
      loaded->multi->updateCollisionObjectWorldTransforms(scratch_turns, scratch_origins);
      loaded->PlaceColliders();
    }
    for (const auto& collider : loaded->colliders) {
      if (collider) world->updateSingleAabb(collider.get());
    }
  }
};

void ArticulatedWorld::Bullet::AddColliders(const ArticulatedBody& body, const Placement& placement,
                                            LoadedTree* loaded) {
  if (placement.self_contacts) {
    exclusion.AllowSelfContacts(static_cast<int>(bodies.size()), body.kinematics->excluded_pairs());
  }
  moving_colliders.emplace_back();
  for (size_t i = 0; i < body.links.size(); ++i) {
    const RigidBody& link = body.links[i];
    const TreeLink& place = loaded->tree->links[i];
    const bool carries = place.carrier == static_cast<int>(i);
    loaded->colliders.emplace_back();
    // A carrier without a shape needs a collider too, or Bullet skips the limits and motors of its
    // joint.
    if (!carries && link.parts.empty()) continue;
    auto collider = std::make_unique<btMultiBodyLinkCollider>(loaded->multi.get(), place.bullet);
    collider->setCollisionShape(loaded->Shape(static_cast<int>(i)).compound());
    collider->setFriction(FrictionOf(link, static_cast<int>(i), placement));
    collider->setRestitution(link.restitution);
    collider->setRollingFriction(link.rolling_friction);
    collider->setSpinningFriction(link.torsional_friction.value_or(link.rolling_friction));
    collider->setContactProcessingThreshold(1e30);
    collider->setUserIndex(static_cast<int>(bodies.size()));
    collider->setUserIndex2(static_cast<int>(i));
    const bool still = placement.fixed && place.carrier == 0;
    if (still) collider->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    const int group = still ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter;
    int mask = btBroadphaseProxy::AllFilter;
    if (still) mask ^= btBroadphaseProxy::StaticFilter;
    const auto& through = placement.through_floor;
    const bool no_floor =
        std::find(through.begin(), through.end(), static_cast<int>(i)) != through.end();
    if (still || no_floor) mask &= ~kFloorGroup;
    world->addCollisionObject(collider.get(), group, placement.contacts ? mask : 0);
    if (i == 0) {
      loaded->multi->setBaseCollider(collider.get());
    } else if (carries) {
      loaded->multi->getLink(place.bullet).m_collider = collider.get();
    }
    if (still && sleeping) collider->forceActivationState(ISLAND_SLEEPING);
    if (!still) moving_colliders.back().push_back(collider.get());
    loaded->colliders.back() = std::move(collider);
  }
  loaded->AddOffsets();
}

void ArticulatedWorld::Bullet::AddJoints(const ArticulatedBody& body, double scale,
                                         LoadedTree* loaded) {
  loaded->joints.resize(body.joints().size());
  for (const int i : body.kinematics->moving_joints()) {
    const assets::Joint& joint = body.joints()[static_cast<size_t>(i)];
    LoadedJoint& entry = loaded->joints[static_cast<size_t>(i)];
    entry.moves = true;
    entry.friction = scale * joint.friction;
    entry.motor = {0.0, -entry.friction, entry.friction, scale * joint.damping};
    int leader = -1;
    if (joint.mimic) {
      const int led_by = body.kinematics->JointIndex(joint.mimic->joint);
      if (!body.joints()[static_cast<size_t>(led_by)].Moves()) {
        throw core::Error("mimics joint '" + joint.mimic->joint + "', which does not move",
                          "joint " + joint.name, "make it fixed, or let it mimic another joint");
      }
      leader = loaded->Joint(led_by);
    }
    const int link = loaded->Joint(i);
    if (compact) {
      const bool limited = joint.type != assets::JointType::kContinuous;
      SolverJoint solved{link, &entry.motor, limited, joint.lower, joint.upper, leader};
      if (joint.mimic) {
        solved.multiplier = joint.mimic->multiplier;
        solved.offset = joint.mimic->offset;
        solved.gear_force = &entry.gear_force;
      }
      compact_solver.AddJoint(static_cast<int>(bodies.size()), solved);
      continue;
    }
    if (joint.mimic) entry.gear = GearTo(*joint.mimic, leader, link, loaded->multi.get());
    AddBulletConstraints(joint, link, loaded, &entry);
  }
}

void ArticulatedWorld::Bullet::AddBulletConstraints(const assets::Joint& joint, int link,
                                                    LoadedTree* loaded, LoadedJoint* entry) {
  btMultiBody* multi = loaded->multi.get();
  entry->motor_constraint = std::make_unique<JointVelocityConstraint>(multi, link, &entry->motor);
  world->addMultiBodyConstraint(entry->motor_constraint->constraint());
  if (entry->gear) world->addMultiBodyConstraint(entry->gear.get());
  if (joint.type == assets::JointType::kContinuous) return;
  entry->limit =
      std::make_unique<btMultiBodyJointLimitConstraint>(multi, link, joint.lower, joint.upper);
  world->addMultiBodyConstraint(entry->limit.get());
}

// Bullet finds the contacts in both cases.
void ArticulatedWorld::Bullet::Step(double dt) {
  if (!compact) {
    world->stepSimulation(dt, 0, dt);
    for (const auto& body : bodies) body->PlaceColliders();
  } else {
    btDispatcherInfo& info = world->getDispatchInfo();
    info.m_timeStep = dt;
    info.m_stepCount = 0;
    world->computeOverlappingPairs();
    if (sleeping) {
      compact_solver.PutToSleep(dt, moving_colliders, broadphase.getOverlappingPairCache());
    }
    dispatcher.dispatchAllCollisionPairs(broadphase.getOverlappingPairCache(), info, &dispatcher);
    compact_solver.Step(dt, world->getSolverInfo().m_numIterations, FromBullet(world->getGravity()),
                        &dispatcher);
    for (size_t i = 0; i < bodies.size(); ++i) {
      if (!compact_solver.IsAsleep(static_cast<int>(i))) UpdatePoses(bodies[i].get());
    }
  }
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    dispatcher.getManifoldByIndexInternal(i)->setContactBreakingThreshold(kContactReach);
  }
}

ArticulatedWorld::ArticulatedWorld(const WorldOptions& options)
    : bullet_(std::make_unique<Bullet>(options)), options_(options) {
  if (!(options.time_step > 0.0) || options.solver_iterations < 1 || !(options.margin >= 0.0)) {
    throw core::Error("a world needs a positive time step and at least one solver iteration");
  }
  bullet_->world->setGravity(btVector3(0, 0, -options.gravity));
  btContactSolverInfo& solver = bullet_->world->getSolverInfo();
  solver.m_numIterations = options.solver_iterations;
  // Warm-starts from the last step's impulses, which is off by default for articulated bodies.
  // Against a light link's contact each iteration moves the impulse only by a share: without it, a
  // gripper of 20 N gripped with 12 N after 50 iterations.
  solver.m_solverMode |= SOLVER_USE_ARTICULATED_WARMSTARTING;
  // CompactSolver requires friction constraints in pairs.
  solver.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  bullet_->world->getDispatchInfo().m_deterministicOverlappingPairs = true;
  CollideShapesWithFloor(&bullet_->dispatcher);
  bullet_->floor_shape.setMargin(0.0);
  btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, &bullet_->floor_shape);
  info.m_friction = options.floor_friction;
  info.m_restitution = 1.0;  // multiplied with the body's own
  bullet_->floor = std::make_unique<btRigidBody>(info);
  bullet_->floor->setUserIndex(kFloorUserIndex);
  bullet_->world->addRigidBody(bullet_->floor.get(), kFloorGroup, btBroadphaseProxy::AllFilter);
  if (bullet_->sleeping) bullet_->floor->forceActivationState(ISLAND_SLEEPING);
}

ArticulatedWorld::~ArticulatedWorld() = default;

PreparedBody::PreparedBody(ArticulatedBody body, double margin) : body_(std::move(body)) {
  if (!body_.kinematics || body_.links.size() != body_.kinematics->links().size()) {
    throw core::Error("a body needs a kinematic model, and shapes for each of its links");
  }
  for (const RigidBody& link : body_.links) {
    shapes_.push_back(std::make_unique<BulletShape>(link, margin));
  }
  whole_ = std::make_unique<LinkTree>(WholeTree(body_, shapes_));
  folded_ = std::make_unique<LinkTree>(FoldedTree(body_, shapes_));
}

PreparedBody::~PreparedBody() = default;

int ArticulatedWorld::Add(const ArticulatedBody& body, const Placement& placement) {
  return Add(std::make_shared<PreparedBody>(body, options_.margin), placement);
}

int ArticulatedWorld::Add(std::shared_ptr<const PreparedBody> prepared,
                          const Placement& placement) {
  const ArticulatedBody& body = prepared->body();
  RequireMass(body, placement.fixed);
  auto loaded = std::make_unique<LoadedTree>();
  loaded->shapes_by_link = &prepared->shapes_;
  // Links that may collide stay separate: merged into one carrier, they would not.
  loaded->tree = placement.self_contacts ? prepared->whole_.get() : prepared->folded_.get();
  loaded->prepared = std::move(prepared);
  const TreeLink& root = loaded->tree->links[0];
  const double mass_scale = placement.mass_scale;
  loaded->multi =
      std::make_unique<btMultiBody>(loaded->tree->joint_count, mass_scale * root.mass,
                                    mass_scale * ToBullet(root.moments), placement.fixed, false);
  loaded->multi->setBaseWorldTransform(
      ToBullet(Eigen::Isometry3d(placement.world_from_root * root.link_from_principal)));
  for (size_t i = 1; i < body.links.size(); ++i) {
    if (loaded->tree->links[i].carrier != static_cast<int>(i)) continue;
    SetUpLink(body, *loaded->tree, static_cast<int>(i), mass_scale, loaded->multi.get());
  }
  loaded->multi->finalizeMultiDof();
  loaded->multi->setHasSelfCollision(placement.self_contacts);
  loaded->multi->setLinearDamping(0.0);
  loaded->multi->setAngularDamping(0.0);
  bullet_->world->addMultiBody(loaded->multi.get());
  if (bullet_->compact) {
    loaded->dynamics = std::make_unique<TreeDynamics>(loaded->multi.get());
    bullet_->compact_solver.AddTree(loaded->dynamics.get());
  }
  bullet_->AddColliders(body, placement, loaded.get());
  bullet_->AddJoints(body, placement.joint_scale, loaded.get());
  bullet_->UpdatePoses(loaded.get());
  bullet_->bodies.push_back(std::move(loaded));
  return static_cast<int>(bullet_->bodies.size()) - 1;
}

int ArticulatedWorld::Add(const RigidBody& body, const Eigen::Isometry3d& world_from_body) {
  return Add(ArticulatedBodyFrom(body), {world_from_body, false, false});
}

void ArticulatedWorld::SetPosition(int body, int joint, double position) {
  bullet_->WakeAll();  // something may rest on it
  LoadedTree& loaded = bullet_->Body(body);
  loaded.multi->setJointPos(loaded.Joint(joint), position);
  loaded.multi->setJointVel(loaded.Joint(joint), 0.0);
  if (bullet_->compact) bullet_->compact_solver.ForgetImpulses(body);
  bullet_->UpdatePoses(&loaded);
}

void ArticulatedWorld::SetRootPose(int body, const Eigen::Isometry3d& world_from_root) {
  bullet_->WakeAll();  // something may rest on it
  LoadedTree& loaded = bullet_->Body(body);
  loaded.multi->setBaseWorldTransform(
      ToBullet(Eigen::Isometry3d(world_from_root * loaded.tree->links[0].link_from_principal)));
  loaded.multi->setBaseVel(btVector3(0, 0, 0));
  loaded.multi->setBaseOmega(btVector3(0, 0, 0));
  if (bullet_->compact) bullet_->compact_solver.ForgetImpulses(body);
  bullet_->UpdatePoses(&loaded);
}

void ArticulatedWorld::SetRootVelocity(int body, const Eigen::Vector3d& linear,
                                       const Eigen::Vector3d& angular) {
  btMultiBody& multi = *bullet_->Wake(body).multi;
  multi.setBaseVel(ToBullet(linear));
  multi.setBaseOmega(ToBullet(angular));
}

void ArticulatedWorld::SetGravity(const Eigen::Vector3d& gravity) {
  bullet_->world->setGravity(ToBullet(gravity));
  bullet_->WakeAll();
}

void ArticulatedWorld::Drive(int body, int joint, double velocity, double max_force) {
  LoadedJoint& entry = bullet_->Wake(body).joints.at(static_cast<size_t>(joint));
  if (!entry.moves) throw core::Error("a fixed joint cannot be driven");
  if (bullet_->compact) bullet_->compact_solver.SetDriven(body);
  const double friction = entry.friction;
  const double spare = max_force - friction;
  JointMotor& motor = entry.motor;
  // Friction takes its share of the force along the motion, and adds to it when braking.
  if (velocity == 0.0 || spare <= 0.0) {
    const double hold = velocity == 0.0 ? max_force + friction : friction;
    motor = {0.0, -hold, hold, motor.damping};
  } else if (velocity > 0.0) {
    motor = {velocity, -max_force - friction, spare, motor.damping};
  } else {
    motor = {velocity, -spare, max_force + friction, motor.damping};
  }
}

void ArticulatedWorld::Release(int body, int joint) {
  LoadedJoint& entry = bullet_->Wake(body).joints.at(static_cast<size_t>(joint));
  entry.motor = {0.0, -entry.friction, entry.friction, entry.motor.damping};
}

void ArticulatedWorld::LimitMimic(int body, int joint, double max_force) {
  LoadedJoint& entry = bullet_->Wake(body).joints.at(static_cast<size_t>(joint));
  entry.gear_force = max_force;
  if (entry.gear) entry.gear->setMaxAppliedImpulse(max_force * options_.time_step);
}

void ArticulatedWorld::Push(int body, int joint, double force) {
  LoadedTree& loaded = bullet_->Wake(body);
  loaded.multi->addJointTorque(loaded.Joint(joint), force);
}

void ArticulatedWorld::PushRoot(int body, const Eigen::Vector3d& force) {
  bullet_->Wake(body).multi->addBaseForce(ToBullet(force));
}

void ArticulatedWorld::SetIterations(int iterations) {
  if (iterations < 1) throw core::Error("a world needs at least one solver iteration");
  bullet_->world->getSolverInfo().m_numIterations = iterations;
}

void ArticulatedWorld::Step() {
  bullet_->Step(options_.time_step);
  time_ += options_.time_step;
}

double ArticulatedWorld::Position(int body, int joint) const {
  const LoadedTree& loaded = bullet_->Body(body);
  return loaded.multi->getJointPos(loaded.Joint(joint));
}

double ArticulatedWorld::Velocity(int body, int joint) const {
  const LoadedTree& loaded = bullet_->Body(body);
  return loaded.multi->getJointVel(loaded.Joint(joint));
}

Eigen::Isometry3d ArticulatedWorld::LinkPose(int body, int link) const {
  const LoadedTree& loaded = bullet_->Body(body);
  const auto pose = [&](int i) -> Eigen::Isometry3d {
    return FromBullet(loaded.Collider(i)->getWorldTransform()) *
           loaded.Shape(i).body_from_principal().inverse();
  };
  if (loaded.Collider(link) != nullptr) return pose(link);
  const TreeLink& place = loaded.tree->links[static_cast<size_t>(link)];
  return pose(place.carrier) * place.carrier_from_link;
}

std::vector<LinkContact> ArticulatedWorld::Contacts() const {
  std::vector<LinkContact> contacts;
  Contacts(&contacts);
  return contacts;
}

void ArticulatedWorld::Contacts(std::vector<LinkContact>* contacts) const {
  contacts->clear();
  for (int i = 0; i < bullet_->dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold* manifold = bullet_->dispatcher.getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold->getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold->getContactPoint(k);
      LinkContact contact;
      contact.body_a = manifold->getBody0()->getUserIndex();
      contact.body_b = manifold->getBody1()->getUserIndex();
      contact.link_a = std::max(0, manifold->getBody0()->getUserIndex2());
      contact.link_b = std::max(0, manifold->getBody1()->getUserIndex2());
      contact.distance = point.getDistance();
      contact.impulse = point.getAppliedImpulse();
      contact.point = FromBullet(point.getPositionWorldOnB());
      contact.normal = FromBullet(point.m_normalWorldOnB);
      contacts->push_back(contact);
    }
  }
}

assets::Inertial ArticulatedWorld::LoadedInertial(int body, int link) const {
  const LoadedTree& loaded = bullet_->Body(body);
  const btMultiBody& multi = *loaded.multi;
  const TreeLink& place = loaded.tree->links.at(static_cast<size_t>(link));
  assets::Inertial inertial;
  if (place.carrier != link) return inertial;
  const bool root = place.bullet < 0;
  inertial.mass = root ? multi.getBaseMass() : multi.getLinkMass(place.bullet);
  const Eigen::Vector3d moments =
      FromBullet(root ? multi.getBaseInertia() : multi.getLinkInertia(place.bullet));
  const Eigen::Isometry3d& principal = place.link_from_principal;
  inertial.center_of_mass = principal.translation();
  inertial.inertia = principal.linear() * moments.asDiagonal() * principal.linear().transpose();
  return inertial;
}

}  // namespace simwright::sim
