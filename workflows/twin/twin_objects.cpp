#include "workflows/twin/twin_objects.h"

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "asset_build/articulated_preview.h"
#include "asset_build/asset_builder.h"
#include "asset_build/preview.h"
#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/finding_text.h"
#include "core/parallel.h"
#include "library_fit/fit_kinds.h"
#include "library_fit/fitted_object.h"
#include "library_fit/library_fit.h"
#include "physics_params/category_resolution.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

const library_fit::FitKind& KindOf(const twin::ReconstructedObject& object) {
  return library_fit::FitKinds()[static_cast<size_t>(object.fit.instance.kind)];
}

std::string CategoryOf(const library_fit::FitKind& kind) {
  return kind.rigid != nullptr ? kind.rigid->category
                               : (kind.categories.empty() ? kind.name : kind.categories.front());
}

// Returns unique names of asset folders: "mug_1", "mug_2".
std::vector<std::string> NamesOf(const twin::TableReconstruction& table) {
  std::map<std::string, int> count;
  std::vector<std::string> names;
  for (const twin::ReconstructedObject& object : table.objects) {
    const std::string& kind = KindOf(object).name;
    names.push_back(kind + "_" + std::to_string(++count[kind]));
  }
  return names;
}

// Writes one asset and returns its pose in the frame of the fitted instance.
Eigen::Isometry3d WriteTwinAsset(const library_fit::SeenInstance& seen,
                                 const library_fit::FitPhoto& photo, const std::string& name,
                                 std::uint64_t seed, const fs::path& folder,
                                 core::Findings* findings) {
  const library_fit::FitKind& kind =
      library_fit::FitKinds()[static_cast<size_t>(seen.instance.kind)];
  fs::create_directories(folder);
  if (kind.articulated != nullptr) {
    assets::ArticulatedAsset asset = library_fit::PaintedAsset(seen, photo);
    asset.name = name;
    assets::WriteArticulatedAsset(asset, folder);
    core::WritePng(folder / "preview.png", asset_build::ArticulatedPreview(asset));
    return Eigen::Isometry3d::Identity();
  }
  asset_build::BuildRequest request;
  request.name = name;
  request.source = "twin";
  request.category = physics_params::RequireCategory(kind.rigid->category);
  request.seed = seed;
  request.parts = library_fit::InstanceObject(seen.instance).parts;
  core::Progress silent;
  const assets::Asset asset =
      asset_build::BuildAsset(library_fit::PaintedInstance(seen, photo), request, &silent).asset;
  assets::WriteAsset(asset, folder);
  core::WritePng(folder / "preview.png", asset_build::AssetPreview(asset));
  for (core::Finding finding : asset.findings) {
    if (finding.severity == core::Severity::kInfo) continue;
    finding.place = name;
    findings->push_back(std::move(finding));
  }
  return asset.link_from_input.inverse();
}

}  // namespace

std::vector<TwinObject> WriteTwinAssets(const twin::TableReconstruction& table,
                                        const core::Image& photo,
                                        const twin::Detections& detections, std::uint64_t seed,
                                        const fs::path& folder, core::Progress* progress,
                                        core::Findings* findings) {
  const core::Camera camera = table.camera.At(photo.width, photo.height);
  const std::vector<std::string> names = NamesOf(table);
  std::vector<std::optional<TwinObject>> made(table.objects.size());
  std::vector<core::Findings> found(table.objects.size());
  core::ParallelFor(static_cast<int>(table.objects.size()), [&](int i) {
    const auto at = static_cast<size_t>(i);
    const twin::ReconstructedObject& object = table.objects[at];
    const twin::Detection& detection = detections.objects[static_cast<size_t>(object.detection)];
    const Eigen::Isometry3d world_from_instance = object.fit.pose.WorldFromObject();
    library_fit::SeenInstance seen{object.fit.instance, camera};
    seen.camera.world_from_camera = world_from_instance.inverse() * camera.world_from_camera;
    TwinObject entry;
    entry.name = names[at];
    entry.kind = KindOf(object).name;
    entry.category = CategoryOf(KindOf(object));
    entry.articulated = KindOf(object).articulated != nullptr;
    entry.size = core::Bounds(library_fit::InstanceMesh(object.fit.instance).mesh).sizes();
    entry.confidence = object.confidence;
    entry.outline_iou = object.fit.agreement.iou;
    entry.position_error = object.position_error;
    entry.yaw_error = object.yaw_error;
    entry.size_error = object.size_error;
    entry.box = detection.box;
    try {
      const Eigen::Isometry3d instance_from_asset =
          WriteTwinAsset(seen, library_fit::FitPhotoOf(photo, detection.alpha), entry.name,
                         seed + static_cast<std::uint64_t>(i), folder / entry.name, &found[at]);
      entry.world_from_object = world_from_instance * instance_from_asset;
      made[at] = std::move(entry);
    } catch (const core::Error& error) {
      fs::remove_all(folder / names[at]);
      core::Finding finding = core::FindingOf(error);
      finding.code = "twin-asset-failed";
      finding.severity = core::Severity::kWarning;
      finding.place = names[at];
      found[at].push_back(std::move(finding));
    }
    progress->Advance();
  });
  std::vector<TwinObject> objects;
  for (size_t i = 0; i < made.size(); ++i) {
    if (made[i]) objects.push_back(std::move(*made[i]));
    findings->insert(findings->end(), found[i].begin(), found[i].end());
  }
  return objects;
}

}  // namespace simwright::workflows
