// Furniture has the surfaces that grammars assume, and consists of few convex parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "geometry/mass_properties.h"
#include "geometry/mesh_validity.h"
#include "library/box_union.h"
#include "library/rigid/rigid_kinds.h"
#include "physics_params/knowledge_base.h"

namespace simwright::library {
namespace {

class EveryFurniture : public ::testing::TestWithParam<std::string> {
 protected:
  RigidObject Make(std::uint64_t seed = 1) const {
    return MakeRigidObject(*FindRigidKind(GetParam()), seed);
  }
};

TEST_P(EveryFurniture, IsOneSoundSolidOfItsSize) {
  const RigidObject object = Make();
  const geometry::MeshValidity s = geometry::Examine(object.visual.mesh);
  EXPECT_TRUE(s.IsSolid()) << geometry::Describe(s);
  EXPECT_EQ(s.components, 1);
  const Eigen::AlignedBox3d box = core::Bounds(object.visual.mesh);
  EXPECT_LT((box.sizes() - FindRigidKind(GetParam())->size).norm(), 1e-9);
  EXPECT_NEAR(box.min().z(), 0.0, 1e-12);
  EXPECT_LT(box.center().head<2>().norm(), 1e-9);
}

TEST_P(EveryFurniture, IsOfFewClosedConvexPartsThatReachAsFarAsIsSeen) {
  const RigidObject object = Make();
  EXPECT_LE(object.parts.size(), 9u);
  Eigen::AlignedBox3d all;
  for (const core::TriangleMesh& part : object.parts) {
    const geometry::MeshValidity s = geometry::Examine(part);
    EXPECT_TRUE(s.IsSolid()) << geometry::Describe(s);
    EXPECT_LE(part.vertices.size(), 64u);
    for (size_t t = 0; t < part.triangles.size(); ++t) {
      const Eigen::Vector3d normal =
          core::TriangleAreaVector(part, static_cast<int>(t)).normalized();
      const Eigen::Vector3d& corner = part.vertices[static_cast<size_t>(part.triangles[t][0])];
      for (const Eigen::Vector3d& v : part.vertices) ASSERT_LT(normal.dot(v - corner), 1e-9);
    }
    all.extend(core::Bounds(part));
  }
  const Eigen::AlignedBox3d box = core::Bounds(object.visual.mesh);
  EXPECT_LT((all.min() - box.min()).norm() + (all.max() - box.max()).norm(), 1e-9);
}

// Its mass is within the knowledge base's range, at a density that its material may have, without
// assuming hollow parts.
TEST_P(EveryFurniture, WeighsAsMuchAsItsMatter) {
  const auto& base = physics_params::KnowledgeBase::Shipped();
  const physics_params::Category& row = *base.FindCategory(FindRigidKind(GetParam())->category);
  const RigidObject object = Make();
  const physics_params::Interval density = base.FindMaterial(object.parameters.material)->density;
  const double volume = geometry::SolidMassProperties(object.visual.mesh, 1.0).volume;
  EXPECT_GE(row.mass.min, density.min * volume);
  EXPECT_LE(row.mass.max, density.max * volume);
  EXPECT_EQ(row.materials.size(), 1u);
}

TEST_P(EveryFurniture, ComesInSeveralFinishes) {
  std::set<std::string> finishes;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    finishes.insert(Make(seed).visual.materials.back().name +
                    std::to_string(Make(seed).visual.materials.back().base_color.x()));
  }
  EXPECT_GE(finishes.size(), 3u);
  EXPECT_EQ(Make(3).visual.mesh.vertices, Make(4).visual.mesh.vertices);
}

INSTANTIATE_TEST_SUITE_P(Library, EveryFurniture, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const RigidKind& kind : FurnitureKinds())
                             names.push_back(kind.name);
                           return names;
                         }()),
                         [](const auto& info) { return info.param; });

