#include "sim/drop_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "assets/asset_folder.h"
#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "sim/mujoco.h"
#include "sim/world.h"
#include "tests/assets/sample_asset.h"

namespace simwright::sim {
namespace {

RigidBody DropTestBox(const Eigen::Vector3d& size, double mass) {
  RigidBody body;
  body.name = "box";
  body.parts = {assets::BoxMesh(size)};
  const Eigen::Vector3d s2 = size.cwiseAbs2();
  body.inertial = {
      mass, Eigen::Vector3d::Zero(),
      (mass / 12.0 * Eigen::Vector3d(s2.y() + s2.z(), s2.x() + s2.z(), s2.x() + s2.y()))
          .asDiagonal()};
  return body;
}

TEST(World, FallsAsNewtonSays) {
  const RigidBody box = DropTestBox({0.1, 0.1, 0.1}, 1.0);
  World world;
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.translation().z() = 10.0;
  world.Add(box, start);
  for (int i = 0; i < 240; ++i) world.Step();
  // Semi-implicit Euler: z = z0 - g t (t + dt) / 2.
  EXPECT_NEAR(world.Pose(0).translation().z(), 10.0 - 0.5 * 9.81 * (1.0 + 1.0 / 240.0), 1e-9);
  EXPECT_NEAR(world.LinearVelocity(0).z(), -9.81, 1e-9);
}

// It falls at 24 m/s, 10 cm per step: more than the height of the floor's AABB.
TEST(World, WhatIsFastDoesNotFallThroughTheFloor) {
  const RigidBody box = DropTestBox({0.1, 0.1, 0.02}, 1.0);
  WorldOptions options;
  options.floor_reach = 0.05;
  World world(options);
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.translation().z() = 30.0;
  world.Add(box, start);
  for (int i = 0; i < 5 * 240; ++i) world.Step();
  EXPECT_NEAR(world.Pose(0).translation().z(), 0.01, 2e-4);
}

TEST(World, KeepsTheInertialItWasGiven) {
  const assets::Asset asset = assets::SampleAsset();
  const RigidBody body = BodyFromAsset(asset);
  World world;
  world.Add(body, Eigen::Isometry3d::Identity());
  const assets::Inertial loaded = world.LoadedInertial(0);
  EXPECT_NEAR(loaded.mass, asset.inertial.mass, 1e-12);
  EXPECT_NEAR((loaded.inertia - asset.inertial.inertia).norm() / asset.inertial.inertia.norm(), 0.0,
              1e-12);
}

TEST(Drop, ABoxRestsOnTheFloorAndStays) {
  const DropResult drop = DropInBullet(DropTestBox({0.1, 0.08, 0.06}, 0.4));
  EXPECT_TRUE(drop.rests);
  EXPECT_LT(drop.tilt, 1e-3);
  EXPECT_LT(drop.drift, 1e-5);
  EXPECT_NEAR(drop.final_pose.translation().z(), 0.03, 2e-4);
}

TEST(Drop, ATallBoxOnItsEdgeFalls) {
  DropOptions options;
  options.start.linear() = Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const DropResult drop = DropInBullet(DropTestBox({0.05, 0.05, 0.3}, 0.4), options);
  EXPECT_TRUE(drop.rests);
  EXPECT_NEAR(drop.tilt, std::numbers::pi / 2 - 0.9, 0.02);
}

// Prescribed positions over time of a ball of 0.1 m.
class Watched : public ::testing::Test {
 protected:
  template <typename Motion>
  DropResult Watch(Motion motion) const {
    DropObserver watch(body_, DropOptions(), Eigen::Isometry3d::Identity());
    for (int i = 1; i <= 2000; ++i) {
      const double t = i * 0.002;
      watch.Observe(t, motion(t));
    }
    return watch.Finish();
  }
  static Eigen::Isometry3d At(double z, double angle = 0.0) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().z() = z;
    pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return pose;
  }
  const RigidBody body_ = DropTestBox({0.1, 0.1, 0.1}, 1.0);
};

TEST_F(Watched, RestsFromWhenItStops) {
  const DropResult slides = Watch([](double t) { return At(-0.1 * std::min(t, 0.7)); });
  EXPECT_TRUE(slides.rests);
  EXPECT_NEAR(slides.rest_time, 0.7, 0.02);
  EXPECT_NEAR(slides.drift, 0.0, 1e-12);
}

TEST_F(Watched, SpinningIsNotResting) {
  const DropResult spins = Watch([](double t) { return At(0.0, 0.5 * t); });
  EXPECT_FALSE(spins.rests);
}

// 0.02 m/s at its fastest, but never farther than 0.04 mm.
TEST_F(Watched, ATrembleTooSmallToSeeIsResting) {
  const DropResult trembles = Watch([](double t) { return At(2e-5 * std::sin(1000.0 * t)); });
  EXPECT_TRUE(trembles.rests);
  const DropResult rocks = Watch([](double t) { return At(2e-3 * std::sin(20.0 * t)); });
  EXPECT_FALSE(rocks.rests);
}

// Slower than the rest speed: it rests, and its drift shows the creep.
TEST_F(Watched, CreepShowsInTheDrift) {
  const DropResult creeps = Watch([](double t) { return At(-0.005 * t); });
  EXPECT_TRUE(creeps.rests);
  EXPECT_NEAR(creeps.drift, 0.01, 1e-9);
}

TEST(Drop, RepeatsBitForBit) {
  const RigidBody box = DropTestBox({0.1, 0.08, 0.06}, 0.4);
  const DropResult a = DropInBullet(box), b = DropInBullet(box);
  EXPECT_EQ(a.final_pose.matrix(), b.final_pose.matrix());
}

TEST(World, RefusesBodiesWithoutSubstance) {
  World world;
  RigidBody nothing;
  EXPECT_THROW(world.Add(nothing, Eigen::Isometry3d::Identity()), core::Error);
}

class Mujoco : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("simwright_mujoco_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    assets::WriteAsset(asset_, folder_);
    mjcf_ = folder_ / (asset_.name + ".xml");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  assets::Asset asset_ = assets::SampleAsset();
  std::filesystem::path folder_, mjcf_;
};

TEST_F(Mujoco, FindsTheSameInertialWithoutAWarning) {
  const MujocoWorld world(mjcf_);
  for (const std::string& warning : world.warnings()) ADD_FAILURE() << warning;
  const assets::Inertial loaded = world.LoadedInertial(0);
  EXPECT_NEAR(loaded.mass, asset_.inertial.mass, 1e-12);
  EXPECT_NEAR((loaded.center_of_mass - asset_.inertial.center_of_mass).norm(), 0.0, 1e-12);
  EXPECT_NEAR((loaded.inertia - asset_.inertial.inertia).norm() / asset_.inertial.inertia.norm(),
              0.0, 1e-12);
}

TEST_F(Mujoco, AgreesWithBulletAtRest) {
  const RigidBody body = BodyFromAsset(asset_);
  const DropResult bullet = DropInBullet(body);
  const DropResult mujoco = DropInMujoco(body, mjcf_, {}, nullptr);
  EXPECT_TRUE(mujoco.rests);
  EXPECT_LT(TiltBetween(bullet.rest_pose, mujoco.rest_pose), 0.035);
  EXPECT_NEAR(bullet.rest_pose.translation().z(), mujoco.rest_pose.translation().z(), 1e-3);
}

TEST_F(Mujoco, MissingFileIsAnError) {
  EXPECT_THROW(MujocoWorld(folder_ / "none.xml"), core::Error);
}

}  // namespace
}  // namespace simwright::sim
