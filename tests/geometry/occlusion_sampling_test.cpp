#include "geometry/occlusion_sampling.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/triangle_tree.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::geometry {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;
using shapes::Box;

// Two slabs 4 mm apart with a floor between them: a slit 0.3 deep. The solid fills it.
class Slit : public ::testing::Test {
 protected:
  Slit() {
    core::Append(Box({-0.5, -0.5, 0}, {-0.002, 0.5, 0.5}), &visual_);
    core::Append(Box({0.002, -0.5, 0}, {0.5, 0.5, 0.5}), &visual_);
    core::Append(Box({-0.1, -0.5, 0}, {0.1, 0.5, 0.2}), &visual_);
    core::Append(Box({-0.5, -0.5, 0}, {0.5, 0.5, 0.5}), &solid_);
    options_.reach = 0.05;
    options_.radius = 0.1;
    options_.rays = 300000;
  }
  TriangleMesh visual_, solid_;
  OcclusionSamplingOptions options_;
};

TEST_F(Slit, IsLookedIntoFarMoreOftenThanByChance) {
  const auto inside = [](const OuterHit& hit) {
    return std::abs(hit.point.x()) < 0.0021 && hit.point.z() < 0.4501;
  };
  int by_chance = 0;
  const std::vector<OuterHit> sights = SampleOccludedHits(visual_, solid_, options_, &by_chance);
  EXPECT_GT(by_chance, 0);
  EXPECT_EQ(std::count_if(sights.begin(), sights.end(), inside), std::ssize(sights));
  EXPECT_GT(std::ssize(sights), 8 * by_chance);
}

// Each is the first hit of a ray from outside.
TEST_F(Slit, SightsAreTrue) {
  const TriangleTree tree(visual_), solid(solid_);
  const std::vector<OuterHit> sights = SampleOccludedHits(visual_, solid_, options_);
  ASSERT_FALSE(sights.empty());
  for (const OuterHit& hit : sights) {
    EXPECT_GT(solid.Closest(hit.point).distance, options_.reach);
    EXPECT_LT(tree.Closest(hit.point).distance, 1e-9);
    EXPECT_FALSE(tree.SegmentMeets(hit.point + 1e-6 * hit.to_eye, hit.point + 5.0 * hit.to_eye));
    EXPECT_GE(hit.normal.dot(hit.to_eye), 0.0);
  }
}

TEST_F(Slit, NothingIsHiddenFromAFaithfulSolid) {
  EXPECT_TRUE(SampleOccludedHits(solid_, solid_, options_).empty());
}

TEST_F(Slit, RepeatsBitForBit) {
  const auto a = SampleOccludedHits(visual_, solid_, options_);
  const auto b = SampleOccludedHits(visual_, solid_, options_);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_FALSE(a.empty());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].point, b[i].point);
}

TEST_F(Slit, RefusesLengthsThatAreNotPositiveAndNegativeNumbers) {
  OcclusionSamplingOptions wrong = options_;
  wrong.radius = 0.0;
  EXPECT_THROW(SampleOccludedHits(visual_, solid_, wrong), core::Error);
  wrong = options_;
  wrong.generations = -1;
  EXPECT_THROW(SampleOccludedHits(visual_, solid_, wrong), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
