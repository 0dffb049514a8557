#include "fit_case.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "asset_lift/priors/shape_example.h"
#include "assets/joint_poses.h"
#include "library_fit/fit_view.h"
#include "render/forward.h"

namespace simwright::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kPhotoSide = 400;
constexpr double kAxisTolerance = 5.0 * M_PI / 180.0;
constexpr double kPivotTolerance = 0.03;  // of the diagonal

core::Image CropOf(const core::Image& photo, int left, int top, int width, int height) {
  core::Image crop(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) crop.At(x, y)[c] = photo.At(left + x, top + y)[c];
    }
  }
  return crop;
}

}  // namespace

std::vector<core::Image> ExampleBackgrounds() {
  const fs::path folder = fs::path(SIMWRIGHT_SOURCE_DIR) / "examples";
  std::vector<core::Image> crops;
  const core::Image coffee = core::ReadImage(folder / "coffee.png");
  crops.push_back(CropOf(coffee, 485, 110, 115, 220));
  crops.push_back(CropOf(coffee, 440, 0, 160, 125));
  for (const char* name : {"apple.jpg", "orange.jpg"}) {
    // The margins to the left of the fruit.
    const core::Image photo = core::ReadImage(folder / name);
    crops.push_back(CropOf(photo, 0, 0, photo.width / 8, photo.height));
  }
  return crops;
}

void Photograph(const std::vector<core::Image>& backgrounds, bool frontal, core::Rng* rng,
                FitCase* fit_case) {
  library_fit::FitView view = library_fit::RandomView(frontal, rng);
  if (frontal) view.azimuth = M_PI + std::clamp(view.azimuth - M_PI, -M_PI / 3.0, M_PI / 3.0);
  view.roll = 0.0;
  const double half = 0.5 * kPhotoSide * core::Uniform(*rng, 0.60, 0.75);
  const Eigen::Vector2d middle(0.5 * kPhotoSide, 0.5 * kPhotoSide);
  fit_case->camera =
      library_fit::CropCameraOf(view, fit_case->visual.mesh, middle, half, kPhotoSide);
  render::Scene scene;
  scene.Add(&fit_case->visual);
  scene.Commit();
  render::ForwardOptions options;
  options.samples_per_side = 3;
  options.shaded = true;
  options.light = asset_lift::RandomLight(rng);
  options.occlusion_rays = 8;
  const render::ForwardBuffers seen = render::RenderForward(scene, fit_case->camera, options);
  const core::Image& behind = backgrounds[static_cast<size_t>(
      core::UniformIndex(*rng, static_cast<std::int64_t>(backgrounds.size())))];
  const core::Image back = core::Resize(behind, kPhotoSide, kPhotoSide);
  fit_case->photo = core::Image(kPhotoSide, kPhotoSide, 3);
  asset_lift::Matte& matte = fit_case->matte;
  matte = {};
  matte.method = "rendered";
  matte.alpha = core::Image(kPhotoSide, kPhotoSide, 1);
  matte.left = matte.top = kPhotoSide;
  for (int y = 0; y < kPhotoSide; ++y) {
    for (int x = 0; x < kPhotoSide; ++x) {
      const float share = seen.mask[seen.Index(x, y)];
      *matte.alpha.At(x, y) = static_cast<std::uint8_t>(std::lround(255.0f * share));
      for (int c = 0; c < 3; ++c) {
        const float mixed = share * seen.color.At(x, y)[c] + (1.0f - share) * back.At(x, y)[c];
        fit_case->photo.At(x, y)[c] = static_cast<std::uint8_t>(std::lround(mixed));
      }
      matte.area += share / (kPhotoSide * kPhotoSide);
      if (share < 0.5f) continue;
      matte.left = std::min(matte.left, x);
      matte.right = std::max(matte.right, x + 1);
      matte.top = std::min(matte.top, y);
      matte.bottom = std::max(matte.bottom, y + 1);
    }
  }
}

std::vector<SeenJoint> SeenJoints(const assets::ArticulatedAsset& asset, const core::Camera& camera,
                                  double least) {
  const Eigen::AlignedBox3d bounds = assets::BoundsAtZero(asset);
  const double diagonal = bounds.diagonal().norm();
  const Eigen::Matrix3d camera_from_root = camera.world_from_camera.linear().transpose();
  const std::vector<Eigen::Isometry3d> poses = assets::LinkPoses(assets::ModelOf(asset), {});
  const auto seen = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return camera_from_root * (point - bounds.center()) / diagonal;
  };
  std::vector<SeenJoint> joints;
  for (size_t i = 0; i < asset.joints.size(); ++i) {
    if (!asset.joints[i].Moves()) continue;
    // A part moves with the links that are fixed to it.
    Eigen::AlignedBox3d part;
    const Eigen::Isometry3d& pose = poses[i + 1];
    for (const Eigen::Vector3d& v : asset.links[i + 1].visual.mesh.vertices) part.extend(pose * v);
    if (part.isEmpty() || part.diagonal().norm() < least * diagonal) continue;
    joints.push_back({asset.joints[i].type, camera_from_root * pose.linear() * asset.joints[i].axis,
                      seen(pose.translation()), seen(part.center()),
                      part.diagonal().norm() / diagonal});
  }
  return joints;
}

void JointScores::Add(const JointScores& other) {
  joints += other.joints;
  type_right += other.type_right;
  axis_right += other.axis_right;
  hinges += other.hinges;
  pivot_right += other.pivot_right;
  objects += other.objects;
  parts_right += other.parts_right;
}

JointScores CompareJoints(const std::vector<SeenJoint>& truth, const std::vector<SeenJoint>& fit) {
  JointScores scores;
  scores.objects = 1;
  scores.parts_right = truth.size() == fit.size();
  std::vector<bool> taken(fit.size(), false);
  for (const SeenJoint& joint : truth) {
    ++scores.joints;
    const bool hinge = joint.type != assets::JointType::kPrismatic;
    scores.hinges += hinge;
    size_t nearest = fit.size();
    for (size_t k = 0; k < fit.size(); ++k) {
      if (taken[k]) continue;
      if (nearest == fit.size() ||
          (fit[k].part - joint.part).norm() < (fit[nearest].part - joint.part).norm()) {
        nearest = k;
      }
    }
    if (nearest == fit.size()) continue;
    taken[nearest] = true;
    const SeenJoint& found = fit[nearest];
    if (found.type != joint.type) continue;
    ++scores.type_right;
    scores.axis_right += std::abs(found.axis.dot(joint.axis)) >= std::cos(kAxisTolerance);
    scores.pivot_right +=
        hinge && (found.pivot - joint.pivot).cross(joint.axis).norm() <= kPivotTolerance;
  }
  return scores;
}

}  // namespace simwright::bench
