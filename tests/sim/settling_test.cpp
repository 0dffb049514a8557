// Settling of scenes: what rests, what slides as far as Coulomb's law says, what falls.
#include "sim/settling.h"

#include <cmath>

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "geometry/convex_hull.h"

namespace simwright::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

RigidBody SettlingBox(const Vector3d& size, double mass, double friction = 0.5) {
  RigidBody body;
  body.name = "box";
  body.parts = {assets::BoxMesh(size)};
  body.friction = friction;
  const Vector3d s2 = size.cwiseAbs2();
  body.inertial = {
      mass, Vector3d::Zero(),
      (mass / 12.0 * Vector3d(s2.y() + s2.z(), s2.x() + s2.z(), s2.x() + s2.y())).asDiagonal()};
  return body;
}

Isometry3d At(const Vector3d& place) {
  return Isometry3d(Eigen::Translation3d(place));
}

TEST(Settle, ATowerOnATableStandsStill) {
  const RigidBody table = SettlingBox({1, 1, 0.1}, 0.0), box = SettlingBox({0.1, 0.1, 0.06}, 0.3);
  std::vector<SettlingBody> bodies = {{&table, At({0, 0, 0.5}), true}};
  for (int i = 0; i < 5; ++i) bodies.push_back({&box, At({0.2, 0, 0.58 + 0.06 * i}), false});
  const std::vector<SettledBody> settled = Settle(bodies);
  for (size_t i = 0; i < settled.size(); ++i) {
    EXPECT_TRUE(settled[i].stable) << i << " " << settled[i].drift;
    EXPECT_FALSE(settled[i].fell);
    EXPECT_LT(settled[i].moved, 1e-3) << i;
    EXPECT_LT(settled[i].tilted, 1e-3) << i;
  }
  EXPECT_EQ(settled[0].world_from_body.matrix(), bodies[0].world_from_body.matrix());
}

// Returns a box whose edges are chamfered by 2 mm, like a board game's: a hull of 24 vertices.
RigidBody ChamferedBox(const Vector3d& size, double mass) {
  RigidBody body = SettlingBox(size, mass);
  std::vector<Vector3d> corners;
  for (const Vector3d& corner : assets::BoxMesh(size).vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d inward = 0.002 * (Vector3d::Ones() - Vector3d::Unit(axis));
      corners.emplace_back(corner - inward.cwiseProduct(corner.cwiseSign()));
    }
  }
  body.parts = {geometry::ConvexHull(corners)};
  return body;
}

// Ten stacks of boxes of different sizes, each rotated against its support, over 6 s, as on a
// shelf. With single-point contacts half of them creep, by up to some millimetres.
TEST(Settle, WhatLiesFlatDoesNotCreep) {
  const RigidBody board = SettlingBox({8, 1, 0.02}, 0.0, 0.6);
  const RigidBody low = ChamferedBox({0.26, 0.26, 0.07}, 1.1),
                  high = ChamferedBox({0.18, 0.12, 0.05}, 0.4);
  std::vector<SettlingBody> bodies = {{&board, At({0, 0, 0.5}), true}};
  for (int stack = 0; stack < 10; ++stack) {
    double z = 0.51;
    for (int i = 0; i < 4; ++i) {
      const bool is_low = i < 2;
      const double height = is_low ? 0.07 : 0.05;
      const Vector3d place(0.6 * stack - 2.7 + 0.004 * i, 0.003 * stack, z + 0.5 * height + 2e-5);
      const double yaw = 0.1 * stack + 0.13 * i * (1 + stack % 3);
      bodies.push_back(
          {is_low ? &low : &high, At(place) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ()), false});
      z += height + 2e-5;
    }
  }
  SettlingOptions options;
  options.rest_tolerance = options.early_stop_factor = 0.0;
  options.duration = 2.0;
  options.watch = 4.0;
  const std::vector<SettledBody> settled = Settle(bodies, options);
  for (size_t i = 1; i < settled.size(); ++i) {
    EXPECT_LT(settled[i].moved, 2e-4) << i;
    EXPECT_LT(settled[i].drift, 2e-4) << i;
  }
}

TEST(Settle, WhatHangsOverTheEdgeFalls) {
  const RigidBody table = SettlingBox({1, 1, 0.1}, 0.0), box = SettlingBox({0.1, 0.1, 0.06}, 0.3);
  // Its middle is 1 cm outside, another's 1 cm inside.
  const std::vector<SettledBody> settled = Settle({{&table, At({0, 0, 0.5}), true},
                                                   {&box, At({0.51, 0.2, 0.581}), false},
                                                   {&box, At({0.49, -0.2, 0.581}), false}});
  EXPECT_TRUE(settled[1].fell);
  EXPECT_FALSE(settled[1].stable);
  EXPECT_FALSE(settled[2].fell);
  EXPECT_TRUE(settled[2].stable);
}

