// Post-training of small models: what it raises, its checkpoints, and a stopped run.
#include "steering/post_training/post_training.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "scene/model/scene_model.h"
#include "scene/model/training.h"
#include "tests/steering/post_training_scenes.h"

namespace simwright::steering {
namespace {
namespace fs = std::filesystem;

int CupsIn(const std::vector<scene::SceneObject>& objects) {
  int cups = 0;
  for (const scene::SceneObject& object : objects) cups += object.category == "cup";
  return cups;
}

PostTrainingGoal MoreCups() {
  PostTrainingGoal goal;
  goal.rewards = [](const SampledScenes& scenes) {
    std::vector<double> rewards;
    for (const auto& one : scenes) rewards.push_back(CupsIn(one));
    return rewards;
  };
  goal.accuracy = [](const SampledScenes&) { return 0.6; };
  return goal;
}

PostTrainingOptions QuickPostTraining(int rounds) {
  core::SetThreadCount(1);  // beside other tests
  PostTrainingOptions options;
  options.rounds = rounds;
  options.scenes = 32;
  options.steps = 10;
  options.gradient_steps = 5;
  options.data_batch = 8;
  options.data_weight = 0.1;
  options.more_entries = 2;
  options.score_every = 5;
  options.scored_scenes = 64;
  options.trainer.learning_rate = 1e-3;
  return options;
}

class PostTrainingTest : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    core::SetThreadCount(1);
    WriteTableScenes(folder_.path(), 200);
    data_.emplace(folder_.path());
    scene::SceneTrainingOptions training;
    training.trainer.steps = 300;
    training.trainer.learning_rate = 2e-3;
    training.trainer.ema_decay = 0.98;
    weights_ = TrainSceneModel(*data_, SmallModel(GetParam()), training, folder_.path() / "prior",
                               &silent_)
                   .weights;
  }

  PostTrainingReport Run(const PostTrainingGoal& goal, const PostTrainingOptions& options,
                         const std::string& name) {
    return PostTrain(weights_, *data_, goal, options, folder_.path() / name, &silent_);
  }

  core::TemporaryFolder folder_;
  std::optional<scene::SceneDataset> data_;
  fs::path weights_;
  core::Progress silent_;
};

INSTANTIATE_TEST_SUITE_P(BothModels, PostTrainingTest, testing::Bool(),
                         [](const auto& one) { return one.param ? "Continuous" : "Mixed"; });

TEST_P(PostTrainingTest, RaisesTheRewardAndWritesTheChosenModel) {
  const PostTrainingReport report = Run(MoreCups(), QuickPostTraining(40), "run");
  ASSERT_EQ(report.rounds.size(), 40u);
  ASSERT_EQ(report.checkpoints.size(), 9u);
  const double before = report.checkpoints.front().score.reward;
  const Checkpoint& chosen = report.checkpoints[static_cast<size_t>(report.chosen)];
  EXPECT_LT(before, 2.5);
  EXPECT_GT(chosen.score.reward, 1.5 * before);
  // The written model is the chosen one, with more entries.
  const scene::SceneModel model =
      scene::SceneModel::Load(folder_.path() / "run" / scene::kWeightsFile);
  EXPECT_EQ(model.metadata().vocabulary.entries, TableVocabulary().entries + 2);
  scene::SampleOptions sampling;
  sampling.steps = 10;
  const std::vector<float> tokens = model.Sample(64, sampling, &silent_);
  const auto size = tokens.size() / 64;
  double cups = 0.0;
  for (size_t i = 0; i < tokens.size(); i += size) {
    cups += CupsIn(scene::DecodeScene(&tokens[i], model.metadata().vocabulary)) / 64.0;
  }
  EXPECT_NEAR(cups, chosen.score.reward, 0.6);
}

TEST_P(PostTrainingTest, AStoppedRunContinuesToTheSameWeights) {
  Run(MoreCups(), QuickPostTraining(10), "whole");
  int calls = 0;
  PostTrainingGoal stopped = MoreCups();
  stopped.rewards = [&](const SampledScenes& scenes) {
    if (++calls == 9) throw core::Cancelled();  // in round 7
    return MoreCups().rewards(scenes);
  };
  EXPECT_THROW(Run(stopped, QuickPostTraining(10), "stopped"), core::Cancelled);
  PostTrainingOptions options = QuickPostTraining(10);
  options.trainer.resume = true;
  const PostTrainingReport report = Run(MoreCups(), options, "stopped");
  EXPECT_EQ(report.rounds.size(), 10u);
  for (const char* const file : {"rounds.csv", "checkpoints.csv", "checkpoint_000010.pt"}) {
    EXPECT_EQ(core::ReadFile(folder_.path() / "whole" / file),
              core::ReadFile(folder_.path() / "stopped" / file))
        << file;
  }
}

TEST_P(PostTrainingTest, KeepsItsCheckpointsIfARewardIsNotANumber) {
  int calls = 0;
  PostTrainingGoal broken = MoreCups();
  broken.rewards = [&](const SampledScenes& scenes) {
    std::vector<double> rewards = MoreCups().rewards(scenes);
    if (++calls == 9) rewards[3] = std::numeric_limits<double>::quiet_NaN();
    return rewards;
  };
  EXPECT_THROW(Run(broken, QuickPostTraining(10), "run"), core::Error);
  EXPECT_NO_THROW(scene::SceneModel::Load(folder_.path() / "run" / "checkpoint_000005.pt"));
}

TEST_P(PostTrainingTest, RefusesDataAndOptionsThatDoNotFit) {
  const core::TemporaryFolder other;
  scene::Vocabulary vocabulary = TableVocabulary();
  vocabulary.categories[0] = "bowl";
  scene::SceneShard part{vocabulary, {5, 0, "{}", "{}", "1"}, {}, {}};
  part.tokens.resize(static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth()));
  scene::EncodeScene({ObjectAt("table", 0, 0, 0)}, vocabulary, part.tokens.data());
  part.attempts.push_back({1, 1, 0, true, true, 0, 0, 0});
  scene::WriteShard(part, other.path() / scene::ShardName(0));
  EXPECT_THROW(PostTrain(weights_, scene::SceneDataset(other.path()), MoreCups(),
                         QuickPostTraining(2), folder_.path() / "run", &silent_),
               core::Error);
  PostTrainingOptions options = QuickPostTraining(2);
  options.gradient_steps = 10;  // of 10, the last of which is certain
  EXPECT_THROW(Run(MoreCups(), options, "run"), core::Error);
  PostTrainingGoal prompted = MoreCups();
  prompted.prompts = {"A scene with a cup."};
  EXPECT_THROW(Run(prompted, QuickPostTraining(2), "run"), core::Error);
}

TEST(PostTraining, ChoosesTheLargestRewardThatStaysNearTheData) {
  std::vector<Checkpoint> checkpoints(4);
  const double rewards[] = {1.0, 2.0, 4.0, 3.0}, accuracies[] = {0.6, 0.8, 0.99, 0.9};
  for (size_t i = 0; i < 4; ++i) checkpoints[i].score = {rewards[i], accuracies[i]};
  EXPECT_EQ(ChosenCheckpoint(checkpoints, 1.0), 2);
  EXPECT_EQ(ChosenCheckpoint(checkpoints, 0.95), 3);
  EXPECT_EQ(ChosenCheckpoint(checkpoints, 0.85), 1);
  EXPECT_EQ(ChosenCheckpoint(checkpoints, 0.55), 0);  // none: the least accuracy
  EXPECT_THROW(ChosenCheckpoint({}, 1.0), core::Error);
}

}  // namespace
}  // namespace simwright::steering
