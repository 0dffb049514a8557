#include "workflows/twin/twin_free_form.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "assets/asset_folder.h"
#include "core/files.h"
#include "workflows/lift/lift.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr double kLiftMargin = 0.25;  // of the box's longer side, around the object

core::Image CutOf(const core::Image& image, const Eigen::AlignedBox2i& frame) {
  const Eigen::Vector2i sides = frame.sizes();
  core::Image cut(sides.x(), sides.y(), image.channels);
  for (int y = 0; y < sides.y(); ++y) {
    std::memcpy(cut.At(0, y), image.At(frame.min().x(), frame.min().y() + y),
                static_cast<size_t>(sides.x()) * static_cast<size_t>(image.channels));
  }
  return cut;
}

// Returns the frame around a box inside of the photo.
Eigen::AlignedBox2i FrameOf(const Eigen::AlignedBox2d& box, const core::Image& photo) {
  const double margin = kLiftMargin * box.sizes().maxCoeff();
  return {Eigen::Vector2i(std::max(0, static_cast<int>(box.min().x() - margin)),
                          std::max(0, static_cast<int>(box.min().y() - margin))),
          Eigen::Vector2i(std::min(photo.width, static_cast<int>(box.max().x() + margin)),
                          std::min(photo.height, static_cast<int>(box.max().y() + margin)))};
}

}  // namespace

void LiftTwinObject(const core::Image& photo, const twin::Detection& detection,
                    const core::Camera& camera, const twin::TablePose& pose, std::uint64_t seed,
                    const fs::path& folder, TwinObject* entry, core::Progress* progress) {
  const core::TemporaryFolder work;
  const Eigen::AlignedBox2i frame = FrameOf(detection.box, photo);
  core::WritePng(work.path() / "photo.png", CutOf(photo, frame));
  core::WritePng(work.path() / "mask.png", CutOf(detection.alpha, frame));
  const Eigen::Vector3d ray = camera.Ray(detection.box.center()).normalized();
  LiftRequest request;
  request.photo = work.path() / "photo.png";
  request.mask = work.path() / "mask.png";
  request.category = entry->category;
  request.height = entry->size.z();
  request.elevation_degrees = std::asin(std::clamp(-ray.z(), 0.0, 1.0)) * 180.0 / M_PI;
  request.fov_degrees = 2.0 * std::atan(0.5 * frame.sizes().maxCoeff() / camera.fx) * 180.0 / M_PI;
  request.effort = asset_lift::LiftEffort::kFast;
  request.seed = seed;
  request.output = work.path() / folder.filename();
  LiftToFolder(request, progress);
  const assets::Asset asset = assets::ReadAsset(request.output);
  // The reconstruction has its camera on the side of -y: turned until that side faces ours.
  TwinObject lifted = *entry;
  const double yaw = std::atan2(-ray.y(), -ray.x()) + 0.5 * M_PI;
  lifted.world_from_object.linear() =
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
      asset.link_from_input.linear().transpose();
  lifted.world_from_object.translation() = Eigen::Vector3d(pose.x, pose.y, 0.0);
  lifted.source = TwinSource::kLifted;
  lifted.articulated = false;
  lifted.joints.clear();
  lifted.size = core::Bounds(asset.visual.mesh).sizes();
  fs::remove_all(folder);
  fs::copy(request.output, folder, fs::copy_options::recursive);
  *entry = lifted;
}

}  // namespace simwright::workflows
