#include "library_fit/library_fit.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/progress.h"
#include "library_fit/cma_es.h"
#include "library_fit/fit_loss.h"
#include "library_fit/fitted_object.h"
#include "library_fit/library_training.h"
#include "library_fit/prior_example.h"
#include "render/forward.h"

namespace simwright::library_fit {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kTestSeed = kHeldOutSeed + 10;
constexpr double kDegree = M_PI / 180.0;
constexpr int kSide = 240;

const fs::path& ShippedWeights() {
  static const fs::path kPath = fs::path(SIMWRIGHT_SOURCE_DIR) / "models" / "library_prior.pt";
  return kPath;
}

// A photo of an instance with its mask, and the camera in the instance's frame.
struct Shown {
  core::Image photo, alpha;
  core::Camera camera;
};

Shown Show(const Instance& instance, const FitView& view) {
  const core::TexturedMesh mesh = InstanceMesh(instance);
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  Shown shown;
  shown.camera = CropCameraOf(view, mesh.mesh, {0.5 * kSide, 0.5 * kSide}, 0.35 * kSide, kSide);
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  const render::ForwardBuffers seen = render::RenderForward(scene, shown.camera, options);
  shown.photo = core::Image(kSide, kSide, 3, 120);
  shown.alpha = core::Image(kSide, kSide, 1);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float share = seen.mask[seen.Index(x, y)];
      *shown.alpha.At(x, y) = static_cast<std::uint8_t>(std::lround(255.0f * share));
      if (share < 0.5f) continue;
      std::copy_n(seen.color.At(x, y), 3, shown.photo.At(x, y));
    }
  }
  return shown;
}

FitView FrontView() {
  FitView view;
  view.azimuth = M_PI + 0.5;
  view.elevation = 0.35;
  view.nearness = 0.22;
  return view;
}

std::vector<FittedInstance> FitOf(const std::string& kind, const Shown& shown) {
  const LibraryPrior prior(ShippedWeights());
  LibraryFitOptions options;
  options.kinds = {FindFitKind(kind)};
  options.generations = 12;
  options.side = 64;
  return FitLibrary(prior, FitPhotoOf(shown.photo, shown.alpha), options);
}

TEST(FitKinds, EachHasItsCategories) {
  EXPECT_EQ(FitKinds().size(), library::Kinds().size() + library::RigidKinds().size());
  EXPECT_EQ(KindsOfCategory("microwave"), std::vector<int>{FindFitKind("microwave")});
  EXPECT_EQ(KindsOfCategory("nightstand"), std::vector<int>{FindFitKind("drawer_unit")});
  EXPECT_EQ(KindsOfCategory("object").size(), FitKinds().size());
  EXPECT_EQ(KindsOfCategory("coffee cup"), KindsOfCategory("cup"));
  EXPECT_TRUE(KindsOfCategory("elephant").empty());
  EXPECT_EQ(FindFitKind("elephant"), -1);
}

TEST(FitKinds, AnInstanceIsTheSeedsAsset) {
  const Instance instance = SampleInstance(FindFitKind("oven"), 12);
  library::Options options;
  options.seed = 12;
  const core::TexturedMesh expected = assets::VisualAtPositions(library::MakeOven(options));
  EXPECT_EQ(InstanceMesh(instance).mesh.vertices, expected.mesh.vertices);
}

TEST(FitView, CameraShowsTheMeshInItsBox) {
  const core::TexturedMesh mesh = InstanceMesh(SampleInstance(FindFitKind("mug"), kTestSeed));
  const Eigen::AlignedBox2d box(Eigen::Vector2d(10, 20), Eigen::Vector2d(50, 70));
  const core::Camera camera = CameraOf(FrontView(), mesh.mesh, box, 96);
  Eigen::AlignedBox2d seen;
  for (const Eigen::Vector3d& v : mesh.mesh.vertices) {
    seen.extend(Eigen::Vector2d(camera.Project(v).head<2>()));
  }
  EXPECT_NEAR((seen.center() - box.center()).norm(), 0.0, 1e-6);
  EXPECT_NEAR(seen.sizes().sum(), box.sizes().sum(), 1e-6);
}

// Rosenbrock's function in four dimensions has its minimum 0 at (1, 1, 1, 1).
TEST(CmaEs, FindsTheMinimumOfRosenbrocksFunction) {
  const auto rosenbrock = [](const Eigen::VectorXd& x) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      sum += 100.0 * std::pow(x[i + 1] - x[i] * x[i], 2) + std::pow(1.0 - x[i], 2);
    }
    return sum;
  };
  CmaEsOptions options;
  options.generations = 400;
  options.least_step = 1e-9;
  core::Rng rng = core::StreamRng(3, 0);
  const CmaEsResult result = MinimizeByCmaEs(rosenbrock, Eigen::VectorXd::Zero(4), options, &rng);
  EXPECT_LT(result.loss, 1e-8);
  EXPECT_LT((result.best - Eigen::VectorXd::Ones(4)).norm(), 1e-3);
  EXPECT_THROW(MinimizeByCmaEs(rosenbrock, Eigen::VectorXd(), options, &rng), core::Error);
}

