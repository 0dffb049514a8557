// Articulated bodies against analytic mechanics, and Bullet against MuJoCo.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "assets/articulated_folder.h"
#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "core/files.h"
#include "geometry/mass_properties.h"
#include "sim/articulated_world.h"
#include "sim/joint_experiments.h"
#include "sim/joint_rig.h"

namespace simwright::sim {
namespace {

using assets::JointType;

assets::ArticulatedLink BoxLink(const std::string& name, const Eigen::Vector3d& size,
                                const Eigen::Vector3d& center, double density) {
  assets::ArticulatedLink link;
  link.name = name;
  link.label = name;
  link.material = "wood";
  core::TriangleMesh mesh = assets::BoxMesh(size);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(center)), &mesh);
  const auto properties = geometry::SolidMassProperties(mesh, density);
  link.inertial = {properties.mass, properties.center_of_mass, properties.inertia};
  link.volume = properties.volume;
  link.densities = {density};
  link.visual.mesh = mesh;
  link.visual.triangle_material.assign(mesh.triangles.size(), 0);
  link.visual.materials = {{"wood", {0.7f, 0.5f, 0.3f, 1.0f}, -1}};
  link.parts = {mesh};
  return link;
}

// Returns a heavy base and one link on one joint, 0.5 m above the base's middle.
assets::ArticulatedAsset OneJoint(JointType type, const Eigen::Vector3d& axis,
                                  const Eigen::Vector3d& center, double friction, double damping) {
  assets::ArticulatedAsset asset;
  asset.name = "rig";
  asset.fixed = true;
  asset.links = {BoxLink("base", {0.2, 0.2, 0.1}, {0, 0, 0.05}, 2000.0),
                 BoxLink("arm", {0.04, 0.06, 0.5}, center, 800.0)};
  assets::Joint joint;
  joint.name = "arm_joint";
  joint.parent = "base";
  joint.child = "arm";
  joint.type = type;
  joint.axis = axis;
  joint.parent_from_joint.translation() = Eigen::Vector3d(0.0, 0.3, 0.8);
  // Rotated, so that axes and frames differ.
  joint.parent_from_joint.linear() =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  joint.lower = -3.0;
  joint.upper = 3.0;
  joint.friction = friction;
  joint.damping = damping;
  asset.joints = {joint};
  return asset;
}

struct Rigs {
  explicit Rigs(const assets::ArticulatedAsset& asset)
      : body(ArticulatedBodyFrom(assets::ModelOf(asset))) {
    assets::WriteArticulatedAsset(asset, folder.path());
    bullet = BulletRig(body);
    mujoco = MujocoRig(body, folder.path() / (asset.name + ".xml"));
  }
  core::TemporaryFolder folder;
  ArticulatedBody body;
  std::unique_ptr<JointRig> bullet, mujoco;
};

// Strong fingers can force a small knob past its stop.
TEST(Articulated, AJointFarBeyondItsLimitReturns) {
  const ArticulatedBody body = ArticulatedBodyFrom(assets::ModelOf(
      OneJoint(JointType::kRevolute, Eigen::Vector3d::UnitZ(), {0.1, 0, 0}, 0.0, 0.5)));
  ArticulatedWorld world;
  const int arm = world.Add(body);
  world.SetPosition(arm, 0, 3.5);
  double fastest = 0.0;  // rad/s
  for (int i = 0; i < 240; ++i) {
    world.Step();
    fastest = std::max(fastest, std::abs(world.Velocity(arm, 0)));
  }
  EXPECT_LT(world.Position(arm, 0), 3.01);
  EXPECT_GT(world.Position(arm, 0), 2.5);
  EXPECT_LT(fastest, 2.0);
}

// The first step after a reset does not depend on the motion before it.
TEST(Articulated, AJointThatIsSetForgetsItsMotor) {
  const ArticulatedBody body = ArticulatedBodyFrom(assets::ModelOf(
      OneJoint(JointType::kRevolute, Eigen::Vector3d::UnitY(), {0, 0, -0.25}, 0.2, 0.1)));
  ArticulatedWorld fresh, used;
  for (ArticulatedWorld* world : {&fresh, &used}) world->Add(body);
  for (int i = 0; i < 60; ++i) {
    used.Drive(0, 0, 2.0, 30.0);
    used.Step();
  }
  used.Release(0, 0);
  for (ArticulatedWorld* world : {&fresh, &used}) {
    world->SetPosition(0, 0, 0.4);
    world->SetIterations(1);
    world->Step();
  }
  EXPECT_EQ(used.Position(0, 0), fresh.Position(0, 0));
  EXPECT_EQ(used.Velocity(0, 0), fresh.Velocity(0, 0));
}

