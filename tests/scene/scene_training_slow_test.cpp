// Training a small model, resuming it, and sampling from its weights.
#include "scene/model/training.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "scene/dataset/tokens.h"
#include "scene/model/scene_model.h"
#include "tests/scene/small_scene_model.h"

namespace simwright::scene {
namespace {
namespace fs = std::filesystem;

Vocabulary SceneTrainingWords() {
  return {"test", 4, {"cup", "plate", "table"}, {false, false, true}};
}

// A table at the origin, a cup at x = 1 on it, and in half of the scenes a plate at x = -1.
void WriteScenes(const fs::path& folder, int count) {
  SceneShard part{SceneTrainingWords(), {5, 0, "{}", "{}", "1"}, {}, {}};
  const size_t size =
      static_cast<size_t>(SceneTrainingWords().entries * SceneTrainingWords().TokenWidth());
  core::Rng rng = core::StreamRng(4, 0);
  for (int i = 0; i < count; ++i) {
    std::vector<SceneObject> objects(2 + i % 2);
    objects[0].category = "table";
    objects[1].category = "cup";
    objects[1].world_from_object.translation() << 1.0 + 0.05 * core::Normal(rng), 0.0, 0.5;
    if (i % 2 == 1) {
      objects[2].category = "plate";
      objects[2].world_from_object.translation() << -1.0, 0.05 * core::Normal(rng), 0.5;
    }
    part.tokens.resize(part.tokens.size() + size);
    EncodeScene(objects, SceneTrainingWords(), &part.tokens[part.tokens.size() - size]);
    part.attempts.push_back({3, 3, 0, true, true, 0, 0, 0});
  }
  WriteShard(part, folder / ShardName(0));
}

SceneTrainingOptions Short(int steps) {
  // Next to other tests, two threads wait for each other longer than one computes.
  core::SetThreadCount(1);
  SceneTrainingOptions options;
  options.trainer.steps = steps;
  options.trainer.learning_rate = 2e-3;
  options.trainer.ema_decay = 0.98;
  options.trainer.save_every = 20;
  options.batch = 64;
  options.report_every = 10;
  return options;
}

TEST(SceneTraining, LearnsWhatScenesHold) {
  const core::TemporaryFolder folder;
  WriteScenes(folder.path(), 200);
  core::Progress progress;
  const SceneTrainingReport report = TrainSceneModel(SceneDataset(folder.path()), SmallSceneModel(),
                                                     Short(400), folder.path() / "run", &progress);
  EXPECT_EQ(report.training_scenes, 180);
  EXPECT_EQ(report.held_out_scenes, 20);

  ASSERT_EQ(report.losses.size(), 40u);
  EXPECT_LT(report.losses.back().held_out, 0.5 * report.losses.front().held_out);

  const SceneModel model = SceneModel::Load(report.weights);
  EXPECT_EQ(model.metadata().vocabulary, SceneTrainingWords());
  EXPECT_EQ(model.metadata().training_scenes, 180);
  EXPECT_EQ(model.metadata().parameters, report.parameters);
  SampleOptions options;
  options.steps = 50;
  constexpr int kScenes = 64;
  const std::vector<float> tokens = model.Sample(kScenes, options, &progress);
  const size_t size =
      static_cast<size_t>(SceneTrainingWords().entries * SceneTrainingWords().TokenWidth());
  ASSERT_EQ(tokens.size(), kScenes * size);
  int right = 0, plates = 0;
  for (int i = 0; i < kScenes; ++i) {
    int cups = 0, tables = 0, others = 0;
    for (const SceneObject& object :
         DecodeScene(&tokens[static_cast<size_t>(i) * size], SceneTrainingWords())) {
      const Eigen::Vector3d at = object.world_from_object.translation();
      EXPECT_TRUE(object.world_from_object.linear().isUnitary(1e-9));
      cups += object.category == "cup" && (at - Eigen::Vector3d(1, 0, 0.5)).norm() < 0.3;
      tables += object.category == "table" && at.norm() < 0.3;
      others += object.category == "plate" && (at - Eigen::Vector3d(-1, 0, 0.5)).norm() < 0.3;
    }
    right += cups == 1 && tables == 1 && others <= 1;
    plates += others == 1;
  }
  EXPECT_GE(right, kScenes * 3 / 4);
  EXPECT_NEAR(plates, kScenes / 2, 16);
  // The same seed, the same scenes.
  EXPECT_EQ(model.Sample(2, options, &progress),
            std::vector<float>(model.Sample(2, options, &progress)));
}

// Half of the scenes have a plate: a prompt decides which.
TEST(SceneTraining, FollowsPrompts) {
  const core::TemporaryFolder folder;
  WriteScenes(folder.path(), 200);
  core::Progress progress;
  SceneModelOptions small = SmallSceneModel();
  small.text = true;
  SceneTrainingOptions training = Short(400);
  training.text_pieces = 80;
  const SceneTrainingReport report = TrainSceneModel(SceneDataset(folder.path()), small, training,
                                                     folder.path() / "run", &progress);
  const SceneModel model = SceneModel::Load(report.weights);
  EXPECT_LE(model.metadata().text_pieces.size(), 80u);
  const size_t size =
      static_cast<size_t>(SceneTrainingWords().entries * SceneTrainingWords().TokenWidth());
  const auto plates = [&](const std::vector<std::string>& prompts, double guidance) {
    constexpr int kScenes = 32;
    SampleOptions options;
    options.steps = 50;
    options.prompts = prompts;
    options.guidance = guidance;
    const std::vector<float> tokens = model.Sample(kScenes, options, &progress);
    std::vector<int> count(2, 0);  // of even and odd scenes
    for (size_t i = 0; i < kScenes; ++i) {
      for (const SceneObject& object : DecodeScene(&tokens[i * size], SceneTrainingWords())) {
        count[i % 2] += object.category == "plate";
      }
    }
    return count;
  };
  const std::string with = "A scene with a cup and a plate.", without = "A scene with a cup.";
  const std::vector<int> prompted = plates({with, without}, 0.0);  // of 16 scenes each
  EXPECT_GE(prompted[0], 12);
  EXPECT_LE(prompted[1], 3);
  const std::vector<int> guided = plates({with, without}, 1.0);
  EXPECT_GE(guided[0], 14);
  EXPECT_LE(guided[1], 2);
  const std::vector<int> free = plates({}, 0.0);
  EXPECT_NEAR(free[0] + free[1], 16, 9);
  EXPECT_THROW(SceneModel::Load(report.weights, report.weights), core::Error);
}

// A model with classes by shape treats a new asset like a similar one: a mug a little larger than
// the cups stands at the cups' positions, as often as they do, and plates remain plates.
TEST(SceneTraining, PlacesAnAssetItHasNotSeen) {
  constexpr int kPoints = 64;
  const auto shape = [](double x, double y, double z) {
    return ShapeOf(assets::BoxMesh({x, y, z}), kPoints);
  };
  const core::TemporaryFolder folder;
  WriteScenes(folder.path(), 200);
  core::Progress progress;
  SceneModelOptions options = SmallSceneModel();
  options.shape_points = kPoints;
  SceneTrainingOptions training = Short(700);
  EXPECT_THROW(TrainSceneModel(SceneDataset(folder.path()), options, training,
                               folder.path() / "run", &progress),
               core::Error);
  training.shapes = {{shape(0.08, 0.08, 0.1), shape(0.25, 0.25, 0.02), shape(1, 1, 0.7)}};
  const SceneTrainingReport report = TrainSceneModel(SceneDataset(folder.path()), options, training,
                                                     folder.path() / "run", &progress);
  SceneModel model = SceneModel::Load(report.weights);
  model.AddAsset("mug", shape(0.085, 0.085, 0.105));
  EXPECT_THROW(model.AddAsset("mug", shape(1, 1, 1)), core::Error);
  const Vocabulary words = model.metadata().vocabulary;
  EXPECT_EQ(words.categories, (std::vector<std::string>{"cup", "mug", "plate", "table"}));
  EXPECT_EQ(words.welded, (std::vector<bool>{false, false, false, true}));
  SampleOptions sampling;
  sampling.steps = 50;
  constexpr int kScenes = 64;
  const std::vector<float> tokens = model.Sample(kScenes, sampling, &progress);
  const size_t size = static_cast<size_t>(words.entries * words.TokenWidth());
  int cups = 0, mugs = 0, mugs_at_cups = 0, right = 0;
  for (int i = 0; i < kScenes; ++i) {
    int drinks = 0;
    for (const SceneObject& object : DecodeScene(&tokens[static_cast<size_t>(i) * size], words)) {
      const Eigen::Vector3d at = object.world_from_object.translation();
      drinks += object.category == "cup" || object.category == "mug";
      cups += object.category == "cup";
      mugs += object.category == "mug";
      mugs_at_cups += object.category == "mug" && (at - Eigen::Vector3d(1, 0, 0.5)).norm() < 0.3;
    }
    right += drinks == 1;
  }
  EXPECT_GE(right, kScenes * 3 / 4);
  EXPECT_GE(mugs_at_cups, 0.9 * mugs);
  EXPECT_NEAR(static_cast<double>(mugs) / (cups + mugs), 0.5, 0.25);
}

TEST(SceneTraining, GoesOnWhereItStopped) {
  const core::TemporaryFolder folder;
  WriteScenes(folder.path(), 50);
  const SceneDataset dataset(folder.path());
  core::Progress progress;
  SceneTrainingOptions options = Short(40);
  TrainSceneModel(dataset, SmallSceneModel(), options, folder.path() / "run", &progress);
  options.trainer.steps = 60;
  options.trainer.resume = true;
  const SceneTrainingReport report =
      TrainSceneModel(dataset, SmallSceneModel(), options, folder.path() / "run", &progress);
  ASSERT_EQ(report.losses.size(), 6u);
  EXPECT_EQ(report.losses.front().step, 10);
  EXPECT_EQ(report.losses.back().step, 60);
  EXPECT_EQ(SceneModel::Load(report.weights).metadata().steps, 60);
  SceneModelOptions other = SmallSceneModel();
  other.width = 32;
  EXPECT_THROW(TrainSceneModel(dataset, other, options, folder.path() / "run", &progress),
               core::Error);
}

// A thread that makes the batches changes no number, not after a resume either.
TEST(SceneTraining, PrefetchedBatchesGiveTheSameWeights) {
  const core::TemporaryFolder folder;
  WriteScenes(folder.path(), 150);
  const SceneDataset dataset(folder.path());
  core::Progress progress;
  SceneModelOptions model = SmallSceneModel();
  model.text = true;
  const auto train = [&](bool ahead, const std::string& name) {
    SceneTrainingOptions options = Short(20);
    options.batch = 16;
    options.text_pieces = 80;
    options.buffer = 40;  // blocks are read from the file during the training
    options.prefetch = ahead;
    TrainSceneModel(dataset, model, options, folder.path() / name, &progress);
    options.trainer.steps = 40;
    options.trainer.resume = true;
    return TrainSceneModel(dataset, model, options, folder.path() / name, &progress);
  };
  const SceneTrainingReport here = train(false, "here"), there = train(true, "there");
  EXPECT_EQ(LossesText(here.losses), LossesText(there.losses));
  EXPECT_EQ(core::ReadFile(here.weights), core::ReadFile(there.weights));
  EXPECT_EQ(here.losses.back().step, 40);
}

// Losses that are read only when they are reported are the same, and so are the weights.
TEST(SceneTraining, LossesThatStayOnTheDeviceAreTheSame) {
  const core::TemporaryFolder folder;
  WriteScenes(folder.path(), 100);
  const SceneDataset dataset(folder.path());
  core::Progress progress;
  const auto train = [&](bool stay, const std::string& name, bool capture = false) {
    SceneTrainingOptions options = Short(40);
    options.losses_on_device = stay;
    options.cuda_graph = capture;
    return TrainSceneModel(dataset, SmallSceneModel(), options, folder.path() / name, &progress);
  };
  const SceneTrainingReport read = train(false, "read"), stay = train(true, "stay");
  ASSERT_EQ(read.losses.size(), 4u);
  ASSERT_EQ(stay.losses.size(), 4u);
  for (size_t i = 0; i < read.losses.size(); ++i) {
    const LossRecord &a = read.losses[i], &b = stay.losses[i];
    EXPECT_EQ(a.step, b.step);
    for (const auto member :
         {&LossRecord::total, &LossRecord::translation, &LossRecord::rotation, &LossRecord::classes,
          &LossRecord::cross_entropy, &LossRecord::held_out}) {
      EXPECT_NEAR(a.*member, b.*member, 1e-5 * std::abs(a.*member));
    }
  }
  // Updates that a GPU would capture see each new batch.
  const SceneTrainingReport captured = train(true, "captured", true);
  EXPECT_EQ(LossesText(captured.losses), LossesText(stay.losses));
  EXPECT_EQ(core::ReadFile(captured.weights), core::ReadFile(stay.weights));
  SceneModelOptions prompted = SmallSceneModel();
  prompted.text = true;
  SceneTrainingOptions options = Short(40);
  options.cuda_graph = true;
  EXPECT_THROW(TrainSceneModel(dataset, prompted, options, folder.path() / "text", &progress),
               core::Error);
}

// Fused kernels, which Debian's libtorch has not, learn the same (tests/nn/run_with_libtorch2.py).
TEST(SceneTraining, FusedUpdatesLearnTheSame) {
  const core::TemporaryFolder folder;
  WriteScenes(folder.path(), 100);
  const SceneDataset dataset(folder.path());
  core::Progress progress;
  const auto train = [&](nn::UpdateKernels kernels, const std::string& name) {
    SceneTrainingOptions options = Short(20);
    options.trainer.kernels = kernels;
    TrainSceneModel(dataset, SmallSceneModel(), options, folder.path() / name, &progress);
    options.trainer.steps = 40;
    options.trainer.resume = true;
    options.losses_on_device = kernels == nn::UpdateKernels::kFused;
    return TrainSceneModel(dataset, SmallSceneModel(), options, folder.path() / name, &progress);
  };
  SceneTrainingReport fused;
  try {
    fused = train(nn::UpdateKernels::kFused, "fused");
  } catch (const core::Error& error) {
    GTEST_SKIP() << error.what();
  }
  const SceneTrainingReport separate = train(nn::UpdateKernels::kSeparate, "separate");
  ASSERT_EQ(fused.losses.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    const double total = separate.losses[i].total, held_out = separate.losses[i].held_out;
    EXPECT_NEAR(fused.losses[i].total, total, 1e-3 * total) << i;
    EXPECT_NEAR(fused.losses[i].held_out, held_out, 1e-3 * held_out) << i;
  }
}

TEST(SceneTraining, StopsBesideAThreadOfBatches) {
  const core::TemporaryFolder folder;
  WriteScenes(folder.path(), 50);
  core::Progress progress;
  SceneTrainingOptions options = Short(100000);
  options.prefetch = true;
  const fs::path weights = folder.path() / "run" / kWeightsFile;
  std::jthread request([&] {  // once a state was saved
    for (int i = 0; i < 6000 && !fs::exists(weights); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    core::RequestCancel();
  });
  EXPECT_THROW(TrainSceneModel(SceneDataset(folder.path()), SmallSceneModel(), options,
                               folder.path() / "run", &progress),
               core::Cancelled);
  core::ClearCancelRequest();
  EXPECT_GE(SceneModel::Load(weights).metadata().steps, 20);
}

void ExpectDivergence(bool losses_on_device) {
  const core::TemporaryFolder folder;
  WriteScenes(folder.path(), 50);
  const SceneDataset dataset(folder.path());
  core::Progress progress;
  SceneTrainingOptions options = Short(40);
  const SceneTrainingReport good =
      TrainSceneModel(dataset, SmallSceneModel(), options, folder.path() / "run", &progress);
  const std::string weights = core::ReadFile(good.weights);
  options.trainer.steps = 400;
  options.trainer.save_every = 1000;
  options.trainer.resume = true;
  options.trainer.learning_rate = 1e18;
  options.trainer.largest_norm = 1e30;
  options.losses_on_device = losses_on_device;
  try {
    TrainSceneModel(dataset, SmallSceneModel(), options, folder.path() / "run", &progress);
    FAIL() << "a rate of 1e18 did not diverge";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("diverged"), std::string::npos) << error.what();
  }
  EXPECT_EQ(core::ReadFile(good.weights), weights);
  EXPECT_EQ(SceneModel::Load(good.weights).metadata().steps, 40);
}

TEST(SceneTraining, KeepsTheLastGoodWeightsWhereItDiverges) {
  ExpectDivergence(false);
  ExpectDivergence(true);
}

TEST(SceneModel, RefusesWhatIsNone) {
  const core::TemporaryFolder folder;
  EXPECT_THROW(SceneModel::Load(folder.path() / "none.pt"), core::Error);
  core::WriteFile(folder.path() / "other.pt", "no weights");
  EXPECT_THROW(SceneModel::Load(folder.path() / "other.pt"), core::Error);
}

}  // namespace
}  // namespace simwright::scene
