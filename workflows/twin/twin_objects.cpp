#include "workflows/twin/twin_objects.h"

#include <cmath>
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
#include "twin/asset_retrieval.h"
#include "workflows/twin/twin_free_form.h"

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
std::vector<std::string> NamesOf(const TwinAssetSources& sources,
                                 std::map<std::string, int>* count) {
  std::vector<std::string> names;
  for (const twin::ReconstructedObject& object : sources.table.objects) {
    const std::string& base = twin::NameOf(object, sources.assets);
    names.push_back(base + "_" + std::to_string(++(*count)[base]));
  }
  return names;
}

// Returns the position of the first moving joint at a share of its range.
std::map<std::string, double> OpenJoint(const assets::ArticulatedAsset& asset, double opening) {
  for (const assets::Joint& joint : asset.joints) {
    if (joint.Moves()) return {{joint.name, joint.lower + opening * (joint.upper - joint.lower)}};
  }
  return {};
}

// Returns the entry of an object, all but its asset.
TwinObject EntryOf(const twin::ReconstructedObject& object, const twin::Detection& detection) {
  TwinObject entry;
  entry.kind = KindOf(object).name;
  entry.category = CategoryOf(KindOf(object));
  entry.articulated = KindOf(object).articulated != nullptr;
  entry.size = object.retrieved >= 0
                   ? object.fit.instance.size
                   : core::Bounds(library_fit::InstanceMesh(object.fit.instance).mesh).sizes();
  entry.confidence = object.confidence;
  entry.outline_iou = object.fit.agreement.iou;
  entry.position_error = object.position_error;
  entry.yaw_error = object.yaw_error;
  entry.size_error = object.size_error;
  entry.box = detection.box;
  entry.world_from_object = object.fit.pose.WorldFromObject();
  return entry;
}

// Copies an asset of the user.
void CopyAsset(const twin::TableAsset& asset, const fs::path& folder, TwinObject* entry) {
  std::error_code fault;
  fs::copy(fs::canonical(asset.folder), folder, fs::copy_options::recursive, fault);
  if (fault) throw core::Error("cannot be copied: " + fault.message(), asset.folder.string());
  entry->source = TwinSource::kRetrieved;
  entry->kind = asset.name;
  entry->category = asset.category;
  entry->articulated = asset.articulated;
}

// Writes a fitted object, and moves the entry's pose from the instance's frame to the asset's.
void WriteFittedAsset(const library_fit::SeenInstance& seen, const library_fit::FitPhoto& photo,
                      std::uint64_t seed, const fs::path& folder, TwinObject* entry,
                      core::Findings* findings) {
  const library_fit::FitKind& kind =
      library_fit::FitKinds()[static_cast<size_t>(seen.instance.kind)];
  fs::create_directories(folder);
  if (kind.articulated != nullptr) {
    assets::ArticulatedAsset asset = library_fit::PaintedAsset(seen, photo);
    asset.name = entry->name;
    assets::WriteArticulatedAsset(asset, folder);
    core::WritePng(folder / "preview.png", asset_build::ArticulatedPreview(asset));
    if (kind.opening > 0.0) entry->joints = OpenJoint(asset, seen.instance.opening);
    if (!entry->joints.empty()) {
      findings->push_back({"twin-joint-closed", core::Severity::kInfo, entry->name,
                           "twin.json has the joint's position in the photo; physics and the "
                           "commands of scene begin with it closed",
                           entry->joints.begin()->second});
    }
    return;
  }
  asset_build::BuildRequest request;
  request.name = entry->name;
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
    finding.place = entry->name;
    findings->push_back(std::move(finding));
  }
  entry->world_from_object = entry->world_from_object * asset.link_from_input.inverse();
}

// Writes the asset of the object `index`: retrieved or fitted.
TwinObject WriteTwinAsset(const TwinAssetSources& sources, size_t index, const std::string& name,
                          const fs::path& folder, core::Findings* findings) {
  const twin::ReconstructedObject& object = sources.table.objects[index];
  const twin::Detection& detection =
      sources.detections.objects[static_cast<size_t>(object.detection)];
  TwinObject entry = EntryOf(object, detection);
  entry.name = name;
  const Eigen::Isometry3d view_from_instance = entry.world_from_object;
  if (!sources.placements.poses.empty()) {
    entry.world_from_object = sources.placements.poses[index].WorldFromObject();
    entry.seen_in = sources.placements.seen_in[index];
  }
  if (object.retrieved >= 0) {
    CopyAsset(sources.assets[static_cast<size_t>(object.retrieved)], folder, &entry);
    return entry;
  }
  const core::Camera camera = sources.table.camera.At(sources.photo.width, sources.photo.height);
  library_fit::SeenInstance seen{object.fit.instance, camera};
  seen.camera.world_from_camera = view_from_instance.inverse() * camera.world_from_camera;
  WriteFittedAsset(seen, library_fit::FitPhotoOf(sources.photo, detection.alpha),
                   sources.seed + static_cast<std::uint64_t>(index), folder, &entry, findings);
  return entry;
}