// A fallen object is removed before it can topple objects below.
TEST(Settle, WhatFallsKnocksNothingDown) {
  const RigidBody table = SettlingBox({1, 1, 0.1}, 0.0), box = SettlingBox({0.1, 0.1, 0.06}, 0.3);
  const RigidBody post = SettlingBox({0.03, 0.03, 0.2}, 0.1);
  const std::vector<SettlingBody> bodies = {{&table, At({0, 0, 0.5}), true},
                                            {&box, At({0.52, 0.2, 0.581}), false},
                                            {&post, At({0.56, 0.2, 0.1}), false}};
  SettlingOptions whole;
  whole.rest_tolerance = whole.early_stop_factor = 0.0;
  EXPECT_GT(Settle(bodies, whole)[2].tilted, 1.0);
  const std::vector<SettledBody> settled = Settle(bodies);
  EXPECT_TRUE(settled[1].fell);
  EXPECT_LT(settled[2].tilted, 0.01);
  EXPECT_TRUE(settled[2].stable);
}

// On a slope of 20 degrees, tan 0.364: a friction of 0.5 holds, without friction it slides.
TEST(Settle, WhatSlidesIsNotStable) {
  const Isometry3d slope =
      At({0, 0, 5}) * Eigen::AngleAxisd(20.0 * M_PI / 180.0, Vector3d::UnitY());
  const RigidBody plank = SettlingBox({4, 1, 0.1}, 0.0, 1.0);
  const RigidBody rough = SettlingBox({0.1, 0.1, 0.04}, 0.3, 0.5),
                  smooth = SettlingBox({0.1, 0.1, 0.04}, 0.3, 0.0);
  SettlingOptions options;
  options.duration = 0.5;
  options.watch = 0.5;
  options.rest_tolerance = options.early_stop_factor = 0.0;  // to the end
  const std::vector<SettledBody> settled = Settle({{&plank, slope, true},
                                                   {&rough, slope * At({-1, 0.2, 0.07}), false},
                                                   {&smooth, slope * At({-1, -0.2, 0.07}), false}},
                                                  options);
  EXPECT_TRUE(settled[1].stable);
  EXPECT_FALSE(settled[2].stable);
  // s = g sin(20) t^2 / 2.
  const double a = 9.81 * std::sin(20.0 * M_PI / 180.0);
  EXPECT_NEAR(settled[2].moved, 0.5 * a * 0.25, 0.005);
  EXPECT_NEAR(settled[2].drift, 0.5 * a * 0.25, 0.005);  // the check starts at zero velocity
  // With 0.6 of its friction the rough one slides for that half second too, and then holds.
  options.settling_friction = 0.6;
  const std::vector<SettledBody> eased =
      Settle({{&plank, slope, true}, {&rough, slope * At({-1, 0.2, 0.07}), false}}, options);
  const double slower = a - 0.3 * 9.81 * std::cos(20.0 * M_PI / 180.0);
  EXPECT_NEAR(eased[1].moved, 0.5 * slower * 0.25, 0.005);
  EXPECT_TRUE(eased[1].stable);
}

// A thin slab on its edge is stable unless gravity tilts; a box is stable either way.
TEST(Settle, WhatBalancesTipsInASway) {
  const RigidBody slab = SettlingBox({0.002, 0.1, 0.2}, 0.1),
                  box = SettlingBox({0.1, 0.1, 0.1}, 0.3);
  const std::vector<SettlingBody> bodies = {{&slab, At({0, 0, 0.1}), false},
                                            {&box, At({0.5, 0, 0.05}), false}};
  SettlingOptions options;
  EXPECT_LT(Settle(bodies, options)[0].tilted, 1e-3);
  options.gravity_tilt = 0.1;
  options.gravity_tilt_time = 0.2;
  const std::vector<SettledBody> swayed = Settle(bodies, options);
  EXPECT_GT(swayed[0].tilted, 1.0);  // until it was removed
  EXPECT_LT(swayed[1].moved, 1e-4);
  EXPECT_TRUE(swayed[1].stable);
}

TEST(Settle, IsTheSameEveryTime) {
  const RigidBody box = SettlingBox({0.1, 0.1, 0.06}, 0.3);
  const std::vector<SettlingBody> bodies = {{&box, At({0, 0, 0.1}), false},
                                            {&box, At({0.06, 0.03, 0.2}), false}};
  const auto one = Settle(bodies), two = Settle(bodies);
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].world_from_body.matrix(), two[i].world_from_body.matrix());
  }
}

TEST(Settle, RefusesWhatIsNotSound) {
  const RigidBody box = SettlingBox({0.1, 0.1, 0.06}, 0.3),
                  no_mass = SettlingBox({0.1, 0.1, 0.06}, 0.0);
  EXPECT_TRUE(Settle({}).empty());
  EXPECT_THROW(Settle({{}}), core::Error);
  EXPECT_THROW(Settle({{&no_mass, At({0, 0, 1}), false}}), core::Error);
  EXPECT_THROW(Settle({{&box, At({0, 0, std::nan("")}), false}}), core::Error);
  SettlingOptions options;
  options.gravity_tilt = -0.1;
  EXPECT_THROW(Settle({{&box, At({0, 0, 1}), false}}, options), core::Error);
  options.gravity_tilt = 0.0;
  options.settling_friction = -1.0;
  EXPECT_THROW(Settle({{&box, At({0, 0, 1}), false}}, options), core::Error);
  options.settling_friction = 1.0;
  options.time_step = 0.0;
  EXPECT_THROW(Settle({{&box, At({0, 0, 1}), false}}, options), core::Error);
}

}  // namespace
}  // namespace simwright::sim
