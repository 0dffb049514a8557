#include "twin/depth_objects.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/twin/depth_pictures.h"
#include "twin/depth_agreement.h"
#include "twin/plane_hull.h"

namespace simwright::twin {
namespace {

const TableCamera kOver{0.7, 0.0, 1.1, 0.75};

DepthPlane PlaneOf(const core::FloatImage& depth) {
  TableCamera lens;
  lens.focal = kOver.focal;
  return FitTablePlane(depth, lens, 1, "");
}

// The IoU of the detection that shows most of what `truth` shows.
double BestIou(const Detection& truth, const std::vector<Detection>& found) {
  double best = 0.0;
  for (const Detection& detection : found) {
    int both = 0, either = 0;
    for (std::size_t i = 0; i < truth.alpha.pixels.size(); ++i) {
      const bool a = truth.alpha.pixels[i] > 127, b = detection.alpha.pixels[i] > 127;
      both += a && b ? 1 : 0;
      either += a || b ? 1 : 0;
    }
    best = std::max(best, static_cast<double>(both) / std::max(1, either));
  }
  return best;
}

RenderedTable FourObjects() {
  return RenderKinds({{"cereal_box", 1'000'000'012, 0.2, 1.15, 0.5},
                      {"mug", 1'000'000'011, -0.18, 0.8, -0.6},
                      {"bowl", 1'000'000'013, 0.08, 0.78, 0.0},
                      {"bottle", 1'000'000'016, -0.22, 1.15, 0.2}},
                     kOver);
}

TEST(ObjectsAbovePlane, FindsWhatStandsOnTheTable) {
  const RenderedTable table = FourObjects();
  for (const double noise : {0.0, 0.0015}) {
    const core::FloatImage depth = DepthOf(table, noise);
    const std::vector<Detection> found = ObjectsAbovePlane(depth, PlaneOf(depth));
    EXPECT_EQ(found.size(), 4u) << noise;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_GE(BestIou(table.detections[k], found), 0.7) << k << " " << noise;
    }
    for (std::size_t k = 1; k < found.size(); ++k) {
      EXPECT_FALSE(found[k].cut);
      EXPECT_EQ(found[k].confidence, 1.0);
    }
  }
}

// A wall at the table's edge and unmeasured pixels within an object.
TEST(ObjectsAbovePlane, LeavesTheWallAndClosesHoles) {
  RenderedTable table = FourObjects();
  core::FloatImage depth = DepthOf(table);
  const core::Camera& camera = table.scene.camera;
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      // The wall y = 1.5 hides the endless table behind it.
      const double wall = 1.5 / camera.Ray(Eigen::Vector2d(x + 0.5, y + 0.5)).y();
      float& value = *depth.At(x, y);
      if (wall > 0.0 && (value == 0.0f || value > wall)) value = static_cast<float>(wall);
    }
  }
  const Eigen::AlignedBox2d box = table.detections[0].box;
  const Eigen::Vector2d middle = box.center();
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      *depth.At(static_cast<int>(middle.x()) + dx, static_cast<int>(middle.y()) + dy) = 0.0f;
    }
  }
  const std::vector<Detection> found = ObjectsAbovePlane(depth, PlaneOf(depth));
  ASSERT_EQ(found.size(), 4u);
  const auto shows = [&](const Detection& detection) {
    return *detection.alpha.At(static_cast<int>(middle.x()), static_cast<int>(middle.y())) > 127;
  };
  EXPECT_EQ(std::count_if(found.begin(), found.end(), shows), 1);
}

TEST(ObjectsAbovePlane, FindsNothingOnAnEmptyTable) {
  const core::FloatImage depth = DepthOf(RenderKinds({}, kOver));
  EXPECT_TRUE(ObjectsAbovePlane(depth, PlaneOf(depth)).empty());
}

TEST(ObjectsAbovePlane, FindsFortyObjects) {
  const TableCamera high{1.0, 0.0, 1.0, 1.4};
  RenderedTable table;
  for (int k = 0; k < 40; ++k) {
    TableObject object;
    object.instance = library_fit::SampleInstance(library_fit::FindFitKind("apple"),
                                                  1'000'000'000u + static_cast<unsigned>(k));
    object.visual = library_fit::InstanceMesh(object.instance);
    object.world_from_object.translation() =
        Eigen::Vector3d(-0.49 + 0.14 * (k % 8), 0.55 + 0.15 * (k / 8), 0.0);
    table.scene.objects.push_back(std::move(object));
  }
  table.scene.table.endless = true;
  table.scene.camera = high.At(480, 360);
  table.picture = RenderTable(table.scene, {}, {1, 1, 1}, 1);
  const core::FloatImage depth = DepthOf(table);
  TableCamera lens;
  lens.focal = high.focal;
  const std::vector<Detection> found = ObjectsAbovePlane(depth, FitTablePlane(depth, lens, 1, ""));
  EXPECT_EQ(found.size(), 40u);
}

// A fit at its true place agrees; the same outline from 1.3 times the distance does not.
TEST(CompareWithDepth, ReportsAFitAtAnotherDistance) {
  const RenderedTable scene = FourObjects();
  Detections detections;
  detections.objects = scene.detections;
  TableReconstruction table;
  table.camera = kOver;
  for (std::size_t k = 0; k < 4; ++k) {
    ReconstructedObject object;
    object.detection = static_cast<int>(k);
    object.fit.instance = scene.scene.objects[k].instance;
    const Eigen::Isometry3d& pose = scene.scene.objects[k].world_from_object;
    object.fit.pose = {pose.translation().x(), pose.translation().y(),
                       std::atan2(pose.linear()(1, 0), pose.linear()(0, 0))};
    table.objects.push_back(object);
  }
  const core::FloatImage depth = DepthOf(scene);
  EXPECT_TRUE(CompareWithDepth(table, detections, depth).empty());
  core::FloatImage farther = depth;
  for (float& value : farther.values) value *= 1.0f / 1.3f;
  EXPECT_EQ(CompareWithDepth(table, detections, farther).size(), 4u);
  const core::Findings findings = CompareWithDepth(table, detections, farther);
  EXPECT_EQ(findings[0].code, "twin-depth-disagrees");
  EXPECT_NEAR(findings[0].figure, 0.3, 0.02);
}

TEST(PlaneHull, TellsHowDeepAPointIsInside) {
  const PlaneHull square({{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {1, 0}, {0.5, 0.5}});
  EXPECT_EQ(square.corners().size(), 4u);
  EXPECT_NEAR(square.DepthInside({1.0, 0.25}), 0.25, 1e-12);
  EXPECT_NEAR(square.DepthInside({1.0, 1.0}), 1.0, 1e-12);
  EXPECT_LT(square.DepthInside({3.0, 1.0}), 0.0);
  EXPECT_LT(PlaneHull({{0, 0}, {1, 1}}).DepthInside({0.5, 0.5}), 0.0);
  EXPECT_LT(PlaneHull({}).DepthInside({0.0, 0.0}), 0.0);
}

}  // namespace
}  // namespace simwright::twin
