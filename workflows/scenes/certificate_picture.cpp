#include "workflows/scenes/certificate_picture.h"

#include <algorithm>
#include <cmath>

#include "core/camera.h"
#include "core/image.h"
#include "core/parallel.h"
#include "render/forward.h"
#include "workflows/skills/robot_visuals.h"

namespace simwright::workflows {
namespace {

constexpr int kPixels = 320;          // per side
constexpr double kAzimuth = 4.1;      // rad: from behind the robot's right shoulder
constexpr double kElevation = 0.45;   // rad
constexpr double kFieldOfView = 0.5;  // rad
constexpr double kArmHeight = 0.9;    // m above the base, which pictures show
constexpr double kBehind = 0.2;       // m behind it
constexpr float kOcclusionReach = 0.05f;

core::Image PictureOf(const CertificateView& view, const certificate::ReplayMoment& moment,
                      const scene::AssetSet& asset_set, const RobotVisuals& visuals) {
  render::Scene scene;
  Eigen::AlignedBox3d box;
  for (size_t i = 0; i < view.objects->size(); ++i) {
    const core::TexturedMesh& mesh = asset_set.At((*view.objects)[i].category).visual;
    scene.Add(&mesh, moment.poses[i]);
    for (const Eigen::Vector3d& vertex : mesh.mesh.vertices) {
      box.extend((*view.objects)[i].world_from_object * vertex);
    }
  }
  visuals.Place(moment.arm, moment.leader, view.world_from_robot, &scene);
  for (const double up : {0.0, kArmHeight}) {
    box.extend(view.world_from_robot * Eigen::Vector3d(-kBehind, 0.0, up));
  }
  scene.Commit();
  const double distance = 0.5 * box.diagonal().norm() / std::sin(0.5 * kFieldOfView);
  const core::Camera camera = core::OrbitCamera(box.center(), 0.75 * distance, kElevation, kAzimuth,
                                                kFieldOfView, kPixels, kPixels);
  render::ForwardOptions options;
  options.shaded = true;
  options.samples_per_side = 2;
  options.occlusion_rays = 6;
  options.occlusion_reach = kOcclusionReach;
  return render::RenderForward(scene, camera, options).color;
}

}  // namespace

void WriteCertificateSheet(const std::vector<CertificateView>& views,
                           const scene::AssetSet& asset_set, const robot::RobotModel& robot,
                           const std::filesystem::path& path, core::Progress* progress) {
  if (views.empty()) return;
  const RobotVisuals visuals(robot);
  const size_t columns = views.front().moments->size();
  std::vector<core::Image> pictures(views.size() * columns);
  core::ParallelFor(static_cast<int>(pictures.size()), [&](int i) {
    const CertificateView& view = views[static_cast<size_t>(i) / columns];
    const size_t column = static_cast<size_t>(i) % columns;
    pictures[static_cast<size_t>(i)] = PictureOf(view, (*view.moments)[column], asset_set, visuals);
    if (column == 0) progress->Advance();
  });
  core::WritePng(path, core::ContactSheet(pictures, static_cast<int>(columns)));
}

}  // namespace simwright::workflows
