#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "capture/object_frame.h"
#include "core/error.h"
#include "core/random.h"
#include "tests/capture/mat_photos.h"

namespace simwright::capture {
namespace {

constexpr double kFrameDegree = std::numbers::pi / 180.0;

// Points of a table at a slant and of a cube on it; the truth's frame is turned, moved and scaled.
TEST(ObjectFrame, StandsTheObjectOnTheTable) {
  core::Rng rng(3);
  Structure structure;
  structure.lenses.push_back(PhoneLens(1600, 1200, 65 * kFrameDegree));
  const std::vector<Eigen::Isometry3d> poses =
      OrbitPoses(8, {30 * kFrameDegree, 50 * kFrameDegree}, 0.15, structure.lenses[0], 3);
  Eigen::Isometry3d moved(Eigen::AngleAxisd(0.8, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()));
  moved.translation() = Eigen::Vector3d(4, -2, 1);
  const auto place = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return 3.0 * (moved * p); };
  for (const Eigen::Isometry3d& pose : poses) {
    Structure::View view;
    view.registered = true;
    view.world_from_camera.linear() = moved.linear() * pose.linear();
    view.world_from_camera.translation() = place(pose.translation());
    structure.views.push_back(view);
  }
  const auto add = [&](const Eigen::Vector3d& p) {
    structure.points.push_back({place(p), static_cast<int>(structure.tracks.size())});
    FeatureTrack track;
    track.photos = {0, 1, 2};
    track.pixels.assign(3, Eigen::Vector2d::Zero());
    structure.tracks.push_back(track);
  };
  for (int i = 0; i < 400; ++i) {
    add({core::Uniform(rng, -0.3, 0.3), core::Uniform(rng, -0.3, 0.3), 0.0005 * core::Normal(rng)});
    const Eigen::Vector3d d = core::UniformDirection(rng);
    add(0.05 * d / d.cwiseAbs().maxCoeff() + Eigen::Vector3d(0.01, 0, 0.05));
  }
  const ObjectFrame frame = PlaceOnTable(1, &structure);
  EXPECT_TRUE(frame.table_found);
  EXPECT_EQ(frame.others, 0);
  // Heights of cameras over their distances do not depend on the scale.
  std::vector<double> distances;
  for (const Eigen::Isometry3d& pose : poses) {
    distances.push_back((pose.translation() - Eigen::Vector3d(0, 0, 0.045)).norm());
  }
  std::nth_element(distances.begin(), distances.begin() + 4, distances.end());
  const double scale =
      structure.views[0].world_from_camera.translation().z() / poses[0].translation().z();
  EXPECT_NEAR(scale * distances[4], 1.0, 0.05);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(structure.views[i].world_from_camera.translation().z(),
                scale * poses[i].translation().z(), 0.004);
  }
  EXPECT_NEAR(frame.box.sizes().z(), scale * 0.1, 0.01 * scale);
  EXPECT_NEAR(frame.box.center().x(), 0.0, 1e-6);
  EXPECT_NEAR(frame.box.center().y(), 0.0, 1e-6);
}

TEST(ObjectFrame, RefusesTooFewCameras) {
  Structure structure;
  structure.views.resize(2);
  EXPECT_THROW(PlaceOnTable(1, &structure), core::Error);
}

}  // namespace
}  // namespace simwright::capture
