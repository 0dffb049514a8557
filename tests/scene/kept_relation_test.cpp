// Projections that keep relations: closed forms for boxes, contradictions, and crowded tables.
#include "scene/feasibility/kept_relation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "scene/feasibility/depenetration.h"

namespace simwright::scene {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSide = 0.1;  // m, of the cubes of these tests

geometry::ConvexShape CubeOfRelations() {
  geometry::ConvexShape cube;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {0.0, 1.0}) cube.vertices.push_back(kSide * Vector3d(x, y, z));
    }
  }
  return cube;
}

const std::vector<geometry::ConvexShape>& CubeParts() {
  static const std::vector<geometry::ConvexShape> parts = {CubeOfRelations()};
  return parts;
}

Isometry3d RelationPose(double x, double y, double z, double yaw = 0.0) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(x, y, z);
  pose.linear() = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

KeptRelation Kept(const std::vector<ProjectedBody>& bodies, int subject, Relation relation,
                  int object) {
  const CategorySize size = BoxSize(0.5 * kSide, 0.5 * kSide, kSide);
  KeptRelation kept{subject, object, relation, {}, {}};
  kept.subject_box = BoxOf(size, bodies[static_cast<size_t>(subject)].world_from_body);
  kept.object_box = BoxOf(size, bodies[static_cast<size_t>(object)].world_from_body);
  return kept;
}

std::vector<ProjectedBody> TwoCubes(const Isometry3d& a, const Isometry3d& b) {
  return {{&CubeParts(), a, false}, {&CubeParts(), b, false}};
}

// Cubes at an offset of (0.06, 0.03): without relations they part along x, by 0.04 in all. To be
// left of the other the first has to part along y, by 0.07, half of it each.
TEST(KeptRelation, LeftOfPartsAlongTheOtherAxis) {
  const std::vector<ProjectedBody> bodies =
      TwoCubes(RelationPose(0.06, 0.03, 0.0), RelationPose(0.0, 0.0, 0.0));
  const Projection free = ResolvePenetrations(bodies);
  EXPECT_NEAR(free.cost, 0.04 * 0.04 / 2.0, 1e-6);
  const Projection kept = ResolvePenetrations(bodies, {}, {Kept(bodies, 0, Relation::kLeftOf, 1)});
  EXPECT_TRUE(kept.feasible);
  EXPECT_TRUE(kept.broken.empty());
  EXPECT_NEAR(kept.cost, 0.07 * 0.07 / 2.0, 2e-5);
  EXPECT_NEAR(kept.shifts[0].y() - kept.shifts[1].y(), 0.07, 2e-4);
}

// A cube 5 cm too low and off centre by 7 cm is on the other one after a shift of 5 cm up and of
// 2.3 cm to within its footprint: a circle of 5 cm, a millimetre of margin, a polygon of 12
// corners.
TEST(KeptRelation, OnLiftsAndCentres) {
  std::vector<ProjectedBody> bodies =
      TwoCubes(RelationPose(0.07, 0.0, kSide - 0.05), RelationPose(0.0, 0.0, 0.0));
  bodies[1].fixed = true;
  const Projection kept = ResolvePenetrations(bodies, {}, {Kept(bodies, 0, Relation::kOn, 1)});
  EXPECT_TRUE(kept.feasible);
  EXPECT_TRUE(kept.broken.empty());
  EXPECT_NEAR(kept.shifts[0].x(), 0.049 * std::cos(M_PI / 12.0) - 0.07, 1e-4);
  EXPECT_NEAR(kept.shifts[0].z(), 0.05, 1e-4);
  EXPECT_EQ(kept.shifts[1], Vector3d::Zero());
}

TEST(KeptRelation, EstablishesEachRelationFromAnywhereNear) {
  core::Rng rng(7);
  for (int i = 0; i < kRelationCount; ++i) {
    const auto relation = static_cast<Relation>(i);
    if (relation == Relation::kInside) continue;  // solid cubes
    for (int k = 0; k < 20; ++k) {
      const auto at = [&] { return core::Uniform(rng, -0.15, 0.15); };
      const std::vector<ProjectedBody> bodies =
          TwoCubes(RelationPose(at(), at(), at(), core::Uniform(rng, 0.0, 6.28)),
                   RelationPose(0.0, 0.0, 0.0));
      const Projection kept = ResolvePenetrations(bodies, {}, {Kept(bodies, 0, relation, 1)});
      EXPECT_TRUE(kept.feasible) << RelationText(relation) << " " << k;
      EXPECT_TRUE(kept.broken.empty()) << RelationText(relation) << " " << k;
    }
  }
}

