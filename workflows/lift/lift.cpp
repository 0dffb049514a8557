#include "workflows/lift/lift.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include "asset_build/preview.h"
#include "asset_lift/multi_view/multi_view_lift.h"
#include "assets/asset_folder.h"
#include "assets/camera_file.h"
#include "core/error.h"
#include "core/files.h"
#include "physics_params/size_plausibility.h"
#include "render/forward.h"
#include "validation/appearance.h"
#include "validation/check_report.h"
#include "workflows/lift/cut_out.h"
#include "workflows/lift/fitted_lift.h"
#include "workflows/lift/generated_lift.h"
#include "workflows/lift/lift_finishing.h"
#include "workflows/priors/prior_weights.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Composes the photo, the matte, and the mesh from the photo's camera side by side.
core::Image LiftSheet(const asset_lift::LiftedMesh& lifted, const core::Image& cut) {
  render::Scene scene;
  scene.Add(&lifted.mesh);
  scene.Commit();
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.lit = false;
  return core::ContactSheet(
      {lifted.photo, cut, render::RenderForward(scene, lifted.camera, options).color}, 3);
}

// Returns the factor from the reconstruction's arbitrary scale to metres: by the requested height,
// or else to the sampled size.
double ScaleOf(double height, const physics_params::PhysicalParameters& parameters,
               const core::TriangleMesh& mesh, const std::string& where) {
  if (height > 0.0) return height / asset_build::GroundBoxOf(mesh).sides.z();
  return asset_build::ScaleToSampledSize(parameters, mesh, where);
}

}  // namespace

void RequireLiftable(const std::string& category, const fs::path& output, bool force) {
  physics_params::RequireCategory(category);
  const core::StagedFolder staged(output, force);
}

asset_lift::CategoryPrior PriorOf(const physics_params::Category& category) {
  asset_lift::CategoryPrior prior;
  prior.length_min = category.length.min;
  prior.length_max = category.length.max;
  prior.width_min = category.width.min;
  prior.width_max = category.width.max;
  prior.height_min = category.height.min;
  prior.height_max = category.height.max;
  prior.round = category.shape == physics_params::Shape::kRound;
  prior.revolved = category.shape == physics_params::Shape::kRevolved;
  prior.open = category.fill == physics_params::Fill::kOpen;
  prior.flat = category.shape == physics_params::Shape::kFlat;
  prior.angular = category.shape == physics_params::Shape::kBox;
  return prior;
}

namespace {

// The standard error of ln(volume) of a reconstruction from many photos in metres: an assumption of
// 5 % a side.
constexpr double kPhotoVolumeError = 0.15;

// Returns the photo's camera in the asset's link frame; `scale`: metres per unit of the camera's.
core::Camera CameraInLink(core::Camera camera, double scale, const assets::Asset& asset) {
  camera.world_from_camera.translation() *= scale;
  camera.world_from_camera = asset.link_from_input * camera.world_from_camera;
  return camera;
}

// Returns the judgement of an asset's looks as a finding.
core::Finding AppearanceFinding(const validation::Appearance& appearance, const std::string& name) {
  const bool good = appearance.look <= validation::Look::kB;
  return {"appearance",
          good ? core::Severity::kInfo : core::Severity::kWarning,
          name,
          validation::AppearanceSentence(appearance),
          static_cast<double>(appearance.look),
          appearance.remedy};
}

}  // namespace

double ScaleToMetres(const Finishing& finishing, const core::TriangleMesh& mesh) {
  const physics_params::KnowledgeBase& knowledge = physics_params::KnowledgeBase::Shipped();
  return ScaleOf(
      finishing.height,
      physics_params::SampleParameters(
          physics_params::ChosenRow(finishing.category, finishing.stated.variant, knowledge),
          knowledge, finishing.seed),
      mesh, finishing.source);
}

