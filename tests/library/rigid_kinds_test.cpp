#include "library/rigid/rigid_kinds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "geometry/mesh_validity.h"
#include "library/articulated/articulated_kinds.h"
#include "physics_params/knowledge_base.h"

namespace simwright::library {
namespace {

class EveryRigidKind : public ::testing::TestWithParam<std::string> {
 protected:
  RigidObject Make(std::uint64_t seed) const {
    return MakeRigidObject(*FindRigidKind(GetParam()), seed);
  }
};

TEST_P(EveryRigidKind, IsClosedAndOfTheSampledSize) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const RigidObject object = Make(seed);
    core::RequireValid(object.visual, GetParam());
    const geometry::MeshValidity s = geometry::Examine(object.visual.mesh);
    EXPECT_TRUE(s.closed && s.oriented && s.manifold) << geometry::Describe(s);
    EXPECT_EQ(s.degenerate_triangles, 0);
    EXPECT_GT(s.signed_volume, 0.0);
    // Only kinds with a handle or a separate head may self-intersect.
    if (s.components == 1) {
      EXPECT_EQ(s.self_intersections, 0) << seed;
    }
    const Eigen::AlignedBox3d box = core::Bounds(object.visual.mesh);
    EXPECT_LT((box.sizes() - object.size).norm(), 1e-9);
    EXPECT_NEAR(box.min().z(), 0.0, 1e-12);
    EXPECT_LT(box.center().head<2>().norm(), 1e-9);
  }
}

TEST_P(EveryRigidKind, IsAsLargeAsItsKind) {
  const physics_params::Category& row =
      *physics_params::KnowledgeBase::Shipped().FindCategory(FindRigidKind(GetParam())->category);
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const Eigen::Vector3d size = Make(seed).size;
    const physics_params::Interval* ranges[] = {&row.length, &row.width, &row.height};
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(size[axis], 0.99 * ranges[axis]->min) << axis;
      EXPECT_LE(size[axis], 1.01 * ranges[axis]->max) << axis;
    }
  }
}

// Parts that a kind defines itself: closed, convex, small, and with the extent of the visual mesh.
TEST_P(EveryRigidKind, OwnPartsAreSoundAndReachAsFar) {
  for (const std::uint64_t seed : {1, 2, 5}) {
    const RigidObject object = Make(seed);
    if (object.parts.empty()) continue;
    EXPECT_LE(object.parts.size(), 15u);
    Eigen::AlignedBox3d all;
    for (const core::TriangleMesh& part : object.parts) {
      const geometry::MeshValidity s = geometry::Examine(part);
      EXPECT_TRUE(s.IsSolid()) << geometry::Describe(s);
      EXPECT_LE(part.vertices.size(), 64u);
      for (size_t t = 0; t < part.triangles.size(); ++t) {
        const Eigen::Vector3d normal =
            core::TriangleAreaVector(part, static_cast<int>(t)).normalized();
        const Eigen::Vector3d& corner = part.vertices[static_cast<size_t>(part.triangles[t][0])];
        for (const Eigen::Vector3d& v : part.vertices) {
          ASSERT_LT(normal.dot(v - corner), 1e-6 * object.size.norm()) << "not convex";
        }
      }
      all.extend(core::Bounds(part));
    }
    EXPECT_NEAR(all.min().z(), 0.0, 1e-9);  // it stands on them
    const Eigen::AlignedBox3d box = core::Bounds(object.visual.mesh);
    EXPECT_LT((all.min() - box.min()).cwiseAbs().maxCoeff(), 0.02 * box.diagonal().norm());
    EXPECT_LT((all.max() - box.max()).cwiseAbs().maxCoeff(), 0.02 * box.diagonal().norm());
  }
}

TEST_P(EveryRigidKind, SameSeedSameThing) {
  EXPECT_EQ(Make(7).visual.mesh.vertices, Make(7).visual.mesh.vertices);
  EXPECT_NE(Make(7).visual.mesh.vertices, Make(8).visual.mesh.vertices);
}

