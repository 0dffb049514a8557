// `simwright scene evaluate` and `scene features train`: known metrics of a set against itself, a
// model sampled and measured in one command, and rejected inputs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "core/random.h"
#include "program.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "scene/scene_types/scene_types.h"
#include "shared_scene_assets.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kScenes = 24;

constexpr double kSunk = 0.005;  // m

// Dimsum tables sampled from the grammar, with all objects lowered into the table, and their
// assets.
void WriteDraws(const fs::path& folder) {
  const scene::Grammar grammar =
      scene::SceneTypeNamed("dimsum").make(scene::DefaultCategorySizes());
  const scene::Vocabulary vocabulary = VocabularyOf(grammar);
  scene::SceneShard part{vocabulary, {5, 0, "{}", "{\"raw\":true}", "1"}, {}, {}};
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  for (std::uint64_t i = 0; i < kScenes; ++i) {
    core::Rng rng = core::StreamRng(5, i);
    auto objects = SampleGrammar(grammar, rng).objects;
    for (scene::SceneObject& object : objects) {
      if (!object.welded) object.world_from_object.translation().z() -= kSunk;
    }
    const int count = static_cast<int>(objects.size());
    part.tokens.resize(part.tokens.size() + size);
    EncodeScene(objects, vocabulary, &part.tokens[part.tokens.size() - size]);
    part.attempts.push_back({count, count, 0, true, true, 0, 0, 0});
  }
  fs::create_directories(folder);
  WriteShard(part, folder / scene::ShardName(0));
  PlaceSceneAssets("dimsum", folder);
}

class SceneEvaluate : public testing::Test {
 protected:
  // One test runs all checks, because separate processes would each make all assets again.
  static void ASetAgainstItself();
  static void WhatWasLearnedByHeartIsAtItsPlace();
  static void AModelInOneCommand();
  static void RefusesWhatIsNone();

  static void SetUpTestSuite() {
    folder_ = new core::TemporaryFolder();
    WriteDraws(At("data"));
    // The program looks for its features here.
    setenv("SIMWRIGHT_MODELS", At("models").c_str(), 1);
    fs::create_directories(At("models") + "/scenes");
    features_ = RunProgram("scene features train " + At("data") +
                           " --steps 3 --batch 4 --json -o " + At("models/scene_features.pt"));
    trained_ =
        RunProgram("scene train " + At("data") + " --steps 2 --batch 2 --quiet -o " + At("model"));
    std::error_code none;
    fs::copy_file(At("model/model.pt"), At("models/scenes/dimsum.pt"), none);
  }
  static void TearDownTestSuite() {
    unsetenv("SIMWRIGHT_MODELS");
    delete folder_;
  }

  static std::string At(const std::string& name) { return (folder_->path() / name).string(); }
  static Outcome Evaluate(const std::string& flags) {
    return RunProgram("scene evaluate --json " + flags);
  }

  static inline core::TemporaryFolder* folder_ = nullptr;
  static inline Outcome features_, trained_;
};

void SceneEvaluate::ASetAgainstItself() {
  ASSERT_EQ(features_.code, 0) << features_.text;
  const json features = json::parse(features_.text);
  EXPECT_EQ(features["pictures"].get<int>() + features["held_out"].get<int>(), 2 * kScenes);
  // All are held out, and all are samples.
  const Outcome outcome = Evaluate("--samples " + At("data") + " --data " + At("data") +
                                   " --training-scenes 0 -o " + At("itself"));
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const json figures = json::parse(outcome.text);
  EXPECT_EQ(figures["type"], "dimsum");
  EXPECT_EQ(figures["reference"]["scenes"], kScenes);
  EXPECT_EQ(figures["samples"]["kl_1e4"], 0.0);
  EXPECT_NEAR(figures["samples"]["frechet"].get<double>(), 0.0, 1e-6);
  EXPECT_EQ(figures["samples"]["penetration"], figures["reference"]["penetration"]);
  // At least three objects stand on the table itself.
  EXPECT_GT(figures["samples"]["penetration"]["parts_median_cm"].get<double>(),
            3 * 100.0 * kSunk - 1e-6);
  ASSERT_EQ(figures["samples"]["classifier_accuracy"].size(), 2u);
  EXPECT_FALSE(figures.contains("training"));
  EXPECT_FALSE(figures.contains("nearest_training_scene_m"));
  EXPECT_TRUE(figures["findings"].empty());
  EXPECT_TRUE(fs::exists(At("itself/sheet.png")));
  EXPECT_EQ(json::parse(core::ReadFile(At("itself/metrics.json"))), figures);
}

