#include "asset_build/articulated_preview.h"

#include <map>
#include <numbers>

#include "asset_build/preview.h"
#include "assets/joint_poses.h"
#include "render/turntable.h"

namespace simwright::asset_build {
namespace {

constexpr double kFront = std::numbers::pi;  // rad, azimuth of -x
constexpr double kAside = 0.6;               // rad
constexpr double kOpen = 0.85;               // fraction of a joint's range

assets::JointPositions Opened(const assets::ArticulatedAsset& asset, double open) {
  assets::JointPositions positions;
  for (const assets::Joint& joint : asset.joints) {
    if (joint.Moves()) positions[joint.name] = open * joint.upper;
  }
  return positions;
}

core::Image View(const core::TexturedMesh& mesh, double azimuth, int size) {
  render::TurntableOptions options;
  options.views = 1;
  options.size = size;
  options.first_azimuth = azimuth;
  options.samples_per_side = 2;
  return render::Turntable(mesh, options).front();
}

core::TexturedMesh PartsOpened(const assets::ArticulatedAsset& asset, double open) {
  const std::vector<Eigen::Isometry3d> poses =
      assets::LinkPoses(assets::ModelOf(asset), Opened(asset, open));
  std::vector<core::TriangleMesh> parts;
  for (size_t i = 0; i < asset.links.size(); ++i) {
    for (core::TriangleMesh part : asset.links[i].parts) {
      core::Transform(Eigen::Affine3d(poses[i]), &part);
      parts.push_back(std::move(part));
    }
  }
  return ColoredParts(parts);
}

}  // namespace

core::Image ArticulatedView(const assets::ArticulatedAsset& asset, double open, int size) {
  return View(assets::VisualAtPositions(asset, Opened(asset, open)), kFront + kAside, size);
}

core::Image ArticulatedPreview(const assets::ArticulatedAsset& asset) {
  constexpr int kSize = 360;
  std::vector<core::Image> pictures;
  for (const double open : {0.0, kOpen}) {
    const core::TexturedMesh seen = assets::VisualAtPositions(asset, Opened(asset, open));
    for (const double aside : {kAside, -kAside}) {
      pictures.push_back(View(seen, kFront + aside, kSize));
    }
  }
  for (const double open : {0.0, kOpen}) {
    const core::TexturedMesh parts = PartsOpened(asset, open);
    for (const double aside : {kAside, -kAside}) {
      pictures.push_back(View(parts, kFront + aside, kSize));
    }
  }
  return core::ContactSheet(pictures, 4);
}

}  // namespace simwright::asset_build
