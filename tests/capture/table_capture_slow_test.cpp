#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include <opencv2/imgproc.hpp>

#include "capture/object_masks.h"
#include "capture/table_capture.h"
#include "core/error.h"
#include "tests/capture/camera_alignment.h"
#include "tests/capture/mat_photos.h"

namespace simwright::capture {
namespace {

constexpr double kDegreeRad = std::numbers::pi / 180.0;
const Eigen::Vector3d kBoxSides(0.07, 0.09, 0.1);

struct TablePhotos {
  std::vector<Eigen::Isometry3d> poses;
  std::vector<core::Image> photos;

  CaptureSource Source() const {
    CaptureSource source;
    for (std::size_t i = 0; i < photos.size(); ++i) {
      source.photos.push_back({"photo" + std::to_string(i) + ".jpg", 0.0});
    }
    source.read = [this](int i) { return photos[static_cast<std::size_t>(i)]; };
    return source;
  }
};

TablePhotos PhotographBox(int count, std::uint64_t seed) {
  MatPhotoOptions options;
  options.mat = false;
  options.fine_table = true;
  options.samples_per_side = 1;
  options.seed = seed;
  options.lens = PhoneLens(800, 600, 65 * kDegreeRad);
  TablePhotos made;
  made.poses = OrbitPoses(count, {38 * kDegreeRad}, 0.11, options.lens, seed);
  for (MatPhoto& photo : RenderMatPhotos(PaintedBox(kBoxSides, seed), made.poses, options)) {
    made.photos.push_back(std::move(photo.photo));
  }
  return made;
}

const TablePhotos& BoxPhotos() {
  static const TablePhotos photos = PhotographBox(16, 5);
  return photos;
}

TableCaptureOptions FastOptions() {
  TableCaptureOptions options;
  options.features.max_features = 1500;
  options.capture.first_side = 200;
  options.capture.crop_side = 280;
  options.capture.hull_cells = 64;
  return options;
}

TEST(TableCapture, FindsSizeAndPlaceOfAPaintedBox) {
  const TablePhotos& made = BoxPhotos();
  core::Progress progress;
  Capture capture = CaptureOnTable(made.Source(), FastOptions(), &progress);
  EXPECT_EQ(capture.views.size(), 16u);
  EXPECT_FALSE(capture.paper.has_value());
  const CameraAlignment alignment = AlignCameras(capture, made.poses);
  EXPECT_LT(alignment.worst_percent, 1.0);
  core::TriangleMesh truth = PaintedBox(kBoxSides, 5).mesh;
  core::Transform(alignment.truth_from_found.inverse(), &truth);
  for (const CaptureView& view : capture.views) {
    const core::FloatImage expected = SilhouetteOf(truth, view.camera);
    double both = 0.0, either = 0.0;
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
      const bool wanted = expected.values[i] >= 0.5f, found = view.opacity.values[i] >= 0.5f;
      both += wanted && found;
      either += wanted || found;
    }
    EXPECT_GT(both / either, 0.94) << view.index;
  }
  // A ring of photos leaves the hull larger than the box, never smaller.
  const Eigen::AlignedBox3d box = core::Bounds(truth), hull = core::Bounds(capture.hull);
  EXPECT_NEAR(hull.min().z(), box.min().z(), 0.03 * box.sizes().z());
  EXPECT_GT(hull.max().z(), box.max().z() - 0.03 * box.sizes().z());
  EXPECT_LT(hull.max().z(), box.max().z() + 0.4 * box.sizes().z());
  // Scaling moves cameras and hull alike.
  const double distance = capture.views[0].camera.position().norm();
  const double height = core::Bounds(capture.hull).sizes().z();
  ScaleCapture(2.0, &capture);
  EXPECT_NEAR(capture.views[0].camera.position().norm(), 2.0 * distance, 1e-9);
  EXPECT_NEAR(core::Bounds(capture.hull).sizes().z(), 2.0 * height, 1e-9);
}

TEST(TableCapture, NamesABlurredPhotoAndPhotosOfAnotherScene) {
  TablePhotos mixed = BoxPhotos();
  cv::Mat blurred(600, 800, CV_8UC3, mixed.photos[3].pixels.data());
  cv::GaussianBlur(blurred, blurred, {0, 0}, 9.0);
  const TablePhotos other = PhotographBox(3, 77);
  mixed.photos[12] = other.photos[0];
  core::Progress progress;
  const Capture capture = CaptureOnTable(mixed.Source(), FastOptions(), &progress);
  const auto has = [&](const std::string& code, const std::string& place) {
    for (const core::Finding& finding : capture.findings) {
      if (finding.code == code && finding.place == place) return true;
    }
    return false;
  };
  EXPECT_TRUE(has("photo-blurred", "photo3.jpg"));
  EXPECT_FALSE(has("photo-blurred", "photo4.jpg"));
  EXPECT_TRUE(has("photo-not-placed", "photo12.jpg"));
  EXPECT_FALSE(has("photo-not-placed", "photo11.jpg"));
}

TEST(TableCapture, RefusesPhotosThatDoNotOverlapInOneLine) {
  TablePhotos few;
  few.photos.assign(5, BoxPhotos().photos[0]);
  for (std::size_t i = 1; i < 5; ++i) few.photos[i] = core::Image(800, 600, 3, 90);
  core::Progress progress;
  try {
    CaptureOnTable(few.Source(), FastOptions(), &progress);
    ADD_FAILURE();
  } catch (const core::Error& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find("no two photos show the same scene"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
  few.photos.resize(3);
  EXPECT_THROW(CaptureOnTable(few.Source(), FastOptions(), &progress), core::Error);
}

TEST(FeatureTracks, PlaceTheCamerasOfRenderedPhotos) {
  MatPhotoOptions options;
  options.mat = false;
  options.fine_table = true;
  options.samples_per_side = 1;
  options.lens = PhoneLens(800, 600, 65 * kDegreeRad);
  const auto poses = OrbitPoses(16, {40 * kDegreeRad}, 0.13, options.lens, 3);
  const auto photos = RenderMatPhotos(PaintedBox({0.07, 0.09, 0.1}, 5), poses, options);
  core::Progress progress;
  StructureInput input;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    input.photos.push_back({800, 600, 0.0, std::to_string(i)});
  }
  FeatureTrackOptions features;
  features.max_features = 1500;
  input.tracks =
      FindFeatureTracks(
          16, [&](int i) { return photos[static_cast<std::size_t>(i)].photo; }, features, &progress)
          .tracks;
  EXPECT_GT(input.tracks.size(), 500u);
  const Structure structure = ReconstructStructure(input, {}, &progress);
  const CameraAlignment alignment = AlignCameras(structure, poses);
  EXPECT_EQ(alignment.registered, 16);
  EXPECT_LT(alignment.worst_percent, 1.0);
  EXPECT_NEAR(structure.lenses[0].fx / options.lens.fx, 1.0, 0.01);
  EXPECT_THROW(FindFeatureTracks(1, nullptr, features, &progress), core::Error);
}

}  // namespace
}  // namespace simwright::capture