// A cube 20 cm under a board of 40 x 40 cm, its centre 5 cm outside: it moves 5 cm inward and 20 cm
// up, with a millimetre of margin each. One that is over the board already, as in a stack, stays.
TEST(KeptRelation, TiersLiftOntoTheBoard) {
  PlacedBox space;
  space.center = Vector3d(0.0, 0.0, 0.5);
  space.half = Vector3d(0.2, 0.2, 0.2);
  const CategorySize size = BoxSize(0.5 * kSide, 0.5 * kSide, kSide);
  for (const bool there : {false, true}) {
    const Isometry3d pose = RelationPose(there ? 0.1 : 0.25, 0.0, there ? 0.45 : 0.1);
    const std::vector<ProjectedBody> bodies = {{&CubeParts(), pose, false},
                                               {&CubeParts(), RelationPose(0, 0, -1.0), true}};
    const KeptRelation tier{0, 1, Relation::kOn, BoxOf(size, pose), space, true};
    EXPECT_EQ(HoldsAfter(tier, {Vector3d::Zero(), Vector3d::Zero()}), there);
    const Projection kept = ResolvePenetrations(bodies, {}, {tier});
    EXPECT_TRUE(kept.broken.empty());
    const Vector3d expected = there ? Vector3d::Zero() : Vector3d(-0.051, 0.0, 0.201);
    EXPECT_LT((kept.shifts[0] - expected).norm(), 1e-4) << kept.shifts[0].transpose();
  }
}

TEST(KeptRelation, ContradictionsAreSaidAndTheRestIsKept) {
  const std::vector<ProjectedBody> bodies =
      TwoCubes(RelationPose(0.06, 0.03, 0.0), RelationPose(0.0, 0.0, 0.0));
  const Projection kept = ResolvePenetrations(
      bodies, {}, {Kept(bodies, 0, Relation::kLeftOf, 1), Kept(bodies, 0, Relation::kRightOf, 1)});
  EXPECT_TRUE(kept.feasible);
  EXPECT_EQ(kept.broken.size(), 1u);
}

TEST(KeptRelation, RefusesBodiesThatDoNotExist) {
  const std::vector<ProjectedBody> bodies =
      TwoCubes(RelationPose(0.06, 0.03, 0.0), RelationPose(0.0, 0.0, 0.0));
  KeptRelation kept = Kept(bodies, 0, Relation::kLeftOf, 1);
  kept.object = 2;
  EXPECT_THROW(ResolvePenetrations(bodies, {}, {kept}), core::Error);
  kept.object = 0;
  EXPECT_THROW(ResolvePenetrations(bodies, {}, {kept}), core::Error);
}

// Rows of turned cubes that overlap their neighbours; relations as they are before.
TEST(KeptRelation, CrowdsKeepTheirRelationsAndLoseTheirCollisions) {
  int kept = 0, asked = 0;
  for (int seed = 0; seed < 10; ++seed) {
    core::Rng rng = core::StreamRng(3, static_cast<std::uint64_t>(seed));
    std::vector<ProjectedBody> bodies;
    for (int i = 0; i < 25; ++i) {
      bodies.push_back({&CubeParts(),
                        RelationPose(0.09 * (i % 5) + core::Uniform(rng, -0.02, 0.02),
                                     0.09 * (i / 5) + core::Uniform(rng, -0.02, 0.02), 0.0,
                                     core::Uniform(rng, 0.0, 6.28)),
                        false});
    }
    std::vector<KeptRelation> relations;
    for (int i = 0; i + 1 < 25; ++i) {
      const KeptRelation pair = Kept(bodies, i, Relation::kNextTo, i + 1);
      for (const Relation one : RelationsBetween(pair.subject_box, pair.object_box)) {
        if (one == Relation::kNextTo) continue;
        relations.push_back(pair);
        relations.back().relation = one;
      }
    }
    const Projection projection = ResolvePenetrations(bodies, {}, relations);
    EXPECT_TRUE(projection.feasible) << seed;
    asked += static_cast<int>(relations.size());
    kept += static_cast<int>(relations.size() - projection.broken.size());
  }
  EXPECT_GT(asked, 150);
  EXPECT_EQ(kept, asked);
}

}  // namespace
}  // namespace simwright::scene