core::Finding AssetFinding(const core::Error& error, const char* code, const std::string& name) {
  core::Finding finding = core::FindingOf(error);
  finding.code = code;
  finding.severity = core::Severity::kWarning;
  finding.place = name;
  return finding;
}

// Replaces the assets of doubtful objects by reconstructions from the photo, one after the other.
void LiftDoubtful(const TwinAssetSources& sources, const fs::path& folder,
                  std::vector<std::optional<TwinObject>>* made, core::Progress* progress,
                  core::Findings* findings) {
  const core::Camera camera = sources.table.camera.At(sources.photo.width, sources.photo.height);
  for (size_t i = 0; i < made->size(); ++i) {
    const twin::ReconstructedObject& object = sources.table.objects[i];
    if (!(*made)[i] || object.retrieved >= 0 || object.confidence >= sources.free_form) continue;
    TwinObject& entry = *(*made)[i];
    try {
      LiftTwinObject(sources.photo,
                     sources.detections.objects[static_cast<size_t>(object.detection)], camera,
                     object.fit.pose, sources.seed, folder / entry.name, &entry, progress);
      if (!sources.placements.poses.empty()) {
        // Several photos place the object elsewhere than its own does.
        entry.world_from_object = sources.placements.poses[i].WorldFromObject() *
                                  object.fit.pose.WorldFromObject().inverse() *
                                  entry.world_from_object;
      }
    } catch (const core::Error& error) {
      findings->push_back(AssetFinding(error, "twin-free-form-failed", entry.name));
    }
  }
}

}  // namespace

TwinPlacements TakeMerged(const twin::MergedTables& merged, int view,
                          twin::TableReconstruction* table) {
  const double log_factor =
      merged.log_scale + merged.first_from_view[static_cast<size_t>(view)].log_scale;
  const double factor = std::exp(log_factor);
  TwinPlacements placements;
  std::vector<twin::ReconstructedObject> taken;
  for (const twin::MergedObject& object : merged.objects) {
    if (object.view != view) continue;
    twin::ReconstructedObject copy = table->objects[static_cast<size_t>(object.object)];
    copy.fit.pose.x *= factor;
    copy.fit.pose.y *= factor;
    if (copy.retrieved < 0) copy.fit.instance.size *= object.size_factor;
    copy.confidence = object.confidence;
    copy.position_error = object.position_error;
    copy.yaw_error = object.yaw_error;
    copy.size_error = object.size_error;
    taken.push_back(std::move(copy));
    placements.poses.push_back(object.pose);
    placements.seen_in.push_back(object.seen_in);
  }
  table->objects = std::move(taken);
  table->camera.height *= factor;
  table->log_scale_error = merged.log_scale_error;
  return placements;
}

std::vector<TwinObject> WriteTwinAssets(const TwinAssetSources& sources, const fs::path& folder,
                                        std::map<std::string, int>* count, core::Progress* progress,
                                        core::Findings* findings) {
  const std::vector<std::string> names = NamesOf(sources, count);
  std::vector<std::optional<TwinObject>> made(names.size());
  std::vector<core::Findings> found(names.size());
  fs::create_directories(folder);
  core::ParallelFor(static_cast<int>(names.size()), [&](int i) {
    const auto at = static_cast<size_t>(i);
    try {
      made[at] = WriteTwinAsset(sources, at, names[at], folder / names[at], &found[at]);
    } catch (const core::Error& error) {
      fs::remove_all(folder / names[at]);
      found[at].push_back(AssetFinding(error, "twin-asset-failed", names[at]));
    }
    progress->Advance();
  });
  for (const core::Findings& of : found) findings->insert(findings->end(), of.begin(), of.end());
  if (sources.free_form > 0.0) LiftDoubtful(sources, folder, &made, progress, findings);
  std::vector<TwinObject> objects;
  for (std::optional<TwinObject>& object : made) {
    if (object) objects.push_back(std::move(*object));
  }
  return objects;
}

}  // namespace simwright::workflows