LiftOutcome FinishLift(const Finishing& finishing, double lift_seconds,
                       asset_lift::LiftedMesh lifted, core::StagedFolder* staged,
                       core::Progress* progress) {
  const physics_params::PhysicalParameters parameters = physics_params::SampleParameters(
      physics_params::ChosenRow(finishing.category, finishing.stated.variant,
                                physics_params::KnowledgeBase::Shipped()),
      physics_params::KnowledgeBase::Shipped(), finishing.seed);
  const core::Image cut = CutOut(lifted.photo, lifted.matte.alpha);
  const core::Image sheet = LiftSheet(lifted, cut);
  double scale = finishing.metric && finishing.height <= 0.0
                     ? 1.0
                     : ScaleOf(finishing.height, parameters, lifted.mesh.mesh, finishing.source);
  core::Transform(Eigen::Affine3d(Eigen::Scaling(scale)), &lifted.mesh.mesh);
  const double before = core::Bounds(lifted.mesh.mesh).volume();
  asset_build::ScaleToSize(finishing.size, finishing.source, &lifted.mesh.mesh, &lifted.findings);
  scale *= std::cbrt(core::Bounds(lifted.mesh.mesh).volume() / before);
  if (finishing.height <= 0.0 && finishing.size.empty() && !finishing.metric) {
    lifted.findings.push_back(
        asset_build::SizeDrawn(*finishing.category.category,
                               asset_build::GroundBoxOf(lifted.mesh.mesh).sides, finishing.source));
  }

  asset_build::BuildRequest build;
  build.name = finishing.output.filename().empty()
                   ? finishing.output.parent_path().filename().string()
                   : finishing.output.filename().string();
  build.source = finishing.source;
  build.category = finishing.category;
  build.stated = finishing.stated;
  build.budget = finishing.budget;
  build.seed = finishing.seed;
  if (finishing.metric) build.volume_error = kPhotoVolumeError;
  asset_build::BuiltAsset built = asset_build::BuildAsset(lifted.mesh, build, progress);
  built.asset.scale = scale;
  built.asset.findings.insert(built.asset.findings.begin(), lifted.findings.begin(),
                              lifted.findings.end());
  const fs::path& folder = staged->staging();
  core::WritePng(folder / validation::kCutOutFile, cut);
  // A stretched object has no camera that sees it as the photo does.
  if (finishing.size.size() != 3 && !std::isnan(lifted.silhouette_iou)) {
    const core::Camera camera = CameraInLink(lifted.camera, scale, built.asset);
    assets::WriteCameraFile({{validation::kCutOutFile, camera}},
                            folder / validation::kPhotoCameraFile);
    built.asset.findings.push_back(AppearanceFinding(
        validation::JudgeAppearance(built.asset, *validation::ReadAssetPhoto(folder)),
        built.asset.name));
  }
  assets::WriteAsset(built.asset, folder);
  core::WritePng(folder / "preview.png", asset_build::AssetPreview(built.asset));
  core::WritePng(folder / "lift.png", sheet);
  staged->Commit();
  LiftOutcome outcome{finishing.output, built.seconds, built.asset.findings, lifted.silhouette_iou};
  outcome.seconds["lift"] = lift_seconds;
  return outcome;
}

