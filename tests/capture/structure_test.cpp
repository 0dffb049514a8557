#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/structure_from_motion.h"
#include "core/error.h"
#include "core/random.h"
#include "tests/capture/camera_alignment.h"
#include "tests/capture/mat_photos.h"

namespace simwright::capture {
namespace {

constexpr double kDegreeInRadian = std::numbers::pi / 180.0;

// Points of a table and of a ball on it, as cameras of an orbit see them: with noise, and with
// observations of other points among them.
struct MadeTracks {
  StructureInput input;
  std::vector<Eigen::Isometry3d> poses;
  Lens lens;
};

MadeTracks MakeTracks(int photos, int points, double noise, double wrong, std::uint64_t seed) {
  MadeTracks made;
  made.lens = PhoneLens(1600, 1200, 65 * kDegreeInRadian);
  made.poses =
      OrbitPoses(photos, {20 * kDegreeInRadian, 40 * kDegreeInRadian, 60 * kDegreeInRadian}, 0.15,
                 made.lens, seed);
  core::Rng rng(seed);
  for (int i = 0; i < photos; ++i) {
    made.input.photos.push_back({made.lens.width, made.lens.height, 0.0, std::to_string(i)});
  }
  for (int p = 0; p < points; ++p) {
    const Eigen::Vector3d on_ball =
        0.06 * core::UniformDirection(rng) + Eigen::Vector3d(0, 0, 0.06);
    const Eigen::Vector3d on_table(core::Uniform(rng, -0.2, 0.2), core::Uniform(rng, -0.2, 0.2), 0);
    const Eigen::Vector3d point = p % 2 == 0 ? on_ball : on_table;
    FeatureTrack track;
    for (int i = 0; i < photos; ++i) {
      const Eigen::Vector3d at = made.poses[static_cast<std::size_t>(i)].inverse() * point;
      Eigen::Vector2d pixel = made.lens.Project(at);
      // Features are found again in a few neighbouring photos.
      if (core::Uniform(rng) < 0.5) continue;
      if (core::Uniform(rng) < wrong) {
        pixel = {core::Uniform(rng, 0, 1600), core::Uniform(rng, 0, 1200)};
      }
      pixel += noise * Eigen::Vector2d(core::Normal(rng), core::Normal(rng));
      if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > 1600 || pixel.y() > 1200) continue;
      track.photos.push_back(i);
      track.pixels.push_back(pixel);
    }
    if (track.photos.size() >= 2) made.input.tracks.push_back(track);
  }
  return made;
}

TEST(StructureFromMotion, FindsCamerasOfTracksWithNoiseAndOutliers) {
  const MadeTracks made = MakeTracks(12, 500, 0.5, 0.05, 3);
  core::Progress progress;
  const Structure structure = ReconstructStructure(made.input, {}, &progress);
  EXPECT_TRUE(structure.findings.empty());
  const CameraAlignment alignment = AlignCameras(structure, made.poses);
  EXPECT_EQ(alignment.registered, 12);
  EXPECT_LT(alignment.worst_percent, 0.2);
  ASSERT_EQ(structure.lenses.size(), 1u);
  EXPECT_NEAR(structure.lenses[0].fx / made.lens.fx, 1.0, 0.003);
  // Half a pixel of noise on each coordinate, less what the fitted points absorb.
  double observations = 0.0;
  for (const Structure::View& view : structure.views) observations += view.points;
  const double fitted = 3.0 * static_cast<double>(structure.points.size());
  EXPECT_NEAR(structure.error, 0.5 * std::sqrt(2.0 - fitted / observations), 0.02);
  EXPECT_GT(structure.points.size(), 440u);
}

TEST(StructureFromMotion, GivesTheSameBytesAgain) {
  const MadeTracks made = MakeTracks(6, 200, 0.5, 0.05, 5);
  core::Progress progress;
  const Structure one = ReconstructStructure(made.input, {}, &progress);
  const Structure two = ReconstructStructure(made.input, {}, &progress);
  ASSERT_EQ(one.points.size(), two.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    EXPECT_EQ(one.points[i].position, two.points[i].position);
  }
}

TEST(StructureFromMotion, NamesThePhotosThatDoNotOverlap) {
  MadeTracks made = MakeTracks(10, 300, 0.3, 0.0, 7);
  // The last two photos share tracks with nothing else.
  for (FeatureTrack& track : made.input.tracks) {
    while (!track.photos.empty() && track.photos.back() >= 8) {
      track.photos.pop_back();
      track.pixels.pop_back();
    }
  }
  core::Progress progress;
  const Structure structure = ReconstructStructure(made.input, {}, &progress);
  ASSERT_EQ(structure.findings.size(), 2u);
  EXPECT_EQ(structure.findings[0].code, "photo-not-placed");
  EXPECT_EQ(structure.findings[0].place, "8");
  EXPECT_EQ(structure.findings[1].place, "9");
  EXPECT_EQ(AlignCameras(structure, made.poses).registered, 8);
}

TEST(StructureFromMotion, SharesALensOverPortraitAndLandscape) {
  MadeTracks made = MakeTracks(10, 400, 0.3, 0.0, 9);
  // Two photos are turned by a quarter: (x, y) becomes (1200 - y, x).
  for (int i = 4; i < 6; ++i) {
    StructureInput::Photo& photo = made.input.photos[static_cast<std::size_t>(i)];
    std::swap(photo.width, photo.height);
  }
  for (FeatureTrack& track : made.input.tracks) {
    for (std::size_t k = 0; k < track.photos.size(); ++k) {
      if (track.photos[k] != 4 && track.photos[k] != 5) continue;
      track.pixels[k] = Eigen::Vector2d(1200.0 - track.pixels[k].y(), track.pixels[k].x());
    }
  }
  core::Progress progress;
  const Structure structure = ReconstructStructure(made.input, {}, &progress);
  ASSERT_EQ(structure.lenses.size(), 2u);
  EXPECT_EQ(AlignCameras(structure, made.poses).registered, 10);
  EXPECT_LT(AlignCameras(structure, made.poses).worst_percent, 1.0);
}

TEST(StructureFromMotion, RefusesPhotosWithNothingInCommon) {
  StructureInput input;
  core::Progress progress;
  EXPECT_THROW(ReconstructStructure(input, {}, &progress), core::Error);
  input.photos.assign(4, {640, 480, 0.0, "a.jpg"});
  EXPECT_THROW(ReconstructStructure(input, {}, &progress), core::Error);
  FeatureTrack track;
  track.photos = {1, 1};
  track.pixels.assign(2, Eigen::Vector2d(3, 3));
  input.tracks.push_back(track);
  EXPECT_THROW(ReconstructStructure(input, {}, &progress), core::Error);
}

}  // namespace
}  // namespace simwright::capture
