// The whole pipeline at a small size: trains both priors for a few steps and reconstructs a photo
// with them.
#include <gtest/gtest.h>

#include <atomic>

#include "asset_lift/lift.h"
#include "asset_lift/priors/learned_view_prior.h"
#include "asset_lift/priors/prior_training.h"
#include "asset_lift/priors/shape_prior.h"
#include "asset_lift/priors/training_shapes.h"
#include "core/error.h"
#include "core/files.h"
#include "geometry/mesh_validity.h"
#include "nn/checkpoint.h"
#include "render/forward.h"

namespace simwright::asset_lift {
namespace {

// Three asymmetric boxes, so that the silhouette alone does not yield a solid of revolution.
core::TexturedMesh Steps() {
  core::TexturedMesh mesh;
  const auto add = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    const int first = static_cast<int>(mesh.mesh.vertices.size());
    for (int i = 0; i < 8; ++i) {
      mesh.mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                      i & 4 ? high.z() : low.z());
    }
    for (const Eigen::Vector3i& t : std::initializer_list<Eigen::Vector3i>{{0, 2, 3},
                                                                           {0, 3, 1},
                                                                           {4, 5, 7},
                                                                           {4, 7, 6},
                                                                           {0, 1, 5},
                                                                           {0, 5, 4},
                                                                           {2, 6, 7},
                                                                           {2, 7, 3},
                                                                           {0, 4, 6},
                                                                           {0, 6, 2},
                                                                           {1, 3, 7},
                                                                           {1, 7, 5}}) {
      mesh.mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first));
    }
  };
  add({0, 0, 0}, {0.3, 0.2, 0.05});
  add({0, 0, 0.05}, {0.2, 0.2, 0.1});
  add({0, 0, 0.1}, {0.08, 0.2, 0.2});
  mesh.materials.push_back({"paint", {0.2f, 0.5f, 0.8f, 1.0f}, -1});
  mesh.triangle_material.assign(mesh.mesh.triangles.size(), 0);
  return mesh;
}

core::Image FullLiftPhotograph(const core::TexturedMesh& mesh, int size) {
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  const Eigen::AlignedBox3d box = core::Bounds(mesh.mesh);
  render::ForwardOptions options;
  options.shaded = true;
  options.samples_per_side = 3;
  return render::RenderForward(scene,
                               core::OrbitCamera(box.center(), 1.9 * box.diagonal().norm(), 0.4,
                                                 -1.1, 0.61, size, size),
                               options)
      .color;
}

class FullLift : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new core::TemporaryFolder();
    PriorTrainingOptions options;
    options.trainer.steps = 4;
    options.trainer.save_every = 3;
    options.batch = 4;
    options.pool = 4;
    options.parametric_share = 1.0;
    core::Progress silent;
    shape_report_ = TrainShapeNetwork({}, options, Weights("shape.pt"), &silent);
    view_report_ = TrainViewNetwork({}, Weights("shape.pt"), options, Weights("view.pt"), &silent);
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::filesystem::path Weights(const char* name) { return folder_->path() / name; }

  static core::TemporaryFolder* folder_;
  static PriorTrainingReport shape_report_, view_report_;
};
core::TemporaryFolder* FullLift::folder_ = nullptr;
PriorTrainingReport FullLift::shape_report_, FullLift::view_report_;

TEST_F(FullLift, TrainingReportsAndLeavesWeightsOnly) {
  EXPECT_EQ(shape_report_.step, 4);
  EXPECT_GT(shape_report_.loss, 0.0);
  ASSERT_EQ(shape_report_.metrics.size(), 2u);
  EXPECT_EQ(view_report_.step, 4);
  EXPECT_TRUE(std::filesystem::exists(Weights("view.pt")));
  EXPECT_FALSE(std::filesystem::exists(Weights("view.pt.state")));
}

// The weights' file keeps the network's size, and the sampler's meshes are trained on.
TEST_F(FullLift, TrainsAnotherSizeOnTheMeshesOfASampler) {
  PriorTrainingOptions options;
  options.trainer.steps = 2;
  options.trainer.save_every = 2;
  options.batch = 2;
  options.pool = 2;
  options.parametric_share = 0.0;
  options.sampler_share = 1.0;
  options.shape_channels = {16, 32};
  std::atomic<int> sampled = 0;
  options.sampler = [&](core::Rng* rng) {
    ++sampled;
    return MakeTrainingShape(rng);
  };
  core::Progress silent;
  TrainShapeNetwork({}, options, Weights("small.pt"), &silent);
  EXPECT_GE(sampled, 3);  // the pool, and an exchange
  EXPECT_EQ(nn::ReadCheckpointMetadata(Weights("small.pt"), "shape").at("channels"), "16,32");
  EXPECT_NO_THROW(ShapePrior(Weights("small.pt")));
  EXPECT_LT(std::filesystem::file_size(Weights("small.pt")),
            std::filesystem::file_size(Weights("shape.pt")) / 4);
  options.shape_channels = {16, 20};
  EXPECT_FALSE(options.IsValid(nullptr));
  options.shape_channels.assign(7, 16);
  EXPECT_FALSE(options.IsValid(nullptr));
}

TEST_F(FullLift, TrainsOnPhotosOfEarlierSteps) {
  PriorTrainingOptions options;
  options.trainer.steps = 5;
  options.trainer.save_every = 5;
  options.batch = 3;
  options.fresh = 1;
  options.memory = 3;
  options.pool = 2;
  options.parametric_share = 1.0;
  options.shape_channels = {16, 32};
  core::Progress silent;
  const PriorTrainingReport report = TrainShapeNetwork({}, options, Weights("kept.pt"), &silent);
  EXPECT_EQ(report.step, 5);
  // At the start the odds are even: the entropy is log 2 and the Dice term at most a half.
  EXPECT_GT(report.loss, 0.1);
  EXPECT_LT(report.loss, 2.0);
  EXPECT_NO_THROW(ShapePrior(Weights("kept.pt")));
  std::string error;
  options.memory = 2;  // less than a batch
  EXPECT_FALSE(options.IsValid(&error));
  EXPECT_NE(error.find("memory"), std::string::npos) << error;
  options.memory = 3;
  options.fresh = 4;  // more than a batch
  EXPECT_FALSE(options.IsValid(&error));
  options.fresh = 0;  // the memory would be of no use
  EXPECT_FALSE(options.IsValid(&error));
}

TEST_F(FullLift, BothStagesGiveASolidThatShowsThePhoto) {
  LiftPriors priors;
  priors.shape = std::make_shared<ShapePrior>(Weights("shape.pt"));
  priors.view = LoadLearnedViewPrior(Weights("view.pt"), priors.shape);
  LiftOptions options;
  options.elevation = 0.4;
  options.fit.field.stages = {{8, 48}};
  options.fit.mesh.rounds = 1;
  options.fit.mesh.steps_per_round = 6;
  options.texture_size = 256;
  core::Progress silent;
  const core::Image photo = FullLiftPhotograph(Steps(), 256);
  const LiftedMesh lifted = LiftPhoto(photo, {}, priors, options, &silent);
  EXPECT_EQ(lifted.start, "the learned prior");
  EXPECT_TRUE(geometry::Examine(lifted.mesh.mesh).IsSolid());
  // Even four steps of training must not lead the shape away from its silhouette.
  EXPECT_GT(lifted.silhouette_iou, 0.85);
  EXPECT_EQ(lifted.mesh.textures.size(), 1u);
  EXPECT_THROW(LoadLearnedViewPrior(Weights("shape.pt"), priors.shape), core::Error);
}

}  // namespace
}  // namespace simwright::asset_lift