namespace {

// An object of the library that is textured by the photo has the photo as it is.
void SayDelightingUnused(core::Findings* findings) {
  std::erase_if(*findings, [](const core::Finding& f) { return f.code == "delighting"; });
  findings->push_back({"delighting-unused", core::Severity::kWarning, "",
                       "the fitted object of the library keeps the photo's shading in its texture",
                       0.0, "lift with --shape free"});
}

double LiftSeconds(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

LiftOutcome LiftToFolder(const LiftRequest& request, core::Progress* progress) {
  if (request.generator.given()) return LiftByGenerator(request, progress);
  core::StagedFolder staged(request.output, request.force);
  Finishing finishing{request.output,
                      request.photo.filename().string(),
                      physics_params::RequireCategory(request.category),
                      request.height,
                      request.size,
                      request.stated,
                      request.budget,
                      false,
                      request.seed};
  if (request.shape == LiftShape::kFitted) RequireFittable(finishing);
  const std::string bytes = core::ReadFile(request.photo, 1ull << 30);
  asset_lift::LiftOptions options;
  core::ImageReadOptions read;
  read.max_side = options.max_side;
  const core::Image photo = core::DecodeImage(bytes, request.photo.string(), read);
  if (request.mask) options.mask = core::ReadImage(*request.mask);
  if (request.elevation_degrees >= 0.0) options.elevation = request.elevation_degrees * kDegree;
  options.field_of_view = request.fov_degrees * kDegree;
  options.focal_35mm = core::ExifFocalLength35mm(bytes);
  options.segmentation.network = request.segmenter;
  options.seed = request.seed;
  options.delight = request.delight;
  // A fit needs the object's outline alone.
  options.effort =
      request.shape == LiftShape::kFitted ? asset_lift::LiftEffort::kOutline : request.effort;
  if (!request.prior.empty()) asset_lift::ConfigureForPublishedViewPrior(&options);
  const auto start = std::chrono::steady_clock::now();
  core::Findings findings;
  asset_lift::LiftPriors priors;
  if (options.effort != asset_lift::LiftEffort::kOutline) {
    priors = LoadLiftPriors(request.prior, &findings);
  }
  asset_lift::LiftedMesh lifted;
  try {
    lifted = asset_lift::LiftPhoto(photo, PriorOf(*finishing.category.category), priors, options,
                                   progress);
  } catch (const core::Error& error) {
    throw core::Error(error.what(), request.photo.string());
  }
  lifted.findings.insert(lifted.findings.begin(), findings.begin(), findings.end());
  if (request.shape != LiftShape::kFree) {
    const std::optional<ChosenFit> chosen =
        ChooseFit(request.shape, finishing, lifted, &lifted.findings, progress);
    if (chosen && chosen->articulated) {
      try {
        return FinishArticulated(*chosen, finishing, LiftSeconds(start), lifted, &staged);
      } catch (const validation::CheckFailed& failed) {
        if (request.shape == LiftShape::kFitted) throw;
        RejectFit(failed, finishing, staged.staging(), &lifted.findings);
      }
    } else if (chosen) {
      TakeFit(*chosen, &lifted);
    }
    if (chosen && request.delight) SayDelightingUnused(&lifted.findings);
  }
  return FinishLift(finishing, LiftSeconds(start), std::move(lifted), &staged, progress);
}

LiftOutcome LiftToFolder(const MultiLiftRequest& request, core::Progress* progress) {
  core::StagedFolder staged(request.output, request.force);
  Finishing finishing{request.output,
                      request.cameras.filename().string(),
                      physics_params::RequireCategory(request.category),
                      request.height,
                      request.size,
                      request.stated,
                      request.budget,
                      true,
                      request.seed};
  const std::map<std::string, core::Camera> cameras = assets::ReadCameraFile(request.cameras);
  std::vector<asset_lift::PosedPhoto> photos;
  for (const std::filesystem::path& path : request.photos) {
    const auto found = cameras.find(path.filename().string());
    if (found == cameras.end()) {
      throw core::Error("has no camera for " + path.filename().string(), request.cameras.string());
    }
    photos.push_back({core::ReadImage(path), found->second, path.filename().string()});
    if (photos.back().photo.width != found->second.width ||
        photos.back().photo.height != found->second.height) {
      throw core::Error("does not have the size of its camera", path.string());
    }
  }
  asset_lift::MultiViewOptions options;
  options.field_stage = request.effort == asset_lift::LiftEffort::kFull;
  options.seed = request.seed;
  const auto start = std::chrono::steady_clock::now();
  asset_lift::LiftedMesh lifted =
      asset_lift::LiftPhotos(photos, PriorOf(*finishing.category.category), options, progress);
  return FinishLift(finishing, LiftSeconds(start), std::move(lifted), &staged, progress);
}

}  // namespace simwright::workflows
