#include "transfer_table.h"

#include <cmath>
#include <map>
#include <utility>

#include "asset_build/asset_builder.h"
#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "physics_params/category_resolution.h"
#include "transfer/scaled_model.h"
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

double LogUniform(double low, double high, core::Rng* rng) {
  return std::exp(core::Uniform(*rng, std::log(low), std::log(high)));
}

// Samples what a picture does not tell of an object.
void SampleSurface(core::Rng* rng, transfer::TransferObject* object) {
  object->mass = LogUniform(0.5, 2.0, rng);
  object->friction = LogUniform(0.7, 1.3, rng);
}

// Returns an object of the table from an asset that is its size times `factor`.
transfer::TransferObject TrueObject(const fs::path& asset, double factor, const std::string& name,
                                    const Eigen::Isometry3d& world_from_asset, bool fixed) {
  transfer::TransferObject object;
  object.model = transfer::ScaledModel(assets::ReadSemanticModel(asset), 1.0 / factor);
  object.model.name = name;
  object.world_from_asset = world_from_asset;
  object.fixed = fixed;
  return object;
}

// The errors of an object of a perturbed twin.
struct TwinError {
  double x = 0.0, y = 0.0, yaw = 0.0, factor = 1.0;
};

// Returns the twin's entry of an object, without its pose and name; its errors are sampled into
// `error`.
workflows::TwinObject PerturbedEntry(const twin::TableObject& object,
                                     const Eigen::Isometry3d& truth, const core::Camera& camera,
                                     double iou, core::Rng* rng, TwinError* error) {
  twin::TableFit fit;
  fit.instance = object.instance;
  fit.pose = {truth.translation().x(), truth.translation().y(), YawOf(truth)};
  fit.agreement.iou = iou;
  workflows::TwinObject entry;
  entry.box = twin::ProjectedBox(object.visual.mesh, {fit.pose, 1.0}, camera);
  const twin::PoseUncertainty sigma = twin::UncertaintyOf(fit, entry.box, camera, false, 0.0);
  entry.kind = entry.category = KindOf(object.instance).name;
  entry.articulated = KindOf(object.instance).articulated != nullptr;
  entry.confidence = 1.0;
  entry.outline_iou = iou;
  entry.position_error = sigma.position;
  entry.yaw_error = sigma.yaw;
  entry.size_error = sigma.size;
  error->x = sigma.position * core::Normal(*rng);
  error->y = sigma.position * core::Normal(*rng);
  error->yaw = sigma.yaw * core::Normal(*rng);
  error->factor = entry.articulated ? 1.0 : std::exp(sigma.size * core::Normal(*rng));
  entry.size = error->factor * core::Bounds(object.visual.mesh).sizes();
  return entry;
}

std::string NameIn(const library_fit::Instance& instance, std::map<std::string, int>* count) {
  const std::string& kind = KindOf(instance).name;
  return kind + "_" + std::to_string(++(*count)[kind]);
}

}  // namespace

TransferTable PerturbedTable(const twin::TableScene& scene, double iou, std::uint64_t seed,
                             core::Rng* rng, const fs::path& folder) {
  TransferTable made;
  made.twin.photo = "table.png";
  made.twin.camera = TwinCamera(scene);
  made.table.finger_friction = LogUniform(0.8, 2.0, rng);
  const Eigen::Isometry3d twin_from_scene = TwinFromScene(scene.camera);
  std::map<std::string, int> count;
  for (const twin::TableObject& object : scene.objects) {
    const Eigen::Isometry3d truth = twin_from_scene * object.world_from_object;
    TwinError error;
    workflows::TwinObject entry = PerturbedEntry(object, truth, made.twin.camera, iou, rng, &error);
    entry.name = NameIn(object.instance, &count);
    const fs::path asset = folder / "assets" / entry.name;
    Eigen::Isometry3d instance_from_asset;
    try {
      instance_from_asset =
          WriteInstance(object.instance, error.factor, entry.name, ++seed, folder / "assets");
    } catch (const core::Error&) {  // some instances have no closed solid
      fs::remove_all(asset);
      continue;
    }
    // The asset's frame lies in that of the scaled instance.
    Eigen::Isometry3d true_from_asset = instance_from_asset;
    true_from_asset.translation() /= error.factor;
    transfer::TransferObject& real = made.table.objects.emplace_back(
        TrueObject(asset, error.factor, entry.name, truth * true_from_asset, entry.articulated));
    SampleSurface(rng, &real);
    Eigen::Vector3d foot = truth.translation();
    foot.z() = 0.0;
    entry.world_from_object = Moved(truth, foot, error.x, error.y, error.yaw) * instance_from_asset;
    made.twin.objects.push_back(std::move(entry));
    made.is_real.push_back(true);
  }
  core::Findings unread;
  workflows::SettleTwin(folder / "assets", &made.twin, &unread);
  core::WriteFile(folder / "twin.json", workflows::TwinJson(made.twin));
  return made;
}