TEST(Articulated, AJointThatMimicsAFixedOneIsRefused) {
  assets::ArticulatedAsset asset =
      OneJoint(JointType::kRevolute, Eigen::Vector3d::UnitY(), {0, 0, -0.25}, 0.0, 0.0);
  asset.links.push_back(BoxLink("hand", {0.05, 0.05, 0.05}, {0, 0, 0}, 800.0));
  assets::Joint fixed;
  fixed.name = "hand_joint";
  fixed.parent = "arm";
  fixed.child = "hand";
  fixed.type = JointType::kFixed;
  asset.joints.push_back(fixed);
  asset.joints.front().mimic = assets::JointMimic{"hand_joint", 1.0, 0.0};
  const ArticulatedBody body = ArticulatedBodyFrom(assets::ModelOf(asset));
  ArticulatedWorld world;
  try {
    world.Add(body);
    FAIL() << "was accepted";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("hand_joint"), std::string::npos);
  }
}

// T = 2 pi sqrt(I / (m g l)) for small swings about the pivot.
TEST(Articulated, APendulumSwingsWithItsPeriodInBothEngines) {
  Rigs rigs(OneJoint(JointType::kRevolute, Eigen::Vector3d::UnitY(), {0, 0, -0.25}, 0.0, 0.0));
  const double l = 0.25;
  const double moment = (0.04 * 0.04 + 0.5 * 0.5) / 12.0 + l * l;  // per kg, about the pivot
  const double period = 2.0 * M_PI * std::sqrt(moment / (9.81 * l));
  for (JointRig* rig : {rigs.bullet.get(), rigs.mujoco.get()}) {
    rig->SetPosition(0, 0.05);
    std::vector<double> crossings;  // of zero, downwards
    double before = rig->Position(0), before_time = rig->time();
    while (rig->time() < 6.0) {
      rig->Step();
      const double now = rig->Position(0);
      if (before > 0.0 && now <= 0.0) {
        crossings.push_back(before_time + (rig->time() - before_time) * before / (before - now));
      }
      before = now;
      before_time = rig->time();
    }
    ASSERT_GE(crossings.size(), 4u);
    const double measured = (crossings.back() - crossings.front()) / (crossings.size() - 1.0);
    EXPECT_NEAR(measured, period, 0.005 * period);
  }
}

// Under a constant force F against friction f and damping d a slider approaches (F - f) / d as 1 -
// exp(-d t / m).
TEST(Articulated, APushedDrawerApproachesItsTerminalSpeed) {
  const double friction = 2.0, damping = 6.0, force = 5.0;
  const assets::ArticulatedAsset asset =
      OneJoint(JointType::kPrismatic, Eigen::Vector3d::UnitX(), {0, 0, 0}, friction, damping);
  ArticulatedWorld world;
  const int index = world.Add(ArticulatedBodyFrom(assets::ModelOf(asset)));
  const double mass = asset.links[1].inertial.mass;
  while (world.time() < 0.5) {
    world.Push(index, 0, force);
    world.Step();
    const double expected =
        (force - friction) / damping * (1.0 - std::exp(-damping * world.time() / mass));
    ASSERT_NEAR(world.Velocity(index, 0), expected, 0.012) << world.time();
  }
}

TEST(Articulated, FrictionHoldsBelowItselfAndNotAbove) {
  // The gravity moment about the pivot with the arm level: m g l.
  const double density = 800.0, mass = 0.04 * 0.06 * 0.5 * density, moment = mass * 9.81 * 0.25;
  for (const double share : {0.9, 1.1}) {
    Rigs rigs(OneJoint(JointType::kRevolute, Eigen::Vector3d::UnitY(), {0, 0, -0.25},
                       share * moment, 0.01));
    for (JointRig* rig : {rigs.bullet.get(), rigs.mujoco.get()}) {
      const double drift = DriftAfterRelease(rigs.body, 0, 0.5 * M_PI, 1.0, rig);
      if (share > 1.0) {
        EXPECT_LT(drift, 1e-4);
      } else {
        EXPECT_GT(drift, 0.05);
      }
    }
  }
}