TEST(FitLoss, TheTruthAgreesAndAnotherHingeSideDoesNot) {
  Instance instance = SampleInstance(FindFitKind("microwave"), kTestSeed);
  instance.draws[0] = 0.3;
  const Shown shown = Show(instance, FrontView());
  const FitPhoto photo = FitPhotoOf(shown.photo, shown.alpha);
  const FitTarget target =
      MakeFitTarget(asset_lift::CropView(photo.photo, photo.alpha, photo.frame, 80));
  const FitAgreement truth = CompareWithPhoto(InstanceMesh(instance), FrontView(), target);
  instance.draws[0] = 0.95;
  const FitAgreement mirrored = CompareWithPhoto(InstanceMesh(instance), FrontView(), target);
  EXPECT_GT(truth.iou, 0.97);
  EXPECT_LT(truth.unexplained, 0.1);
  EXPECT_LT(truth.Loss() + 0.2, mirrored.Loss());
}

TEST(LibraryFit, RecoversTheDoorOfAHeldOutMicrowave) {
  const Instance instance = SampleInstance(FindFitKind("microwave"), kTestSeed);
  const Shown shown = Show(instance, FrontView());
  const FittedInstance fit = FitOf("microwave", shown).front();
  EXPECT_GT(fit.iou, 0.95);
  const FitPhoto photo = FitPhotoOf(shown.photo, shown.alpha);
  const assets::ArticulatedAsset truth = InstanceAsset(instance), ours = FittedAsset(fit, photo);
  const auto door = [](const assets::ArticulatedAsset& asset) {
    return *std::find_if(asset.joints.begin(), asset.joints.end(),
                         [](const assets::Joint& joint) { return joint.child == "door"; });
  };
  EXPECT_EQ(door(ours).type, assets::JointType::kRevolute);
  EXPECT_EQ(truth.features.at("hinge"), ours.features.at("hinge"));
  // Both in the camera's frame, in units of the diagonal.
  const auto seen = [](const core::Camera& camera, const Eigen::Vector3d& direction) {
    return Eigen::Vector3d(camera.world_from_camera.linear().transpose() * direction);
  };
  const core::Camera camera = PhotoCamera(fit, photo);
  const Eigen::Vector3d axis = seen(shown.camera, door(truth).axis);
  EXPECT_GT(std::abs(axis.dot(seen(camera, door(ours).axis))), std::cos(5.0 * kDegree));
  const auto pivot = [&](const assets::ArticulatedAsset& asset, const core::Camera& from) {
    const Eigen::AlignedBox3d box = assets::BoundsAtZero(asset);
    return Eigen::Vector3d(seen(from, door(asset).parent_from_joint.translation() - box.center()) /
                           box.diagonal().norm());
  };
  EXPECT_LT((pivot(truth, shown.camera) - pivot(ours, camera)).cross(axis).norm(), 0.03);
}

// A box has six planes, so its normals take six directions apart from the chamfers'.
TEST(LibraryFit, BoxesHavePlanes) {
  const Instance instance = SampleInstance(FindFitKind("brick"), kTestSeed);
  const Shown shown = Show(instance, FrontView());
  const FittedMesh fitted =
      TexturedFit(FitOf("brick", shown).front(), FitPhotoOf(shown.photo, shown.alpha));
  const core::TriangleMesh& mesh = fitted.mesh.mesh;
  double area = 0.0, flat = 0.0;
  std::vector<Eigen::Vector3d> directions;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const Eigen::Vector3d vector = core::TriangleAreaVector(mesh, t);
    area += vector.norm();
    const auto known = std::find_if(
        directions.begin(), directions.end(),
        [&](const Eigen::Vector3d& d) { return std::abs(d.dot(vector)) > 0.9999 * vector.norm(); });
    if (known == directions.end() && directions.size() < 3 && vector.norm() > 0.05 * area) {
      directions.push_back(vector.normalized());
      flat += vector.norm();
    } else if (known != directions.end()) {
      flat += vector.norm();
    }
  }
  EXPECT_EQ(directions.size(), 3u);
  EXPECT_GT(flat, 0.75 * area);
  // The camera is on the side of -y.
  EXPECT_LT(fitted.camera.position().y(), 0.0);
  EXPECT_NEAR(fitted.camera.position().x(), core::Bounds(mesh).center().x(), 1e-6);
}