INSTANTIATE_TEST_SUITE_P(Library, EveryRigidKind, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const RigidKind& kind : RigidKinds()) names.push_back(kind.name);
                           return names;
                         }()),
                         [](const auto& info) { return info.param; });

// Returns the greatest distance, m, from the z axis at height z.
double RadiusAt(const core::TriangleMesh& mesh, double z) {
  double radius = -1.0;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    if (std::abs(v.z() - z) < 1e-9) radius = std::max(radius, v.head<2>().norm());
  }
  return radius;
}

// Baskets stack: base and rim are level rings of the same radius, and the inside is open down to
// its floor, which is 12 mm above the base.
TEST(RigidKinds, SteamersStackAndAreHollow) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RigidObject steamer = MakeRigidObject(*FindRigidKind("steamer"), seed);
    const core::TriangleMesh& mesh = steamer.visual.mesh;
    const double high = steamer.size.z(), radius = 0.5 * steamer.size.x();
    EXPECT_NEAR(RadiusAt(mesh, 0.0), radius, 1e-9);
    EXPECT_NEAR(RadiusAt(mesh, high), radius, 1e-9);
    double inner = radius, under = high, floor = 0.0;  // of the rim, and on the axis
    for (const Eigen::Vector3d& v : mesh.vertices) {
      if (std::abs(v.z() - high) < 1e-9) inner = std::min(inner, v.head<2>().norm());
      if (v.head<2>().norm() > 1e-9) continue;
      under = std::min(under, v.z());
      floor = std::max(floor, v.z());
    }
    EXPECT_NEAR(inner, radius - 0.0065, 1e-4);
    EXPECT_NEAR(under, 0.012, 1e-3);
    EXPECT_NEAR(floor - under, 0.005, 1e-3);
    // A wall and a floor, not a block.
    const double solid = M_PI * radius * radius * high;
    EXPECT_LT(geometry::Examine(mesh).signed_volume, 0.3 * solid);
  }
}

// The spout is at x and ends high; the handle is opposite, and its hole is open.
TEST(RigidKinds, TeapotsHaveASpoutAndAHandle) {
  const RigidObject teapot = MakeRigidObject(*FindRigidKind("teapot"), 1);
  const double body = 0.5 * teapot.size.y(), high = teapot.size.z();
  double spout = 0.0, handle_low = high, handle_high = 0.0;
  for (const Eigen::Vector3d& v : teapot.visual.mesh.vertices) {
    if (v.x() > 1.2 * body) spout = std::max(spout, v.z());
    if (v.x() < -1.1 * body) {
      handle_low = std::min(handle_low, v.z());
      handle_high = std::max(handle_high, v.z());
    }
  }
  EXPECT_GT(spout, 0.7 * high);
  EXPECT_GT(handle_high - handle_low, 0.2 * high);
}

// The number of parts is small enough for scenes of dozens of objects.
TEST(RigidKinds, WhatGrammarsUseOftenBringsFewParts) {
  for (const auto& [kind, most] : std::map<std::string, size_t>{{"steamer", 9},
                                                                {"steamer_lid", 1},
                                                                {"teapot", 12},
                                                                {"cup", 11},
                                                                {"bowl", 11},
                                                                {"plate", 11},
                                                                {"jug", 13},
                                                                {"mug", 15},
                                                                {"serving_dish", 11},
                                                                {"lamp", 5},
                                                                {"soda_can", 2},
                                                                {"toy_train", 11}}) {
    const size_t parts = MakeRigidObject(*FindRigidKind(kind), 1).parts.size();
    EXPECT_GE(parts, 1u) << kind;
    EXPECT_LE(parts, most) << kind;
  }
}

TEST(RigidKinds, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Kind& kind : Kinds()) names.insert(kind.name);
  for (const RigidKind& kind : RigidKinds()) EXPECT_TRUE(names.insert(kind.name).second);
  EXPECT_GE(RigidKinds().size(), 30u);
  EXPECT_EQ(FindRigidKind("sofa"), nullptr);
}

}  // namespace
}  // namespace simwright::library