void SceneEvaluate::WhatWasLearnedByHeartIsAtItsPlace() {
  ASSERT_EQ(features_.code, 0) << features_.text;
  const Outcome outcome = Evaluate("--samples " + At("data") + " --data " + At("data") +
                                   " --training-scenes 12 --count 12");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const json figures = json::parse(outcome.text);
  EXPECT_EQ(figures["training_scenes"], 12);
  EXPECT_EQ(figures["training"]["scenes"], 12);
  EXPECT_NEAR(figures["nearest_training_scene_m"]["samples"]["ninetieth"].get<double>(), 0.0, 1e-3);
  EXPECT_GT(figures["nearest_training_scene_m"]["held_out"]["least"].get<double>(), 0.5);
  EXPECT_EQ(figures["samples"]["kl_1e4"], figures["training"]["kl_1e4"]);
  EXPECT_GT(figures["samples"]["frechet"].get<double>(), 0.0);
}

void SceneEvaluate::AModelInOneCommand() {
  ASSERT_EQ(trained_.code, 0) << trained_.text;
  const std::string few = " --count 4 --steps 3 --assets " + At("data/assets") + " -o ";
  // With its data, the training scenes are known, which leaves two scenes, too few to compare with.
  const Outcome own =
      Evaluate("--model " + At("model/model.pt") + " --data " + At("data") + few + At("own"));
  ASSERT_EQ(own.code, 0) << own.text;
  const json figures = json::parse(own.text);
  EXPECT_EQ(figures["training_scenes"], 22);
  EXPECT_EQ(figures["reference"]["held_out"], false);
  EXPECT_EQ(figures["samples"]["scenes"], 4);
  EXPECT_GT(figures["nearest_training_scene_m"]["samples"]["least"].get<double>(), 0.1);
  // With shipped weights, held-out scenes are generated.
  const Outcome shipped = Evaluate("--type dimsum" + few + At("shipped"));
  ASSERT_EQ(shipped.code, 0) << shipped.text;
  EXPECT_EQ(json::parse(shipped.text)["reference"]["held_out"], true);
  EXPECT_EQ(scene::SceneDataset(fs::path(At("shipped/held_out"))).SceneCount(), 4);
  EXPECT_EQ(scene::SceneDataset(fs::path(At("shipped/samples"))).SceneCount(), 4);
  // A user's network file that is not one.
  EXPECT_EQ(Evaluate("--type dimsum --features " + At("model/model.pt") + few + At("x")).code, 1);
}

void SceneEvaluate::RefusesWhatIsNone() {
  const std::string data = " --data " + At("data"), samples = " --samples " + At("data");
  for (const std::string& flags : std::vector<std::string>{
           std::string(), data, samples + data + " --count 3",
           samples + data + " --training-scenes 99", samples + data + " --type pantry_shelf",
           samples + " --data " + At("nowhere"), std::string("--type pantry_shelf"),
           "--model " + At("nowhere.pt") + data,
           samples + data + " --features " + At("nowhere.pt")}) {
    const Outcome outcome = RunProgram("scene evaluate --quiet " + flags);
    EXPECT_EQ(outcome.code, 1) << flags;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
  }
  EXPECT_EQ(RunProgram("scene features train --draws 0 --quiet -o " + At("y.pt")).code, 1);
  EXPECT_EQ(RunProgram("scene features train --type banquet --quiet -o " + At("y.pt")).code, 1);
}

TEST_F(SceneEvaluate, DoesAllOfIt) {
  {
    SCOPED_TRACE("ASetAgainstItself");
    ASetAgainstItself();
  }
  {
    SCOPED_TRACE("WhatWasLearnedByHeartIsAtItsPlace");
    WhatWasLearnedByHeartIsAtItsPlace();
  }
  {
    SCOPED_TRACE("AModelInOneCommand");
    AModelInOneCommand();
  }
  {
    SCOPED_TRACE("RefusesWhatIsNone");
    RefusesWhatIsNone();
  }
}

}  // namespace
}  // namespace simwright::workflows
