#include "twin/object_detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "library_fit/library_prior.h"
#include "rendered_table.h"
#include "twin/camera_guess.h"
#include "twin/observed_object.h"
#include "twin/table_scene.h"

namespace simwright::twin {
namespace {

namespace fs = std::filesystem;

constexpr int kTables = 3;

std::vector<TableScene> HeldOutTables() {
  TableSceneOptions options;
  options.width = 320;
  options.height = 240;
  options.first_seed = 1'000'000'000;
  std::vector<TableScene> tables;
  for (std::uint64_t number = 0; number < kTables; ++number) {
    core::Rng rng = core::StreamRng(91, number);
    tables.push_back(SampleTableScene({}, options, &rng));
  }
  return tables;
}

// The largest IoU of the pixels of object `index` with a detection.
double BestIou(const TablePicture& picture, int index, const std::vector<Detection>& found) {
  double best = 0.0;
  for (const Detection& detection : found) {
    double both = 0.0, either = 0.0;
    for (size_t p = 0; p < picture.label.size(); ++p) {
      const bool is_object = picture.label[p] == index;
      const bool is_found = detection.alpha.pixels[p] > 127;
      both += is_object && is_found;
      either += is_object || is_found;
    }
    best = std::max(best, both / std::max(1.0, either));
  }
  return best;
}

// The shipped weights find objects that they have not seen, and little else. A detection shows an
// object if their IoU is above 0.5.
TEST(ObjectDetector, FindsTheObjectsOfHeldOutTables) {
  const ObjectDetector detector(fs::path(SIMWRIGHT_SOURCE_DIR) / "models/table_detector.pt");
  int truths = 0, matched = 0, detections = 0;
  for (const TableScene& table : HeldOutTables()) {
    const TablePicture picture = RenderTable(table, {}, {2, 1, 1}, 1);
    const Detections found = detector.Detect(picture.color);
    for (size_t k = 0; k < table.objects.size(); ++k) {
      const auto index = static_cast<std::int16_t>(k);
      if (std::count(picture.label.begin(), picture.label.end(), index) < 60) continue;
      ++truths;
      matched += BestIou(picture, index, found.objects) > 0.5;
    }
    detections += static_cast<int>(found.objects.size());
    for (const Detection& object : found.objects) {
      EXPECT_GE(object.confidence, 0.45);
      EXPECT_LE(object.confidence, 1.0);
    }
  }
  ASSERT_GE(truths, 3 * kTables);
  EXPECT_GE(2.0 * matched / (truths + detections), 0.65)
      << matched << " of " << truths << " by " << detections;
}

// Objects that are seen from 20, 35 and 55 degrees tell the elevation better than the usual one of
// photos does, and the height at which they have their sizes.
TEST(GuessByObjects, TellsElevationAndHeight) {
  const library_fit::LibraryPrior prior(fs::path(SIMWRIGHT_SOURCE_DIR) / "models/library_prior.pt");
  double error = 0.0, usual_error = 0.0;
  for (const double degrees : {20.0, 35.0, 55.0}) {
    const double elevation = degrees * M_PI / 180.0;
    // The camera looks at the middle of the objects, 0.9 m away.
    const TableCamera camera{elevation, 0.0, 1.0, 0.9 * std::sin(elevation)};
    const double middle = 0.9 * std::cos(elevation);
    const RenderedTable table = RenderKinds({{"mug", 1'000'000'011, -0.18, middle, -0.6},
                                             {"cereal_box", 1'000'000'012, 0.0, middle + 0.1, 0.5},
                                             {"teapot", 1'000'000'013, 0.18, middle, 0.9},
                                             {"bowl", 1'000'000'014, 0.02, middle - 0.13, 0.0}},
                                            camera);
    const std::vector<ObservedObject> observed =
        ObserveObjects(table.picture.color, table.detections, 64);
    const TableCameraGuess usual;
    const TableCameraGuess guess = GuessByObjects(observed, {}, prior, 320, 240, usual);
    error += std::abs(guess.camera.elevation - elevation) / 3.0;
    usual_error += std::abs(usual.camera.elevation - elevation) / 3.0;
    EXPECT_LT(std::abs(std::log(guess.camera.height / camera.height)), 0.45) << degrees;
    EXPECT_LT(guess.elevation_error, usual.elevation_error);
    // Known numbers stay.
    TableCameraGuess known;
    known.camera.elevation = 0.3;
    known.elevation_error = known.log_height_error = 0.0;
    EXPECT_EQ(GuessByObjects(observed, {}, prior, 320, 240, known).camera.elevation, 0.3);
  }
  EXPECT_LT(error, 0.6 * usual_error);
  EXPECT_LT(error, 8.0 * M_PI / 180.0);
}

}  // namespace
}  // namespace simwright::twin
