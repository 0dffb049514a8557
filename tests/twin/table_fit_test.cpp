#include "twin/table_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "tests/twin/rendered_table.h"
#include "twin/camera_search.h"
#include "twin/table_reconstruction.h"

namespace simwright::twin {
namespace {

const TableCamera kAbove{0.62, 0.0, 1.15, 0.7};

const library_fit::LibraryPrior& Prior() {
  static const library_fit::LibraryPrior prior(std::filesystem::path(SIMWRIGHT_SOURCE_DIR) /
                                               "models/library_prior.pt");
  return prior;
}

Eigen::Vector3d Middle(const TableFit& fit) {
  return fit.pose.WorldFromObject() *
         core::Bounds(library_fit::InstanceMesh(fit.instance).mesh).center();
}

Eigen::Vector3d Middle(const TableObject& object) {
  return object.world_from_object * core::Bounds(object.visual.mesh).center();
}

// Instances of held-out seeds, seen by a known camera: position, size and yaw are metric.
TEST(FitOnTable, IsMetricUnderAKnownCamera) {
  const RenderedTable table = RenderKinds(
      {{"mug", 1'000'000'011, -0.1, 0.9, -0.6}, {"cereal_box", 1'000'000'012, 0.12, 1.05, 0.5}},
      kAbove);
  const std::vector<ObservedObject> observed =
      ObserveObjects(table.picture.color, table.detections, 64);
  TableFitOptions options;
  options.most_kinds = 1;
  options.starts = 1;
  for (size_t k = 0; k < 2; ++k) {
    const TableObject& truth = table.scene.objects[k];
    options.kinds = {truth.instance.kind};
    const TableFit fit = FitOnTable(Prior(), observed[k], table.scene.camera, options).front();
    EXPECT_GT(fit.agreement.iou, 0.9) << k;
    EXPECT_LT((Middle(fit) - Middle(truth)).head<2>().norm(), 0.01) << k;
    const Eigen::Vector3d size = core::Bounds(library_fit::InstanceMesh(fit.instance).mesh).sizes();
    EXPECT_NEAR(size.prod() / core::Bounds(truth.visual.mesh).sizes().prod(), 1.0, 0.2) << k;
  }
}

// A toaster 4 cm high has walls without height above its floor, which are no solids.
TEST(RefineOnTable, LeavesSizesThatNoSolidHas) {
  RenderedTable table;
  TableObject truth;
  truth.instance = library_fit::SampleInstance(library_fit::FindFitKind("toaster"), 1'000'000'011);
  truth.instance.size.z() = 0.055;
  truth.visual = library_fit::InstanceMesh(truth.instance);
  const TablePose pose{0.02, 0.9, 0.4};
  truth.world_from_object = pose.WorldFromObject();
  table.scene.objects.push_back(truth);
  table.scene.table.endless = true;
  Picture(kAbove, &table);
  const std::vector<ObservedObject> observed =
      ObserveObjects(table.picture.color, table.detections, 64);
  TableFit fit;
  fit.instance = truth.instance;
  fit.instance.size.z() = 0.04;
  fit.pose = pose;
  ASSERT_THROW(library_fit::InstanceMesh(fit.instance), core::Error);
  RefineOnTable(Prior(), observed[0], table.scene.camera, {}, &fit);
  EXPECT_LT(fit.shape_loss, 1.0);
  EXPECT_GT(fit.agreement.iou, 0.85);
  EXPECT_NEAR(core::Bounds(library_fit::InstanceMesh(fit.instance).mesh).sizes().z() /
                  core::Bounds(truth.visual.mesh).sizes().z(),
              1.0, 0.15);
}

TEST(MovedToCamera, KeepsTheBoxInThePicture) {
  TableFit fit;
  fit.instance = library_fit::SampleInstance(library_fit::FindFitKind("jar"), 4);
  fit.pose = {0.05, 0.9, 0.7};
  const core::Camera before = kAbove.At(640, 480);
  TableCamera other = kAbove;
  other.elevation += 0.06;
  other.focal *= 1.1;
  const core::Camera after = other.At(640, 480);
  const TableFit moved = MovedToCamera(fit, before, after);
  const auto box = [](const TableFit& of, const core::Camera& camera) {
    return ProjectedBox(library_fit::InstanceMesh(of.instance).mesh, {of.pose, 1.0}, camera);
  };
  EXPECT_LT((box(fit, before).center() - box(moved, after).center()).norm(), 0.5);
  EXPECT_NEAR(box(fit, before).sizes().sum(), box(moved, after).sizes().sum(), 1.0);
}

// Two kinds explain an object: with the other objects' sizes the scale tells which it is.
TEST(ChooseScale, TakesTheScaleOfUsualSizes) {
  const auto with = [](double loss, double off, int kind) {
    TableFit fit;
    fit.shape_loss = loss;
    fit.size_off.setConstant(off);
    fit.size_error.setConstant(0.05);
    fit.probability = 0.5;
    fit.instance.kind = kind;
    return fit;
  };
  // Two objects are by 0.2 too large; the third is right as kind 7 or by 0.2 too large as kind 8.
  const std::vector<std::vector<TableFit>> alternatives{
      {with(0.1, 0.2, 1)}, {with(0.1, 0.2, 2)}, {with(0.1, 0.0, 7), with(0.11, 0.2, 8)}};
  const ScaleChoice free = ChooseScale(alternatives, 0.5);
  EXPECT_NEAR(free.log_scale, -0.2, 0.011);
  EXPECT_EQ(free.choice, (std::vector<int>{0, 0, 1}));
  EXPECT_GT(free.error, 0.0);
  const ScaleChoice known = ChooseScale(alternatives, 0.0);
  EXPECT_EQ(known.log_scale, 0.0);
  EXPECT_EQ(known.choice, (std::vector<int>{0, 0, 0}));
}

TEST(ReconstructTable, RefusesAPhotoWithoutObjects) {
  core::Progress progress;
  EXPECT_THROW(ReconstructTable(core::Image(64, 64, 3), {}, Prior(), {}, &progress), core::Error);
}

}  // namespace
}  // namespace simwright::twin
