// One model of two scene types: a room, of which each scene has a chair far from the origin, and a
// desk, of which each has a cup or a pen close to it.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "scene/dataset/tokens.h"
#include "scene/model/scene_model.h"
#include "scene/model/training.h"
#include "tests/scene/small_scene_model.h"

namespace simwright::scene {
namespace {
namespace fs = std::filesystem;

Vocabulary RoomWords() {
  return {"pantry_shelf", 6, {"chair", "cup", "floor"}, {false, false, true}};
}
Vocabulary DeskWords() {
  return {"dimsum", 3, {"cup", "desk", "pen"}, {false, true, false}};
}

SceneObject Placed(const std::string& category, double x, double y, double z) {
  SceneObject object;
  object.category = category;
  object.world_from_object.translation() << x, y, z;
  return object;
}

// Writes scenes of one type.
void WriteType(const fs::path& folder, const Vocabulary& vocabulary, int count) {
  SceneShard part{vocabulary, {5, 0, "{}", "{}", "1"}, {}, {}};
  const size_t size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  core::Rng rng = core::StreamRng(4, 0);
  for (int i = 0; i < count; ++i) {
    std::vector<SceneObject> objects;
    if (vocabulary.type == "dimsum") {
      objects = {Placed("desk", 0, 0, 0),
                 Placed(i % 2 == 0 ? "cup" : "pen", 0.2 + 0.02 * core::Normal(rng), 0.1, 0.7)};
    } else {
      objects = {Placed("floor", 0, 0, 0), Placed("chair", 4.0 + 0.1 * core::Normal(rng), -5, 0)};
      if (i % 3 == 0) objects.push_back(Placed("cup", 1.0, 1.0, 0.0));
    }
    part.tokens.resize(part.tokens.size() + size);
    EncodeScene(objects, vocabulary, &part.tokens[part.tokens.size() - size]);
    part.attempts.push_back({3, 3, 0, true, true, 0, 0, 0});
  }
  WriteShard(part, folder / ShardName(0));
}

SceneModelOptions CombinedModel() {
  SceneModelOptions options = SmallSceneModel();
  options.text = true;
  return options;
}

SceneTrainingOptions CombinedTraining(int steps) {
  core::SetThreadCount(1);  // beside other tests
  SceneTrainingOptions options;
  options.trainer.steps = steps;
  options.trainer.learning_rate = 2e-3;
  options.trainer.ema_decay = 0.98;
  options.batch = 48;
  options.text_pieces = 96;
  for (const char* const category : {"cup", "pen", "chair"}) {
    options.sizes[category] = RoundSize(0.1, 0.1);
  }
  return options;
}

Eigen::Vector3d PlaceInRoom(const std::string& category) {
  if (category == "chair") return {4.0, -5.0, 0.0};
  if (category == "cup") return {1.0, 1.0, 0.0};
  return Eigen::Vector3d::Zero();
}

class SeveralSceneTypes : public testing::Test {
 protected:
  void SetUp() override {
    for (const Vocabulary& one : {RoomWords(), DeskWords()}) {
      fs::create_directories(folder_.path() / one.type);
      WriteType(folder_.path() / one.type, one, 120);
      datasets_.emplace_back(folder_.path() / one.type);
    }
    for (const SceneDataset& one : datasets_) pointers_.push_back(&one);
  }

  core::TemporaryFolder folder_;
  std::vector<SceneDataset> datasets_;
  std::vector<const SceneDataset*> pointers_;
  core::Progress silent_;
};

TEST_F(SeveralSceneTypes, ASceneTypeHasItsObjectsAtItsPlaces) {
  const SceneTrainingReport report = TrainSceneModel(
      pointers_, CombinedModel(), CombinedTraining(300), folder_.path() / "run", &silent_);
  EXPECT_EQ(report.training_scenes, 216);
  EXPECT_EQ(report.held_out_scenes, 24);
  EXPECT_THROW(SceneModel::Load(report.weights), core::Error);
  EXPECT_THROW(SceneModel::Load(report.weights, {}, "restaurant_low"), core::Error);
  const SceneModelMetadata metadata = ReadSceneModelMetadata(report.weights);
  EXPECT_EQ(metadata.TypeNames(), (std::vector<std::string>{"pantry_shelf", "dimsum"}));
  EXPECT_EQ(metadata.vocabulary.categories,
            (std::vector<std::string>{"chair", "cup", "desk", "floor", "pen"}));
  for (const Vocabulary& words : {RoomWords(), DeskWords()}) {
    const SceneModel model = SceneModel::Load(report.weights, {}, words.type);
    const Vocabulary& vocabulary = model.metadata().vocabulary;
    EXPECT_EQ(vocabulary.entries, words.entries);
    EXPECT_EQ(vocabulary.type, words.type);
    EXPECT_EQ(model.metadata().training_scenes, 108);
    SampleOptions options;
    options.steps = 50;
    constexpr int kScenes = 32;
    const std::vector<float> tokens = model.Sample(kScenes, options, &silent_);
    const size_t size = tokens.size() / kScenes;
    int all = 0, own = 0, right = 0;
    for (size_t i = 0; i < kScenes; ++i) {
      for (const SceneObject& object : DecodeScene(&tokens[i * size], vocabulary)) {
        ++all;
        own += words.ClassOf(object.category) >= 0;
        const Eigen::Vector3d at = object.world_from_object.translation();
        right += words.type == "dimsum" ? at.norm() < 1.0
                                        : (at - PlaceInRoom(object.category)).norm() < 1.5;
      }
    }
    EXPECT_GE(all, kScenes) << words.type;
    EXPECT_GE(own, 0.85 * all) << words.type;
    EXPECT_GE(right, 0.85 * all) << words.type;
  }
}

TEST_F(SeveralSceneTypes, RefusesDatasetsThatDoNotFitTogether) {
  SceneModelOptions without_text = CombinedModel();
  without_text.text = false;
  EXPECT_THROW(TrainSceneModel(pointers_, without_text, CombinedTraining(2), folder_.path() / "run",
                               &silent_),
               core::Error);
  EXPECT_THROW(TrainSceneModel({pointers_[0], pointers_[0]}, CombinedModel(), CombinedTraining(2),
                               folder_.path() / "run", &silent_),
               core::Error);
  Vocabulary fixed_cup = DeskWords();
  fixed_cup.welded[0] = true;
  fs::create_directories(folder_.path() / "fixed");
  WriteType(folder_.path() / "fixed", fixed_cup, 4);
  const SceneDataset fixed(folder_.path() / "fixed");
  EXPECT_THROW(TrainSceneModel({pointers_[0], &fixed}, CombinedModel(), CombinedTraining(2),
                               folder_.path() / "run", &silent_),
               core::Error);
}

}  // namespace
}  // namespace simwright::scene
