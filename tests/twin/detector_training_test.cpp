#include "twin/detector_training.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "twin/object_detector.h"
#include "twin/table_picture.h"

namespace simwright::twin {
namespace {

DetectorTrainingOptions SmallTraining() {
  DetectorTrainingOptions options;
  options.network.channels = {8, 16, 16, 24};
  options.network.patch = 2;
  options.part_share = 0.25;
  options.scenes.width = options.scenes.height = 64;
  options.scenes.least_objects = 1;
  options.scenes.most_objects = 3;
  options.batch = 4;
  options.pool = 24;
  options.exchange = 1;
  options.trainer.steps = 150;
  options.trainer.learning_rate = 4e-3;
  options.trainer.save_every = 150;
  options.trainer.ema_decay = 0.9;
  return options;
}

// A small network learns which pixels show objects, and its file gives detections.
TEST(TrainDetector, LearnsAndWritesWeights) {
  const core::TemporaryFolder folder;
  const std::filesystem::path weights = folder.path() / "table_detector.pt";
  std::vector<double> overlap;
  core::Progress progress;
  TrainDetector({}, SmallTraining(), weights, &progress,
                [&](const asset_lift::PriorTrainingReport& report) {
                  overlap.push_back(report.metrics.front().second);
                });
  ASSERT_EQ(overlap.size(), 3u);
  EXPECT_GT(overlap.back(), overlap.front() + 0.05);
  EXPECT_GT(overlap.back(), 0.25);
  const ObjectDetector detector(weights);
  // A picture with objects has a larger share of object pixels than an empty one.
  TableSceneOptions options = SmallTraining().scenes;
  core::Rng rng(4);
  const TableScene scene = SampleTableScene({}, options, &rng);
  const core::Image picture = core::Resize(RenderTable(scene, {}, {2, 4, 2}, 1).color, 256, 192);
  const double empty = detector.Detect(core::Image(256, 192, 3, 128)).object_share;
  EXPECT_GT(detector.Detect(picture).object_share, empty + 0.005);
  EXPECT_THROW(detector.Detect(core::Image(20, 20, 3)), core::Error);
  EXPECT_THROW(ObjectDetector(folder.path() / "none.pt"), core::Error);
}

TEST(DetectorTrainingOptions, NamesWhatIsWrong) {
  DetectorTrainingOptions options = SmallTraining();
  options.scenes.width = 70;
  std::string error;
  EXPECT_FALSE(options.IsValid(&error));
  EXPECT_NE(error.find("multiples of 8 patches"), std::string::npos);
  options = SmallTraining();
  options.exchange = 25;
  EXPECT_FALSE(options.IsValid(&error));
  EXPECT_NE(error.find("pool"), std::string::npos);
}

}  // namespace
}  // namespace simwright::twin
