// Shards of a dataset: identical for any number of threads and interruptions.
#include "scene/generation.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "library/convex_shapes.h"
#include "scene/dataset/tokens.h"
#include "scene/grammar/grammar_builder.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

sim::RigidBody Drum(double radius, double height) {
  sim::RigidBody body;
  body.name = "drum";
  body.friction = 0.6;
  body.parts = {library::Rod(Vector3d::Zero(), Vector3d(0, 0, height), radius, 16)};
  body.inertial = {0.2, Vector3d(0, 0, 0.5 * height), 1e-3 * Eigen::Matrix3d::Identity()};
  return body;
}

// Returns a grammar of drums on a table, some of which interpenetrate; `reach`: the largest
// distance from the middle.
Grammar DrumsOnATable(double reach) {
  GrammarBuilder builder("drums", "scene");
  builder.And(Welded("scene", "table"), {Always("top", Offset(0, 0, 0.5))})
      .Repeat(Surface("top"), {0, 0, 0, 1, 1, 1},
              Always("drum", UniformOnSurface({-reach, -reach, 0}, {reach, reach, 0})))
      .Leaf(Object("drum", "drum"))
      .Require(EntriesAtMost(6));
  return builder.Build();
}

Palette Drums() {
  Palette palette;
  palette.Add("table", Drum(0.5, 0.5));
  palette.Add("drum", Drum(0.05, 0.08));
  return palette;
}

Generation Of(const Palette& palette, double reach) {
  Generation generation{DrumsOnATable(reach), &palette, {}};
  generation.feasibility.settling.duration = 0.3;
  generation.feasibility.settling.watch = 0.1;
  return generation;
}

ScenePart Empty(const Generation& generation) {
  return {VocabularyOf(generation.grammar), {7, 3, "", SettingsText(generation), "1"}, {}, {}};
}

TEST(ExtendPart, IsTheSameForAnyThreadsAndInterruptions) {
  const Palette palette = Drums();
  // Near the rim some fall, so that some attempts fail.
  const Generation generation = Of(palette, 0.42);
  core::Progress progress;
  ScenePart whole = Empty(generation), pieces = Empty(generation);
  core::SetThreadCount(2);
  ExtendPart(generation, 10, &whole, &progress);
  core::SetThreadCount(1);
  for (const int scenes : {2, 5, 9, 10}) {
    ExtendPart(generation, scenes, &pieces, &progress);
    EXPECT_EQ(pieces.SceneCount(), scenes);
  }
  core::SetThreadCount(0);
  EXPECT_EQ(whole.SceneCount(), 10);
  EXPECT_EQ(whole.attempts, pieces.attempts);
  EXPECT_EQ(whole.tokens, pieces.tokens);
  const size_t size = static_cast<size_t>(whole.vocabulary.entries * whole.vocabulary.TokenWidth());
  ASSERT_EQ(whole.tokens.size(), 10 * size);
  for (size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(FaultOfTokens(&whole.tokens[i * size], whole.vocabulary), "");
    const std::vector<DrawnObject> objects = DecodeScene(&whole.tokens[i * size], whole.vocabulary);
    EXPECT_GE(objects.size(), 4u);
    for (const DrawnObject& object : objects) {
      const double height = object.world_from_object.translation().z();
      EXPECT_GT(height, object.welded ? -1e-9 : 0.5 - 1e-3);
    }
  }
  for (const SceneAttempt& one : whole.attempts) {
    if (!one.sound) continue;
    EXPECT_LE(one.penetration, 1e-4);
    EXPECT_LE(one.drift, 1e-3);
    EXPECT_EQ(one.kept + one.dropped, one.drawn);
  }
}

TEST(ExtendPart, SaysWhatBecameOfScenesThatAreNeverSound) {
  const Palette palette = Drums();
  Generation generation = Of(palette, 0.3);
  generation.feasibility.fewest = 30;
  generation.attempts_a_scene = 3;
  core::Progress progress;
  ScenePart part = Empty(generation);
  try {
    ExtendPart(generation, 2, &part, &progress);
    FAIL() << "scenes of 30 drums were made of 5";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("of 6 scenes 0 are valid"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace simwright::scene
