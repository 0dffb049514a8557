// Shards of a dataset: identical for any number of threads and interruptions.
#include "scene/dataset/generation.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "library/convex_shapes.h"
#include "scene/dataset/tokens.h"
#include "scene/grammar/grammar_builder.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

sim::RigidBody GenerationDrum(double radius, double height) {
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

AssetSet GenerationDrums() {
  AssetSet asset_set;
  asset_set.Add("table", GenerationDrum(0.5, 0.5));
  asset_set.Add("drum", GenerationDrum(0.05, 0.08));
  return asset_set;
}

Generation Of(const AssetSet& asset_set, double reach) {
  Generation generation{DrumsOnATable(reach), &asset_set, {}};
  generation.feasibility.settling.duration = 0.3;
  generation.feasibility.settling.watch = 0.1;
  return generation;
}

SceneShard Empty(const Generation& generation) {
  return {VocabularyOf(generation.grammar), {7, 3, "", SettingsText(generation), "1"}, {}, {}};
}

TEST(ExtendShard, IsTheSameForAnyThreadsAndInterruptions) {
  const AssetSet asset_set = GenerationDrums();
  // Near the rim some fall, so that some attempts fail.
  const Generation generation = Of(asset_set, 0.42);
  core::Progress progress;
  SceneShard whole = Empty(generation), pieces = Empty(generation);
  core::SetThreadCount(2);
  ExtendShard(generation, 10, &whole, &progress);
  core::SetThreadCount(1);
  for (const int scenes : {2, 5, 9, 10}) {
    ExtendShard(generation, scenes, &pieces, &progress);
    EXPECT_EQ(pieces.SceneCount(), scenes);
  }
  core::SetThreadCount(0);
  EXPECT_EQ(whole.SceneCount(), 10);
  EXPECT_EQ(whole.attempts, pieces.attempts);
  EXPECT_EQ(whole.tokens, pieces.tokens);
  EXPECT_EQ(whole.prompts.size(), 10u);
  EXPECT_EQ(whole.prompts, pieces.prompts);
  const size_t size = static_cast<size_t>(whole.vocabulary.entries * whole.vocabulary.TokenWidth());
  ASSERT_EQ(whole.tokens.size(), 10 * size);
  for (size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(ValidateTokens(&whole.tokens[i * size], whole.vocabulary), "");
    const std::vector<SceneObject> objects = DecodeScene(&whole.tokens[i * size], whole.vocabulary);
    EXPECT_GE(objects.size(), 4u);
    for (const SceneObject& object : objects) {
      const double height = object.world_from_object.translation().z();
      EXPECT_GT(height, object.welded ? -1e-9 : 0.5 - 1e-3);
    }
  }
  for (const SceneAttempt& one : whole.attempts) {
    if (!one.valid) continue;
    EXPECT_LE(one.penetration, 1e-4);
    EXPECT_LE(one.drift, 1e-3);
    EXPECT_EQ(one.kept + one.dropped, one.sampled);
  }
}

// A shard of an earlier version: the missing prompts are those of a new shard, and scenes stay.
TEST(ExtendShard, AddsMissingPrompts) {
  const AssetSet asset_set = GenerationDrums();
  const Generation generation = Of(asset_set, 0.42);
  core::Progress progress;
  SceneShard part = Empty(generation);
  ExtendShard(generation, 6, &part, &progress);
  const SceneShard whole = part;
  ASSERT_EQ(whole.prompts.size(), 6u);
  for (const size_t left : {0, 4}) {
    part.prompts.resize(left);
    ExtendShard(generation, 6, &part, &progress);
    EXPECT_EQ(part.prompts, whole.prompts);
    EXPECT_EQ(part.tokens, whole.tokens);
    EXPECT_EQ(part.attempts, whole.attempts);
  }
  for (size_t i = 0; i < 6; ++i) {
    const std::string& prompt = whole.prompts[i];
    EXPECT_TRUE(prompt.starts_with("A scene with ")) << prompt;
    EXPECT_TRUE(prompt.find("drum") != std::string::npos ||
                prompt.find(" objects.") != std::string::npos)
        << prompt;
  }
}

TEST(ExtendShard, SaysWhatBecameOfScenesThatAreNeverSound) {
  const AssetSet asset_set = GenerationDrums();
  Generation generation = Of(asset_set, 0.3);
  generation.feasibility.min_objects = 30;
  generation.attempts_per_scene = 3;
  core::Progress progress;
  SceneShard part = Empty(generation);
  try {
    ExtendShard(generation, 2, &part, &progress);
    FAIL() << "scenes of 30 drums were made of 5";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("of 6 scenes 0 are valid"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace simwright::scene