// Returns the horizontal tops, m, of parts that a plumb line through (x, y) meets, rounded to 0.1
// mm.
std::set<long> LevelsAt(const RigidObject& object, double x, double y) {
  std::set<long> levels;
  for (const core::TriangleMesh& part : object.parts) {
    for (size_t t = 0; t < part.triangles.size(); ++t) {
      const Eigen::Vector3d area = core::TriangleAreaVector(part, static_cast<int>(t));
      if (area.z() < (1.0 - 1e-9) * area.norm()) continue;  // not level, or seen from below
      Eigen::Vector2d corner[3];
      double z = 0.0;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d& v = part.vertices[static_cast<size_t>(part.triangles[t][k])];
        corner[k] = v.head<2>();
        z = v.z();
      }
      bool inside = true;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d side = corner[(k + 1) % 3] - corner[k];
        const Eigen::Vector2d to = Eigen::Vector2d(x, y) - corner[k];
        inside = inside && side.x() * to.y() - side.y() * to.x() >= 0.0;
      }
      if (inside) levels.insert(std::lround(1e4 * z));
    }
  }
  return levels;
}

// -0.39, -0.12, 0.14 and 0.41 m from the middle that is 0.407 m over the foot.
TEST(Furniture, ShelvesHaveTheirBoardsWhereThingsStand) {
  for (const char* kind : {"shelf_living_room", "shelf_pantry"}) {
    const RigidObject shelf = MakeRigidObject(*FindRigidKind(kind), 1);
    for (const double x : {-0.149, -0.03, 0.08, 0.134}) {
      for (const double y : {-0.284, -0.1, 0.12, 0.284}) {
        EXPECT_EQ(LevelsAt(shelf, x, y), (std::set<long>{170, 2870, 5470, 8170})) << x << " " << y;
      }
    }
    // Open to -x: the space between the boards is empty up to the back.
    for (const core::TriangleMesh& part : shelf.parts) {
      const Eigen::AlignedBox3d box = core::Bounds(part);
      if (box.sizes().z() < 0.1) continue;
      const bool behind = box.min().x() > 0.1349;
      EXPECT_TRUE(behind || std::abs(box.center().y()) > 0.29);
    }
  }
}

TEST(Furniture, TablesAreLevelUpToTheirRims) {
  const std::map<std::string, long> tops = {
      {"table_round", 7850}, {"table_restaurant", 7850}, {"table_breakfast", 7500}};
  for (const auto& [kind, height] : tops) {
    const RigidObject table = MakeRigidObject(*FindRigidKind(kind), 1);
    for (int k = 0; k < 24; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.31) / 24, share = (k % 6) / 5.0;
      const bool round = kind != "table_breakfast";
      const double x = (round ? 0.62 : 0.357 / std::sqrt(2.0)) * share * std::cos(angle);
      const double y = (round ? 0.62 : 0.699 / std::sqrt(2.0)) * share * std::sin(angle);
      const std::set<long> levels = LevelsAt(table, x, y);
      ASSERT_FALSE(levels.empty()) << kind << " " << x << " " << y;
      EXPECT_EQ(*levels.rbegin(), height) << kind;
    }
  }
}

TEST(Furniture, SeatAndFloorAreAtTheirHeights) {
  EXPECT_EQ(*LevelsAt(MakeRigidObject(*FindRigidKind("chair"), 1), 0.05, 0.01).rbegin(), 4600);
  EXPECT_EQ(*LevelsAt(MakeRigidObject(*FindRigidKind("floor"), 1), 4.9, -4.8).rbegin(), 500);
}

// The volume of two overlapping planks is their sum minus the overlap; a third that only touches
// adds its own.
TEST(BoxUnion, IsClosedAndCountsSharedMatterOnce) {
  const auto plank = [](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    return FurnitureBox{Eigen::AlignedBox3d(low, high), 0};
  };
  const std::vector<FurnitureBox> planks = {
      plank({0, 0, 0}, {3, 1, 1}), plank({1, -1, 0}, {2, 2, 1}), plank({3, 0, 0}, {4, 1, 2})};
  const core::TexturedMesh mesh = BoxUnion(planks, {Look("wood", .5f, .4f, .3f)});
  const geometry::MeshValidity s = geometry::Examine(mesh.mesh);
  EXPECT_TRUE(s.IsSolid()) << geometry::Describe(s);
  EXPECT_NEAR(s.signed_volume, 3.0 + 3.0 - 1.0 + 2.0, 1e-12);
  EXPECT_EQ(FurnitureBoxParts(planks).size(), 3u);
}

}  // namespace
}  // namespace simwright::library
