#include "true_table.h"

#include <cmath>
#include <map>
#include <utility>

#include "asset_build/asset_builder.h"
#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "physics_params/category_resolution.h"
#include "twin/pose_uncertainty.h"
#include "twin/table_camera.h"
#include "twin/table_picture.h"
#include "twin/table_pose.h"
#include "twin/table_reconstruction.h"
#include "twin_judgement.h"
#include "workflows/twin/twin_objects.h"
#include "workflows/twin/twin_settling.h"

namespace simwright::bench {
namespace fs = std::filesystem;
namespace {

const library_fit::FitKind& KindOf(const library_fit::Instance& instance) {
  return library_fit::FitKinds()[static_cast<size_t>(instance.kind)];
}

void ScaleMesh(double factor, core::TriangleMesh* mesh) {
  for (Eigen::Vector3d& vertex : mesh->vertices) vertex *= factor;
}

// Writes an instance, all lengths times `factor`, as the asset `folder`/`name`. Returns the pose of
// the asset in the instance's frame. Articulated ones keep their size.
Eigen::Isometry3d WriteInstance(const library_fit::Instance& instance, double factor,
                                const std::string& name, std::uint64_t seed,
                                const fs::path& folder) {
  fs::create_directories(folder / name);
  if (KindOf(instance).articulated != nullptr) {
    assets::ArticulatedAsset asset = library_fit::InstanceAsset(instance);
    asset.name = name;
    assets::WriteArticulatedAsset(asset, folder / name);
    return Eigen::Isometry3d::Identity();
  }
  asset_build::BuildRequest request;
  request.name = name;
  request.source = "table";
  request.category = physics_params::RequireCategory(KindOf(instance).rigid->category);
  request.seed = seed;
  request.parts = library_fit::InstanceObject(instance).parts;
  for (core::TriangleMesh& part : request.parts) ScaleMesh(factor, &part);
  core::TexturedMesh visual = library_fit::InstanceMesh(instance);
  ScaleMesh(factor, &visual.mesh);
  core::Progress silent;
  const assets::Asset asset = asset_build::BuildAsset(visual, request, &silent).asset;
  assets::WriteAsset(asset, folder / name);
  return asset.link_from_input.inverse();
}

// Moves a pose by (x, y) and turns it about the vertical line through `middle`.
Eigen::Isometry3d Moved(const Eigen::Isometry3d& pose, const Eigen::Vector3d& middle, double x,
                        double y, double yaw) {
  return Eigen::Translation3d(middle + Eigen::Vector3d(x, y, 0.0)) *
         Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-middle) * pose;
}

double YawOf(const Eigen::Isometry3d& pose) {
  return std::atan2(pose.linear()(1, 0), pose.linear()(0, 0));
}

// The camera of the scene in the twin's frame.
core::Camera TwinCamera(const twin::TableScene& scene) {
  core::Camera camera = scene.camera;
  camera.world_from_camera = TwinFromScene(scene.camera) * camera.world_from_camera;
  return camera;
}

std::string NameIn(const library_fit::Instance& instance, std::map<std::string, int>* count) {
  const std::string& kind = KindOf(instance).name;
  return kind + "_" + std::to_string(++(*count)[kind]);
}

}  // namespace

TrueTable TrueTableOf(twin::TableScene scene, std::uint64_t seed, const fs::path& folder) {
  TrueTable table;
  const Eigen::Isometry3d twin_from_scene = TwinFromScene(scene.camera);
  std::vector<twin::TableObject> kept;
  for (size_t k = 0; k < scene.objects.size(); ++k) {
    const twin::TableObject& object = scene.objects[k];
    const std::string name = "true_" + std::to_string(k);
    try {
      const Eigen::Isometry3d instance_from_asset =
          WriteInstance(object.instance, 1.0, name, seed + k, folder);
      transfer::TransferObject& real = table.world.objects.emplace_back();
      real.model = assets::ReadSemanticModel(folder / name);
      real.model.name = name;
      real.world_from_asset = twin_from_scene * object.world_from_object * instance_from_asset;
      real.fixed = KindOf(object.instance).articulated != nullptr;
      kept.push_back(object);
    } catch (const core::Error&) {  // some instances have no closed solid
      fs::remove_all(folder / name);
    }
  }
  table.scene = std::move(scene);
  table.scene.objects = std::move(kept);
  return table;
}

