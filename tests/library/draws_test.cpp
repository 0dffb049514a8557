#include "library/draws.h"

#include <gtest/gtest.h>

#include "assets/articulated_asset.h"
#include "library/articulated/articulated_kinds.h"
#include "library/rigid/rigid_kinds.h"

namespace simwright::library {
namespace {

void ExpectSameVertices(const core::TriangleMesh& one, const core::TriangleMesh& other,
                        const std::string& where) {
  ASSERT_EQ(one.vertices.size(), other.vertices.size()) << where;
  for (size_t i = 0; i < one.vertices.size(); ++i) {
    ASSERT_EQ(one.vertices[i], other.vertices[i]) << where;
  }
}

TEST(Draws, GivenNumbersReplaceSampledOnesInPlace) {
  Draws sampled(core::StreamRng(5, 1)), replayed(core::StreamRng(5, 1), {0.25, 2.0});
  EXPECT_NE(sampled.Next(), 0.25);
  sampled.Next();
  EXPECT_EQ(replayed.Next(), 0.25);
  EXPECT_LT(replayed.Next(), 1.0);  // clamped into [0, 1)
  EXPECT_EQ(replayed.Next(), sampled.Next());
  EXPECT_EQ(core::Uniform(replayed.unseen()), core::Uniform(sampled.unseen()));
  EXPECT_EQ(replayed.record().size(), 3u);
  EXPECT_EQ(replayed.record()[0], 0.25);
}

// The recorded choices and the size give the same shape with another seed.
TEST(Draws, ChoicesAndSizeDetermineAnArticulatedShape) {
  for (const Kind& kind : Kinds()) {
    for (const std::uint64_t seed : {3, 4}) {
      std::vector<double> choices;
      Options options;
      options.seed = seed;
      options.record = &choices;
      const assets::ArticulatedAsset asset = kind.make(options);
      const physics_params::PhysicalParameters& p = asset.parameters;
      Options again;
      again.seed = seed + 100;
      again.draws = choices;
      again.size = Eigen::Vector3d(p.length.sample, p.width.sample, p.height.sample);
      const assets::ArticulatedAsset other = kind.make(again);
      ExpectSameVertices(assets::VisualAtPositions(asset).mesh,
                         assets::VisualAtPositions(other).mesh, kind.name);
      EXPECT_EQ(asset.features, other.features) << kind.name;
      ASSERT_EQ(asset.joints.size(), other.joints.size()) << kind.name;
      for (size_t i = 0; i < asset.joints.size(); ++i) {
        EXPECT_EQ(asset.joints[i].upper, other.joints[i].upper) << kind.name;
      }
    }
  }
}

TEST(Draws, ChoicesAndSizeDetermineARigidShape) {
  for (const RigidKind& kind : RigidKinds()) {
    std::vector<double> choices;
    Options options;
    options.seed = 5;
    options.record = &choices;
    const RigidObject object = MakeRigidObject(kind, options);
    ExpectSameVertices(object.visual.mesh, MakeRigidObject(kind, 5).visual.mesh, kind.name);
    Options again;
    again.seed = 5;
    again.draws = choices;
    again.size = object.size;
    ExpectSameVertices(object.visual.mesh, MakeRigidObject(kind, again).visual.mesh, kind.name);
  }
}

TEST(Draws, AppearanceAloneHasTheSameShape) {
  for (const Kind& kind : Kinds()) {
    Options options;
    options.seed = 6;
    const core::TexturedMesh whole = assets::VisualAtPositions(kind.make(options));
    options.appearance_only = true;
    const core::TexturedMesh shown = assets::VisualAtPositions(kind.make(options));
    ExpectSameVertices(whole.mesh, shown.mesh, kind.name);
    EXPECT_EQ(whole.triangle_material, shown.triangle_material);
  }
}

TEST(Draws, AGivenHingeSideMirrorsTheMicrowave) {
  Options options;
  options.draws = {0.1};  // the first choice: left with a probability of 0.85
  EXPECT_EQ(MakeMicrowave(options).features.at("hinge"), "left");
  options.draws = {0.9};
  EXPECT_EQ(MakeMicrowave(options).features.at("hinge"), "right");
}

}  // namespace
}  // namespace simwright::library
