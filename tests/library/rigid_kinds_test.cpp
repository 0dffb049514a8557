#include "library/rigid_kinds.h"

#include <gtest/gtest.h>

#include <set>

#include "geometry/soundness.h"
#include "library/kinds.h"
#include "physics_params/knowledge_base.h"

namespace simwright::library {
namespace {

class EveryRigidKind : public ::testing::TestWithParam<std::string> {
 protected:
  RigidThing Make(std::uint64_t seed) const {
    return MakeRigidThing(*FindRigidKind(GetParam()), seed);
  }
};

TEST_P(EveryRigidKind, IsClosedAndOfTheSampledSize) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const RigidThing thing = Make(seed);
    core::RequireValid(thing.visual, GetParam());
    const geometry::Soundness s = geometry::Examine(thing.visual.mesh);
    EXPECT_TRUE(s.closed && s.oriented && s.manifold) << geometry::Describe(s);
    EXPECT_EQ(s.degenerate_triangles, 0);
    EXPECT_GT(s.signed_volume, 0.0);
    // Only what has a handle or a head of its own may cross itself.
    if (s.components == 1) {
      EXPECT_EQ(s.self_intersections, 0) << seed;
    }
    const Eigen::AlignedBox3d box = core::Bounds(thing.visual.mesh);
    EXPECT_LT((box.sizes() - thing.size).norm(), 1e-9);
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

TEST(RigidKinds, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Kind& kind : Kinds()) names.insert(kind.name);
  for (const RigidKind& kind : RigidKinds()) EXPECT_TRUE(names.insert(kind.name).second);
  EXPECT_GE(RigidKinds().size(), 30u);
  EXPECT_EQ(FindRigidKind("sofa"), nullptr);
}

}  // namespace
}  // namespace simwright::library