TransferTable ReconstructedTable(const twin::TableScene& scene,
                                 const twin::TableSceneSources& sources,
                                 const library_fit::LibraryPrior& prior, std::uint64_t seed,
                                 const fs::path& folder, const fs::path& true_folder) {
  const twin::TablePicture picture = twin::RenderTable(scene, sources, {}, seed);
  std::vector<int> indices;
  twin::Detections found;
  found.objects = TrueDetections(picture, static_cast<int>(scene.objects.size()), &indices);
  found.camera.camera = twin::TableCameraOf(scene.camera);
  found.camera.elevation_error = found.camera.roll_error = 0.0;
  found.camera.log_focal_error = found.camera.log_height_error = 0.0;
  TransferTable made;
  core::Rng rng = core::StreamRng(seed, 2);
  made.table.finger_friction = LogUniform(0.8, 2.0, &rng);
  if (found.objects.empty()) throw core::Error("the picture shows no object", "table");
  core::Progress silent;
  core::Findings unread;
  const twin::TableReconstruction rebuilt =
      twin::ReconstructTable(picture.color, found, prior, {}, &silent);
  made.twin.photo = "table.png";
  made.twin.camera = rebuilt.camera.At(picture.color.width, picture.color.height);
  made.twin.log_scale_error = rebuilt.log_scale_error;
  const std::vector<twin::TableAsset> assets;
  const workflows::TwinPlacements placements;
  std::map<std::string, int> names;
  const workflows::TwinAssetSources made_of{rebuilt,    picture.color, found, assets,
                                            placements, 0.0,           seed};
  made.twin.objects =
      workflows::WriteTwinAssets(made_of, folder / "assets", &names, &silent, &unread);
  workflows::SettleTwin(folder / "assets", &made.twin, &unread);
  core::WriteFile(folder / "twin.json", workflows::TwinJson(made.twin));
  core::WritePng(folder / "table.png", picture.color);
  // The true objects; those that the twin has, by the box of their detection, take its names.
  made.is_real.assign(made.twin.objects.size(), false);
  const Eigen::Isometry3d twin_from_scene = TwinFromScene(scene.camera);
  for (size_t k = 0; k < scene.objects.size(); ++k) {
    const twin::TableObject& object = scene.objects[k];
    std::string name = "true_" + std::to_string(k);
    Eigen::Isometry3d instance_from_asset;
    try {
      instance_from_asset = WriteInstance(object.instance, 1.0, name, ++seed, true_folder);
    } catch (const core::Error&) {
      continue;
    }
    const fs::path asset = true_folder / name;
    for (size_t d = 0; d < indices.size(); ++d) {
      if (indices[d] != static_cast<int>(k)) continue;
      for (size_t i = 0; i < made.twin.objects.size(); ++i) {
        if (!made.twin.objects[i].box.isApprox(found.objects[d].box)) continue;
        name = made.twin.objects[i].name;
        made.is_real[i] = true;
      }
    }
    transfer::TransferObject& real = made.table.objects.emplace_back(TrueObject(
        asset, 1.0, name, twin_from_scene * object.world_from_object * instance_from_asset,
        KindOf(object.instance).articulated != nullptr));
    SampleSurface(&rng, &real);
  }
  return made;
}

}  // namespace simwright::bench
