// Depenetration against closed forms, isotonic regression and small displacements that gain
// nothing.
#include "scene/feasibility/depenetration.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "tests/scene/convex_parts.h"

namespace simwright::scene {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::ConvexShape;

// Returns four walls, 2 cm thick, around a hole.
std::vector<ConvexShape> Frame(double outer, double high) {
  const double wall = 0.02, middle = 0.5 * (outer - wall);
  return {Box({wall, outer, high}, {middle, 0, 0}), Box({wall, outer, high}, {-middle, 0, 0}),
          Box({outer, wall, high}, {0, middle, 0}), Box({outer, wall, high}, {0, -middle, 0})};
}

// Bodies that own their parts.
struct Things {
  std::vector<std::vector<ConvexShape>> parts;
  std::vector<Isometry3d> poses;
  std::vector<bool> fixed;

  void Add(std::vector<ConvexShape> shape, const Vector3d& place, bool is_fixed = false,
           const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
    parts.push_back(std::move(shape));
    Isometry3d pose = Isometry3d::Identity();
    pose.translation() = place;
    pose.linear() = turn;
    poses.push_back(pose);
    fixed.push_back(is_fixed);
  }
  Projection Apart(const DepenetrationOptions& options = {}) const {
    std::vector<ProjectedBody> bodies;
    for (size_t i = 0; i < parts.size(); ++i) bodies.push_back({&parts[i], poses[i], fixed[i]});
    return ResolvePenetrations(bodies, options);
  }
  // Returns the distance of two displaced bodies, m.
  double Distance(size_t a, size_t b, const std::vector<Vector3d>& shifts) const {
    double least = 1e9;
    const Isometry3d at_a = Eigen::Translation3d(shifts[a]) * poses[a];
    const Isometry3d at_b = Eigen::Translation3d(shifts[b]) * poses[b];
    for (const ConvexShape& one : parts[a]) {
      for (const ConvexShape& other : parts[b]) {
        least = std::min(least, geometry::SignedDistance(one, at_a, other, at_b).distance);
      }
    }
    return least;
  }
  double Closest(const std::vector<Vector3d>& shifts) const {
    double least = 1e9;
    for (size_t a = 0; a < parts.size(); ++a) {
      for (size_t b = a + 1; b < parts.size(); ++b) {
        if (!fixed[a] || !fixed[b]) least = std::min(least, Distance(a, b, shifts));
      }
    }
    return least;
  }
};

// Returns the isotonic regression of `values` (Ayer et al. 1955: adjacent violators are pooled).
std::vector<double> Isotonic(const std::vector<double>& values) {
  std::vector<std::pair<double, int>> pools;  // sum and count
  for (const double value : values) {
    pools.emplace_back(value, 1);
    while (pools.size() > 1) {
      auto& [last_sum, last_count] = pools.back();
      auto& [sum, count] = pools[pools.size() - 2];
      if (sum * last_count <= last_sum * count) break;
      sum += last_sum;
      count += last_count;
      pools.pop_back();
    }
  }
  std::vector<double> result;
  for (const auto& [sum, count] : pools) result.insert(result.end(), count, sum / count);
  return result;
}

TEST(ResolvePenetrations, TwoThatOverlapShareTheWay) {
  Things objects;
  objects.Add({Box({0.1, 0.2, 0.2})}, {0, 0, 0});
  objects.Add({Box({0.1, 0.2, 0.2})}, {0.08, 0.01, 0});
  const Projection result = objects.Apart();
  EXPECT_TRUE(result.feasible);
  EXPECT_LT((result.shifts[0] - Vector3d(-0.01, 0, 0)).norm(), 1e-6);
  EXPECT_LT((result.shifts[1] - Vector3d(0.01, 0, 0)).norm(), 1e-6);
  EXPECT_NEAR(result.cost, 2e-4, 1e-8);
}

TEST(ResolvePenetrations, FurnitureStaysAndOthersGoAllTheWay) {
  Things objects;
  objects.Add({Box({2, 2, 0.1})}, {0, 0, -0.05}, true);
  objects.Add({Box({0.3, 0.3, 0.3})}, {0.5, 0, -0.03}, true);  // in other furniture, which is
                                                               // allowed
  objects.Add({Box({0.1, 0.1, 0.1})}, {0, 0, 0.043});
  objects.Add({Ball(0.05)}, {0, 0.5, 0.2});  // apart
  const Projection result = objects.Apart();
  EXPECT_TRUE(result.feasible);
  EXPECT_EQ(result.shifts[0], Vector3d::Zero());
  EXPECT_EQ(result.shifts[1], Vector3d::Zero());
  EXPECT_LT((result.shifts[2] - Vector3d(0, 0, 0.007)).norm(), 1e-6);
  EXPECT_EQ(result.shifts[3], Vector3d::Zero());
}

// Boxes in a row are an isotonic regression after subtracting their widths.
TEST(ResolvePenetrations, ARowIsTheIsotonicRegression) {
  core::Rng rng = core::StreamRng(7, 0);
  for (int round = 0; round < 20; ++round) {
    Things objects;
    std::vector<double> wished;
    double place = 0.0, taken = 0.0;
    for (int i = 0; i < 8; ++i) {
      const double wide = core::Uniform(rng, 0.02, 0.06);
      place += core::Uniform(rng, 0.01, 0.07);
      objects.Add({Box({wide, 1.0, 1.0})}, {place, 0, 0});
      wished.push_back(place - (taken + 0.5 * wide));
      taken += wide;
    }
    const std::vector<double> truth = Isotonic(wished);
    const Projection result = objects.Apart();
    EXPECT_TRUE(result.feasible);
    for (size_t i = 0; i < truth.size(); ++i) {
      EXPECT_NEAR(result.shifts[i].x(), truth[i] - wished[i], 1e-5) << round << " " << i;
      EXPECT_NEAR(result.shifts[i].y(), 0.0, 1e-9);
    }
  }
}

// The result is a local optimum: no small allowed displacement improves it.
TEST(ResolvePenetrations, NoSmallMoveThatIsAllowedIsNearer) {
  core::Rng rng = core::StreamRng(3, 0);
  Things objects;
  for (int i = 0; i < 5; ++i) {
    objects.Add({Ball(0.05)}, {core::Uniform(rng, 0, 0.12), core::Uniform(rng, 0, 0.12),
                               core::Uniform(rng, 0, 0.12)});
  }
  const Projection result = objects.Apart();
  ASSERT_TRUE(result.feasible);
  ASSERT_GT(result.cost, 1e-3);
  int allowed = 0;
  for (int k = 0; k < 20000; ++k) {
    std::vector<Vector3d> moved = result.shifts;
    double cost = 0.0;
    for (Vector3d& shift : moved) {
      shift += 1e-3 * Vector3d(core::Uniform(rng, -1, 1), core::Uniform(rng, -1, 1),
                               core::Uniform(rng, -1, 1));
      cost += shift.squaredNorm();
    }
    if (objects.Closest(moved) < 0.0) continue;
    ++allowed;
    EXPECT_GT(cost, result.cost - 1e-5);
  }
  EXPECT_GT(allowed, 20);
}

TEST(ResolvePenetrations, AHeapIsApartAndWhatTouchesTouches) {
  core::Rng rng = core::StreamRng(5, 0);
  Things objects;
  objects.Add({Box({2, 2, 0.1})}, {0, 0, -0.05}, true);
  for (int i = 0; i < 34; ++i) {
    const Vector3d size(core::Uniform(rng, 0.03, 0.12), core::Uniform(rng, 0.03, 0.12),
                        core::Uniform(rng, 0.03, 0.12));
    const Vector3d place(core::Uniform(rng, -0.25, 0.25), core::Uniform(rng, -0.25, 0.25),
                         core::Uniform(rng, 0.0, 0.15));
    objects.Add({Box(size)}, place, false,
                Eigen::AngleAxisd(core::Uniform(rng, 0, 3), Vector3d(1, 2, 3).normalized())
                    .toRotationMatrix());
  }
  const Projection result = objects.Apart();
  EXPECT_TRUE(result.feasible);
  EXPECT_LE(result.rounds, 40);
  for (size_t a = 1; a < objects.parts.size(); ++a) {
    double nearest = 1e9;
    for (size_t b = 0; b < objects.parts.size(); ++b) {
      if (a != b) nearest = std::min(nearest, objects.Distance(a, b, result.shifts));
    }
    EXPECT_GT(nearest, -1e-4);
    if (result.shifts[a].norm() > 1e-3) {
      EXPECT_LT(nearest, 1e-4) << a;  // bodies without contact do not move
    }
  }
}

// Walls of two frames that pass through each other give contradictory normals.
TEST(ResolvePenetrations, HollowThingsThatAreThroughEachOtherComeApart) {
  Things objects;
  objects.Add(Frame(0.2, 0.1), {0, 0, 0});
  objects.Add(Frame(0.2, 0.1), {0.07, 0.05, 0.02});
  const Projection result = objects.Apart();
  EXPECT_TRUE(result.feasible);
  EXPECT_GT(objects.Distance(0, 1, result.shifts), -1e-4);
}

TEST(ResolvePenetrations, AThingInAHollowOneStaysThere) {
  Things objects;
  objects.Add(Frame(0.2, 0.1), {0, 0, 0});
  objects.Add({Ball(0.03)}, {0.06, 0, 0});
  const Projection result = objects.Apart();
  EXPECT_TRUE(result.feasible);
  // The wall's inner side is at 8 cm, the ball reaches to 9: both move by half.
  EXPECT_LT((result.shifts[0] - Vector3d(0.005, 0, 0)).norm(), 1e-5);
  EXPECT_LT((result.shifts[1] - Vector3d(-0.005, 0, 0)).norm(), 1e-5);
}

// A ball larger than the hole can only leave the frame, by its hull.
TEST(ResolvePenetrations, WhatDoesNotFitIntoAHollowThingLeavesIt) {
  Things objects;
  objects.Add(Frame(0.2, 0.1), {0, 0, 0}, true);
  objects.Add({Ball(0.09)}, {0, 0, 0.03});  // 8 cm to the walls
  const Projection result = objects.Apart();
  EXPECT_TRUE(result.feasible);
  EXPECT_LT((result.shifts[1] - Vector3d(0, 0, 0.11)).norm(), 1e-5);  // on the rim's plane
}

// Up is the direction of least penetration, and boards leave no space for it.
TEST(ResolvePenetrations, BetweenBoardsWhatCannotRiseGoesAside) {
  Things objects;
  objects.Add({Box({1, 1, 0.02})}, {0, 0, -0.01}, true);
  objects.Add({Box({1, 1, 0.02})}, {0, 0, 0.11}, true);
  objects.Add({Box({0.12, 0.5, 0.06})}, {0, 0, 0.03});
  objects.Add({Box({0.12, 0.5, 0.06})}, {0.02, 0, 0.07});  // 0.02 m deep in it, 0.1 m to the side
  const Projection result = objects.Apart();
  EXPECT_TRUE(result.feasible);
  EXPECT_NEAR(result.shifts[2].x(), -0.05, 1e-3);
  EXPECT_NEAR(result.shifts[3].x(), 0.05, 1e-3);
  EXPECT_NEAR(result.shifts[2].z(), 0.0, 1e-3);
  EXPECT_NEAR(result.shifts[3].z(), 0.0, 1e-3);
}

TEST(ResolvePenetrations, WhereThereIsNoRoomTheLeastBadIsNamed) {
  Things objects;
  objects.Add({Box({0.1, 1, 1})}, {-0.09, 0, 0}, true);
  objects.Add({Box({0.1, 1, 1})}, {0.09, 0, 0}, true);
  objects.Add({Box({0.1, 0.1, 0.1})}, {0.004, 0, 0});
  const Projection result = objects.Apart();
  EXPECT_FALSE(result.feasible);
  ASSERT_EQ(result.overlaps.size(), 2u);
  for (const Overlap& overlap : result.overlaps) {
    EXPECT_EQ(overlap.b, 2);
    EXPECT_NEAR(overlap.depth, 0.01, 1e-4);
  }
  EXPECT_NEAR(result.shifts[2].x(), -0.004, 1e-4);
}

TEST(ResolvePenetrations, NothingIsApart) {
  const Projection none = ResolvePenetrations({});
  EXPECT_TRUE(none.feasible);
  EXPECT_TRUE(none.shifts.empty());
}

// Pairs in a grid: distant bodies cost almost nothing.
TEST(ResolvePenetrations, TenThousandThings) {
  Things objects;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d place(0.5 * (i % 71), 0.5 * (i / 71), 0.0);
    objects.Add({Box({0.1, 0.1, 0.1})}, place);
    objects.Add({Box({0.1, 0.1, 0.1})}, place + Vector3d(0.08, 0, 0));
  }
  const Projection result = objects.Apart();
  EXPECT_TRUE(result.feasible);
  EXPECT_NEAR(result.cost, 10000 * 1e-4, 1e-4);
  for (const Vector3d& shift : result.shifts) EXPECT_NEAR(std::abs(shift.x()), 0.01, 1e-6);
}

TEST(ResolvePenetrations, WhatIsNotSoundIsRefused) {
  Things objects;
  objects.Add({Ball(0.03)}, {std::nan(""), 0, 0});
  EXPECT_THROW(objects.Apart(), core::Error);
  EXPECT_THROW(ResolvePenetrations({ProjectedBody()}), core::Error);
  const std::vector<ConvexShape> none;
  EXPECT_THROW(ResolvePenetrations({{&none, Isometry3d::Identity(), false}}), core::Error);
  DepenetrationOptions options;
  options.contact_margin = 0.0;
  EXPECT_THROW(ResolvePenetrations({}, options), core::Error);
}

}  // namespace
}  // namespace simwright::scene