TEST(LibraryFit, SameSeedSameFit) {
  const Shown shown = Show(SampleInstance(FindFitKind("can"), kTestSeed), FrontView());
  const FittedInstance one = FitOf("can", shown).front(), two = FitOf("can", shown).front();
  EXPECT_EQ(one.score, two.score);
  EXPECT_EQ(one.instance.draws, two.instance.draws);
  EXPECT_EQ(one.instance.size, two.instance.size);
}

TEST(LibraryFit, TheHeightScalesAnArticulatedFit) {
  const Instance instance = SampleInstance(FindFitKind("oven"), kTestSeed);
  const Shown shown = Show(instance, FrontView());
  FittedInstance fit;
  fit.instance = instance;
  fit.view = FrontView();
  const FitPhoto photo = FitPhotoOf(shown.photo, shown.alpha);
  EXPECT_NEAR(assets::BoundsAtZero(FittedAsset(fit, photo, 0.7)).sizes().z(), 0.7, 1e-3);
  fit.instance = SampleInstance(FindFitKind("mug"), kTestSeed);
  EXPECT_THROW(FittedAsset(fit, photo), core::Error);
}

// Returns the share of an image's pixels that are red.
double RedShare(const core::Image& image) {
  int red = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.At(x, y);
      red += p[0] > 180 && p[1] < 60 && p[2] < 60;
    }
  }
  return red / static_cast<double>(image.width * image.height);
}

core::Image Unlit(const core::TexturedMesh& mesh, const core::Camera& camera) {
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  render::ForwardOptions options;
  options.shaded = true;
  options.lit = false;
  return render::RenderForward(scene, camera, options).color;
}

// A sticker in the photo is on the asset, where the photo shows it, and on no other side.
TEST(LibraryFit, AnArticulatedFitShowsThePhoto) {
  FittedInstance fit;
  fit.instance = SampleInstance(FindFitKind("microwave"), kTestSeed);
  fit.view = FrontView();
  Shown shown = Show(fit.instance, FrontView());
  for (int y = kSide / 2 - 12; y < kSide / 2 + 12; ++y) {
    for (int x = kSide / 2 - 12; x < kSide / 2 + 12; ++x) {
      std::uint8_t* p = shown.photo.At(x, y);
      p[0] = 230;
      p[1] = p[2] = 20;
    }
  }
  const FitPhoto photo = FitPhotoOf(shown.photo, shown.alpha);
  const core::Image seen = Unlit(PaintedFit(fit, photo), PhotoCamera(fit, photo));
  EXPECT_NEAR(RedShare(seen), 24.0 * 24.0 / (kSide * kSide), 0.2 * 24.0 * 24.0 / (kSide * kSide));
  const std::uint8_t* middle = seen.At(kSide / 2, kSide / 2);
  EXPECT_GT(middle[0], 180);
  EXPECT_LT(middle[1], 60);
  const assets::ArticulatedAsset asset = FittedAsset(fit, photo, 0.4);
  for (const assets::ArticulatedLink& link : asset.links) {
    ASSERT_EQ(link.visual.textures.size(), 1u) << link.name;
    EXPECT_EQ(link.visual.corner_uvs.size(), 3 * link.visual.mesh.triangles.size());
  }
  const core::TexturedMesh whole = assets::VisualAtPositions(asset);
  EXPECT_EQ(whole.textures.size(), 1u);
  FitView behind = FrontView();
  behind.azimuth += M_PI;
  const auto from = [&](const FitView& view) {
    return RedShare(Unlit(
        whole, CropCameraOf(view, whole.mesh, {0.5 * kSide, 0.5 * kSide}, 0.35 * kSide, kSide)));
  };
  EXPECT_GT(from(FrontView()), 0.007);
  EXPECT_LT(from(behind), 0.0005);
}

TEST(LibraryFit, EveryArticulatedKindTakesThePhoto) {
  for (size_t kind = 0; kind < FitKinds().size(); ++kind) {
    if (FitKinds()[kind].articulated == nullptr) continue;
    FittedInstance fit;
    fit.instance = SampleInstance(static_cast<int>(kind), kTestSeed);
    fit.view = FrontView();
    const Shown shown = Show(fit.instance, FrontView());
    const assets::ArticulatedAsset asset =
        FittedAsset(fit, FitPhotoOf(shown.photo, shown.alpha), 0.3);
    EXPECT_EQ(assets::VisualAtPositions(asset).textures.size(), 1u) << FitKinds()[kind].name;
  }
}