TEST(Articulated, BothEnginesSwingAlike) {
  Rigs rigs(OneJoint(JointType::kRevolute, Eigen::Vector3d(1, 2, 0.5).normalized(),
                     {0.05, 0.02, -0.2}, 0.02, 0.05));
  for (JointRig* rig : {rigs.bullet.get(), rigs.mujoco.get()}) rig->SetPosition(0, 0.8);
  while (rigs.bullet->time() < 1.0) rigs.bullet->Step();
  while (rigs.mujoco->time() < rigs.bullet->time()) rigs.mujoco->Step();
  EXPECT_NEAR(rigs.bullet->Position(0), rigs.mujoco->Position(0), 0.02);
  const Eigen::Isometry3d a = rigs.bullet->LinkPose(1), b = rigs.mujoco->LinkPose(1);
  EXPECT_LT((a.translation() - b.translation()).norm(), 0.02);
  for (int link = 0; link < 2; ++link) {
    const assets::Inertial x = rigs.bullet->LoadedInertial(link);
    const assets::Inertial y = rigs.mujoco->LoadedInertial(link);
    EXPECT_NEAR(x.mass, y.mass, 1e-9 * y.mass);
    EXPECT_LT((x.inertia - y.inertia).norm(), 1e-6 * y.inertia.norm());
  }
}

TEST(Articulated, MotorsHoldTheirSpeedAndStopAtLimits) {
  Rigs rigs(OneJoint(JointType::kPrismatic, Eigen::Vector3d::UnitX(), {0, 0, 0}, 3.0, 1.0));
  for (JointRig* rig : {rigs.bullet.get(), rigs.mujoco.get()}) {
    rig->SetPosition(0, -1.0);
    rig->Drive(0, 0.5, 60.0);
    for (const double start = rig->time(); rig->time() - start < 2.0;) rig->Step();
    EXPECT_NEAR(rig->Velocity(0), 0.5, 0.005);
    EXPECT_NEAR(rig->Position(0), 0.0, 0.035);  // 2 s at 0.5 m/s, less MuJoCo's 0.1 s of start
    rig->Release(0);
    rig->SetPosition(0, 2.95);
    rig->Drive(0, 0.5, 60.0);
    for (const double start = rig->time(); rig->time() - start < 1.0;) rig->Step();
    EXPECT_NEAR(rig->Position(0), 3.0, 0.003);
    rig->Release(0);
  }
}

// A box slides down onto the floor beside a fixed body, and its weight appears in the contacts.
TEST(Articulated, ARigidThingRestsInTheSameWorld) {
  ArticulatedWorld world;
  const assets::ArticulatedAsset asset =
      OneJoint(JointType::kRevolute, Eigen::Vector3d::UnitY(), {0, 0, -0.25}, 1.0, 0.1);
  world.Add(ArticulatedBodyFrom(assets::ModelOf(asset)));
  RigidBody box;
  box.name = "box";
  box.parts = {assets::BoxMesh({0.1, 0.1, 0.1})};
  box.inertial = {0.5, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity() * 0.5 * 0.01 / 6.0};
  const int index = world.Add(box, Eigen::Isometry3d(Eigen::Translation3d(1.0, 0.0, 0.06)));
  while (world.time() < 1.0) world.Step();
  EXPECT_NEAR(world.LinkPose(index, 0).translation().z(), 0.05, 3e-4);
  double impulse = 0.0;
  for (const LinkContact& contact : world.Contacts()) {
    EXPECT_TRUE(contact.body_a == index || contact.body_b == index);
    impulse += contact.impulse;
  }
  EXPECT_NEAR(impulse, 0.5 * 9.81 / 240.0, 1e-4);
}

TEST(Articulated, AMovingLinkWithoutMassIsRefused) {
  assets::UrdfModel model = assets::ModelOf(
      OneJoint(JointType::kRevolute, Eigen::Vector3d::UnitY(), {0, 0, -0.25}, 0.0, 0.0));
  model.links[1].inertial.reset();
  EXPECT_THROW(ArticulatedBodyFrom(model), core::Error);
}

}  // namespace
}  // namespace simwright::sim