TwinOfTable PerturbedTable(const TrueTable& table, double iou, std::uint64_t seed, core::Rng* rng,
                           const fs::path& folder) {
  TwinOfTable made;
  made.record.photo = "table.png";
  made.record.camera = TwinCamera(table.scene);
  const Eigen::Isometry3d twin_from_scene = TwinFromScene(table.scene.camera);
  std::map<std::string, int> count;
  for (size_t k = 0; k < table.scene.objects.size(); ++k) {
    const twin::TableObject& object = table.scene.objects[k];
    const Eigen::Isometry3d truth = twin_from_scene * object.world_from_object;
    const Eigen::Vector3d at = truth.translation();
    twin::TableFit fit;
    fit.instance = object.instance;
    fit.pose = {at.x(), at.y(), YawOf(truth)};
    fit.agreement.iou = iou;
    const Eigen::AlignedBox2d box =
        twin::ProjectedBox(object.visual.mesh, {fit.pose, 1.0}, made.record.camera);
    if (box.isEmpty()) continue;
    const twin::PoseUncertainty error =
        twin::UncertaintyOf(fit, box, made.record.camera, false, 0.0);
    const bool articulated = KindOf(object.instance).articulated != nullptr;
    const double factor = articulated ? 1.0 : std::exp(error.size * core::Normal(*rng));
    const double x = error.position * core::Normal(*rng), y = error.position * core::Normal(*rng);
    const double yaw = error.yaw * core::Normal(*rng);
    workflows::TwinObject entry;
    entry.name = NameIn(object.instance, &count);
    entry.kind = KindOf(object.instance).name;
    entry.category = entry.kind;
    entry.articulated = articulated;
    const Eigen::Isometry3d instance_from_asset =
        WriteInstance(object.instance, factor, entry.name, seed + 1000 + k, folder / "assets");
    entry.world_from_object =
        Moved(truth, Eigen::Vector3d(at.x(), at.y(), 0.0), x, y, yaw) * instance_from_asset;
    entry.size = factor * core::Bounds(object.visual.mesh).sizes();
    entry.confidence = 1.0;
    entry.outline_iou = iou;
    entry.position_error = error.position;
    entry.yaw_error = error.yaw;
    entry.size_error = error.size;
    entry.box = box;
    made.record.objects.push_back(std::move(entry));
    made.truth.push_back(static_cast<int>(k));
  }
  core::Findings unread;
  workflows::SettleTwin(folder / "assets", &made.record, &unread);
  core::WriteFile(folder / "twin.json", workflows::TwinJson(made.record));
  return made;
}

TwinOfTable ReconstructedTable(const TrueTable& table, const twin::TableSceneSources& sources,
                               const library_fit::LibraryPrior& prior, std::uint64_t seed,
                               const fs::path& folder) {
  const twin::TablePicture picture = twin::RenderTable(table.scene, sources, {}, seed);
  std::vector<int> indices;
  twin::Detections found;
  found.objects = TrueDetections(picture, static_cast<int>(table.scene.objects.size()), &indices);
  found.camera.camera = twin::TableCameraOf(table.scene.camera);
  found.camera.elevation_error = found.camera.roll_error = 0.0;
  found.camera.log_focal_error = found.camera.log_height_error = 0.0;
  TwinOfTable made;
  if (found.objects.empty()) return made;
  core::Progress silent;
  core::Findings unread;
  const twin::TableReconstruction rebuilt =
      twin::ReconstructTable(picture.color, found, prior, {}, &silent);
  made.record.photo = "table.png";
  made.record.camera = rebuilt.camera.At(picture.color.width, picture.color.height);
  made.record.log_scale_error = rebuilt.log_scale_error;
  made.record.objects = workflows::WriteTwinAssets(rebuilt, picture.color, found, seed,
                                                   folder / "assets", &silent, &unread);
  // Objects whose asset failed are left out: boxes tell which are left.
  for (const workflows::TwinObject& object : made.record.objects) {
    made.truth.push_back(-1);
    for (size_t d = 0; d < found.objects.size(); ++d) {
      if (found.objects[d].box.isApprox(object.box)) made.truth.back() = indices[d];
    }
  }
  workflows::SettleTwin(folder / "assets", &made.record, &unread);
  core::WriteFile(folder / "twin.json", workflows::TwinJson(made.record));
  return made;
}

}  // namespace simwright::bench