TEST(LibraryFit, RefusesBadInput) {
  const core::Image photo(40, 40, 3), empty(40, 40, 1), other(20, 40, 1, 255);
  EXPECT_THROW(FitPhotoOf(photo, empty), core::Error);
  EXPECT_THROW(FitPhotoOf(photo, other), core::Error);
  EXPECT_THROW(LibraryPrior("no_such_file.pt"), core::Error);
  std::string error;
  LibraryFitOptions options;
  EXPECT_TRUE(options.IsValid(&error));
  options.proposals = 0;
  EXPECT_FALSE(options.IsValid(&error));
  EXPECT_FALSE(error.empty());
}

TEST(LibraryTraining, ASmallTrainingLearnsAndWritesWeights) {
  const fs::path folder = fs::path(testing::TempDir()) / "library_training";
  fs::create_directories(folder);
  LibraryTrainingOptions options;
  options.trainer.steps = 8;
  options.trainer.save_every = 8;
  options.batch = 8;
  options.pool = 16;
  options.exchange = 2;
  options.channels = {16, 32, 48, 64};
  options.features = 64;
  core::Progress progress;
  const auto report = TrainLibraryNetwork(options, folder / "library_prior.pt", &progress);
  EXPECT_EQ(report.step, 8);
  EXPECT_TRUE(std::isfinite(report.loss));
  // The mean over the steps is below that of guessing: log 94 for the kind, half of log 36 for the
  // azimuth, and up to 17 choices of 0.3 log 12 each.
  EXPECT_LT(report.loss, 17.0);
  const LibraryPrior prior(folder / "library_prior.pt");
  const std::vector<double> kinds =
      prior.KindProbabilities(core::Image(kPriorSide, kPriorSide, 4, 200));
  double sum = 0.0;
  for (const double p : kinds) sum += p;
  EXPECT_NEAR(sum, 1.0, 1e-5);
  // The reader takes the network's size from the file.
  EXPECT_LT(fs::file_size(folder / "library_prior.pt"), fs::file_size(ShippedWeights()) / 8);
  options.channels = {16, 32, 48, 60};
  EXPECT_THROW(TrainLibraryNetwork(options, folder / "x.pt", &progress), core::Error);
  options.channels = {16, 32, 48, 64};
  options.pool = 0;
  EXPECT_THROW(TrainLibraryNetwork(options, folder / "x.pt", &progress), core::Error);
}

TEST(LibraryTraining, StartsFromWeightsAndTakesPicturesOfScenes) {
  const fs::path folder = fs::path(testing::TempDir()) / "library_start";
  fs::create_directories(folder);
  LibraryTrainingOptions options;
  options.trainer.steps = 1;
  options.trainer.learning_rate = 1e-12;  // what it starts from remains
  options.trainer.save_every = 1;
  options.batch = 2;
  options.pool = 6;
  options.exchange = 1;
  options.start = ShippedWeights();
  std::atomic<int> asked = 0;
  options.scene_share = 1.0;
  options.scene_example = [&asked](std::uint64_t seed) {
    ++asked;
    return MakePriorExample(3, seed);
  };
  core::Progress progress;
  TrainLibraryNetwork(options, folder / "library_prior.pt", &progress);
  EXPECT_EQ(asked, 7);  // the pool, and the exchange of the step
  const LibraryPrior before(ShippedWeights()), after(folder / "library_prior.pt");
  core::Image crop(kPriorSide, kPriorSide, 4);
  crop.pixels = MakePriorExample(FindFitKind("mug"), 5).picture;
  const std::vector<double> expected = before.KindProbabilities(crop);
  const std::vector<double> kinds = after.KindProbabilities(crop);
  for (size_t k = 0; k < kinds.size(); ++k) EXPECT_NEAR(kinds[k], expected[k], 1e-3);
  options.scene_share = 1.5;
  EXPECT_THROW(TrainLibraryNetwork(options, folder / "x.pt", &progress), core::Error);
}

TEST(PriorExample, IsTheSameForASeedAndFillsItsCrop) {
  const int kind = FindFitKind("toaster");
  const PriorExample one = MakePriorExample(kind, 77), two = MakePriorExample(kind, 77);
  EXPECT_EQ(one.picture, two.picture);
  EXPECT_NE(one.picture, MakePriorExample(kind, 78).picture);
  int left = kPriorSide, right = 0, top = kPriorSide, bottom = 0;
  for (int y = 0; y < kPriorSide; ++y) {
    for (int x = 0; x < kPriorSide; ++x) {
      if (one.picture[static_cast<size_t>(4 * (y * kPriorSide + x) + 3)] < 128) continue;
      left = std::min(left, x);
      right = std::max(right, x + 1);
      top = std::min(top, y);
      bottom = std::max(bottom, y + 1);
    }
  }
  EXPECT_NEAR(std::max(right - left, bottom - top), kPriorSide / kPriorMargin, 5.0);
}

}  // namespace
}  // namespace simwright::library_fit
