#include "workflows/twin/twin.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>

#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "library_fit/library_prior.h"
#include "twin/asset_retrieval.h"
#include "twin/depth_agreement.h"
#include "twin/depth_objects.h"
#include "twin/object_detector.h"
#include "twin/table_merging.h"
#include "twin/table_reconstruction.h"
#include "workflows/priors/models_folder.h"
#include "workflows/priors/prior_training.h"
#include "workflows/twin/twin_detections.h"
#include "workflows/twin/twin_objects.h"
#include "workflows/twin/twin_page.h"
#include "workflows/twin/twin_photo.h"
#include "workflows/twin/twin_pictures.h"
#include "workflows/twin/twin_settling.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr double kDegreeInRadian = M_PI / 180.0;
constexpr double kDoubtful = 0.25;          // confidence
constexpr double kLeastObjectShare = 2e-4;  // of the photo's pixels that show objects

// Finds the objects by the first that is given: the user's boxes, the vision model, the user's
// detector, the depth, the shipped detector.
TwinDetections DetectObjects(const TwinRequest& request, const TwinView& view,
                             const TwinPhoto& photo, core::Progress* progress,
                             core::Findings* findings) {
  progress->Stage("detecting objects");
  const fs::path weights =
      request.detector.empty() ? DetectorWeights(ModelsFolder()) : request.detector;
  const bool has_weights = fs::exists(weights);
  const bool stated = !view.objects.empty() || request.model != nullptr;
  if (!view.objects.empty() && request.model != nullptr) {
    throw core::Error("boxes are given, so the vision model has nothing to do",
                      view.objects.string(), "leave out --objects or --llm");
  }
  if (!request.detector.empty() && !has_weights) {
    throw core::Error("no such weights of a detector", weights.string());
  }
  if (!request.detector.empty() && stated) {
    throw core::Error("boxes are given, so the detector has nothing to do",
                      request.detector.string(), "leave out --detector, or --objects and --llm");
  }
  TwinDetections detected;
  if (!view.objects.empty()) {
    detected = ReadTwinObjects(view.objects, photo.rgb, photo.width, photo.height);
  } else if (request.model != nullptr) {
    detected = AskForTwinObjects(request.model, photo, progress, findings);
  } else if (photo.plane && request.detector.empty()) {
    detected.found.objects = twin::ObjectsAbovePlane(photo.depth, *photo.plane);
  } else if (has_weights) {
    detected.found = twin::ObjectDetector(weights).Detect(photo.rgb);
    if (detected.found.object_share < kLeastObjectShare) detected.found.objects.clear();
    return detected;
  } else {
    throw core::Error("the weights of the table detector are missing", weights.string(),
                      "simwright prior train --only detector -o models makes them; --objects, "
                      "--llm or --depth find the objects without it");
  }
  return detected;
}

// Replaces guessed numbers by what the user and the files know.
void StateCamera(const TwinCameraFlags& flags, const TwinPhoto& photo,
                 twin::TableCameraGuess* guess) {
  if (photo.plane) {
    *guess = {photo.plane->camera, 0.0, 0.0, 0.0, 0.0};
    return;
  }
  twin::TableCamera& camera = guess->camera;
  camera.principal = photo.principal;
  if (photo.focal > 0.0) {
    camera.focal = photo.focal;
    guess->log_focal_error = photo.log_focal_error;
  }
  if (flags.elevation > 0.0) {
    camera.elevation = flags.elevation * kDegreeInRadian;
    guess->elevation_error = 0.0;
  }
  if (flags.upright) {
    camera.roll = 0.0;
    guess->roll_error = 0.0;
  }
  if (flags.height > 0.0) {
    camera.height = flags.height;
    guess->log_height_error = 0.0;
  }
}

// Reports a scale that nothing determined.
void ReportScale(const twin::TableCameraGuess& guess, core::Findings* findings) {
  const bool from_assets = std::any_of(
      findings->begin(), findings->end(),
      [](const core::Finding& finding) { return finding.code == "twin-scale-from-assets"; });
  if (guess.log_height_error <= 0.0 || from_assets) return;
  findings->push_back({"twin-scale-guessed", core::Severity::kInfo, "",
                       "the camera's height above the table is not known; the scale is that with "
                       "which the objects have usual sizes",
                       0.0, "--camera-height or --depth give true sizes"});
}

core::Findings KindFindings(const twin::TableReconstruction& table,
                            const std::vector<twin::TableAsset>& assets) {
  core::Findings findings;
  size_t doubtful = 0;
  for (const twin::ReconstructedObject& object : table.objects) {
    if (object.confidence >= kDoubtful) continue;
    ++doubtful;
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "confidence %.2f, outline IoU %.2f", object.confidence,
                  object.fit.agreement.iou);
    findings.push_back(
        {"twin-doubtful", core::Severity::kWarning, "",
         "object " + std::to_string(object.detection + 1) + " is doubtful: taken for " +
             (object.retrieved < 0 ? "a " : "the asset ") + twin::NameOf(object, assets) +
             " with " + numbers,
         object.confidence, "--objects states its box and category; --free-form reconstructs it"});
  }
  if (doubtful == table.objects.size()) {
    findings.push_back({"twin-no-table", core::Severity::kWarning, "",
                        "no object agrees well with the photo: it may show no table, or a wall, a "
                        "mirror or a screen",
                        static_cast<double>(doubtful), "compare overlay.png with the photo"});
  }
  return findings;
}

// Adds what an uncertain focal length means for lengths that depth gives: across the picture they
// are in proportion to its inverse.
void AddLensError(double log_focal_error, twin::TableReconstruction* table) {
  for (twin::ReconstructedObject& object : table->objects) {
    object.position_error =
        std::hypot(object.position_error, log_focal_error * std::abs(object.fit.pose.x));
    object.size_error = std::hypot(object.size_error, log_focal_error);
  }
}

// Rebuilds the detected objects, with the user's assets where they are found again.
twin::TableReconstruction Reconstruct(const TwinRequest& request, const TwinPhoto& photo,
                                      const TwinDetections& detected,
                                      const std::vector<twin::TableAsset>& assets,
                                      core::Progress* progress, core::Findings* findings) {
  const library_fit::LibraryPrior prior(LibraryWeights(ModelsFolder()));
  twin::TableReconstructionOptions options;
  options.kinds = detected.kinds;
  options.seed = request.seed;
  twin::TableReconstruction table =
      twin::ReconstructTable(photo.rgb, detected.found, prior, options, progress);
  const auto report = [findings](const core::Findings& more) {
    findings->insert(findings->end(), more.begin(), more.end());
  };
  if (photo.plane && photo.log_focal_error > 0.0) AddLensError(photo.log_focal_error, &table);
  if (photo.plane) report(twin::CompareWithDepth(table, detected.found, photo.depth));
  if (!assets.empty()) {
    progress->Stage("assets of yours", static_cast<std::int64_t>(table.objects.size()));
    twin::RetrievalOptions retrieval;
    retrieval.seed = request.seed;
    twin::RetrieveAssets(photo.rgb, detected.found, assets, retrieval, &table, progress, findings);
  }
  report(KindFindings(table, assets));
  ReportScale(detected.found.camera, findings);
  return table;
}

// A photo with the table that was rebuilt from it.
struct RebuiltView {
  TwinPhoto photo;
  TwinDetections detected;
  twin::TableReconstruction table;
};

RebuiltView RebuildView(const TwinRequest& request, const TwinView& view,
                        const std::vector<twin::TableAsset>& assets, core::Progress* progress,
                        core::Findings* findings) {
  RebuiltView rebuilt;
  rebuilt.photo = ReadTwinPhoto(request, view, findings);
  rebuilt.detected = DetectObjects(request, view, rebuilt.photo, progress, findings);
  if (rebuilt.detected.found.objects.empty()) {
    throw core::Error("no object on a table is found in the photo", view.photo.string(),
                      "take it from above so that the whole table top shows, in even light, or "
                      "give boxes with --objects");
  }
  LimitDetections(request.most_objects, &rebuilt.detected, findings);
  StateCamera(request.camera, rebuilt.photo, &rebuilt.detected.found.camera);
  rebuilt.table = Reconstruct(request, rebuilt.photo, rebuilt.detected, assets, progress, findings);
  return rebuilt;
}

// Rebuilds each photo alone, with findings that name their photo if there are several.
std::vector<RebuiltView> RebuildViews(const TwinRequest& request,
                                      const std::vector<twin::TableAsset>& assets,
                                      core::Progress* progress, core::Findings* findings) {
  if (!request.more.empty() && request.camera.StatesPose()) {
    throw core::Error("several photos have cameras at several places", request.photo.string(),
                      "leave out --elevation, --camera-height and --upright");
  }
  std::vector<TwinView> views{request};
  views.insert(views.end(), request.more.begin(), request.more.end());
  std::vector<RebuiltView> rebuilt;
  for (const TwinView& view : views) {
    core::Findings of_view;
    rebuilt.push_back(RebuildView(request, view, assets, progress, &of_view));
    for (core::Finding& finding : of_view) {
      if (views.size() > 1 && finding.place.empty()) {
        finding.place = view.photo.filename().string();
      }
      findings->push_back(std::move(finding));
    }
  }
  return rebuilt;
}

// Writes the assets of all objects, of several photos merged, and their entries in the record.
void WriteObjects(const TwinRequest& request, const std::vector<twin::TableAsset>& own,
                  std::vector<RebuiltView>* views, const fs::path& assets, core::Progress* progress,
                  TwinOutcome* outcome) {
  std::vector<TwinPlacements> placements(views->size());
  if (views->size() > 1) {
    std::vector<twin::TableReconstruction> tables;
    for (const RebuiltView& view : *views) tables.push_back(view.table);
    const twin::MergedTables merged = twin::MergeTables(tables, own);
    for (size_t v = 0; v < views->size(); ++v) {
      placements[v] = TakeMerged(merged, static_cast<int>(v), &(*views)[v].table);
    }
    outcome->findings.insert(outcome->findings.end(), merged.findings.begin(),
                             merged.findings.end());
  }
  size_t count = 0;
  for (const RebuiltView& view : *views) count += view.table.objects.size();
  progress->Stage("assets", static_cast<std::int64_t>(count));
  std::map<std::string, int> names;
  for (size_t v = 0; v < views->size(); ++v) {
    const RebuiltView& view = (*views)[v];
    const TwinAssetSources sources{view.table,  view.photo.rgb, view.detected.found,
                                   own,         placements[v],  request.free_form ? kDoubtful : 0.0,
                                   request.seed};
    for (TwinObject& object :
         WriteTwinAssets(sources, assets, &names, progress, &outcome->findings)) {
      outcome->record.objects.push_back(std::move(object));
    }
  }
}

void WriteTwinFiles(const TwinOutcome& outcome, const core::Image& photo, const fs::path& folder) {
  const TwinPictures pictures = RenderTwin(outcome.record, folder / "assets", photo);
  core::WritePng(folder / "photo.png", photo);
  core::WritePng(folder / "twin.png", pictures.rendered);
  core::WritePng(folder / "overlay.png", pictures.overlay);
  core::WritePng(folder / "above.png", pictures.above);
  core::WriteFile(folder / "twin.json", TwinJson(outcome.record));
  core::WriteFile(folder / "index.html",
                  TwinPage(outcome.record, outcome.findings, outcome.seconds));
}

}  // namespace

bool TwinCameraFlags::IsValid(std::string* error) const {
  const auto fail = [error](const char* reason) {
    if (error) *error = reason;
    return false;
  };
  if (fov != 0.0 && !(fov >= 6.0 && fov <= 118.0)) {
    return fail("the field of view must be 6 to 118 degrees");
  }
  if (elevation != 0.0 && !(elevation >= 3.0 && elevation <= 88.0)) {
    return fail("the elevation must be 3 to 88 degrees");
  }
  if (height != 0.0 && !(height >= 0.05 && height <= 20.0)) {
    return fail("the camera's height must be 5 cm to 20 m");
  }
  return true;
}

TwinOutcome MakeTwin(const TwinRequest& request, core::Progress* progress) {
  std::string error;
  if (!request.camera.IsValid(&error)) throw core::Error(error, "camera of the photo");
  const auto start = std::chrono::steady_clock::now();
  core::StagedFolder staged(request.output, request.force);
  TwinOutcome outcome;
  std::vector<twin::TableAsset> own;
  if (!request.assets.empty()) own = twin::ReadTableAssets(request.assets, &outcome.findings);
  std::vector<RebuiltView> views = RebuildViews(request, own, progress, &outcome.findings);
  const fs::path assets = staged.staging() / "assets";
  WriteObjects(request, own, &views, assets, progress, &outcome);
  const core::Image& photo = views.front().photo.rgb;
  const twin::TableReconstruction& table = views.front().table;
  outcome.record.photo = request.photo.filename().string();
  outcome.record.camera = table.camera.At(photo.width, photo.height);
  outcome.record.log_scale_error = table.log_scale_error;
  if (outcome.record.objects.empty()) {
    throw core::Error("no asset could be made of the photo's objects", request.photo.string());
  }
  progress->Stage("physics");
  SettleTwin(assets, &outcome.record, &outcome.findings);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  WriteTwinFiles(outcome, photo, staged.staging());
  progress->Finish();
  staged.Commit();
  outcome.folder = request.output;
  outcome.page = request.output / "index.html";
  return outcome;
}

std::string TwinTable(const TwinOutcome& outcome) {
  std::string text = "object              confidence  position      +-      yaw +-  size\n";
  for (const TwinObject& object : outcome.record.objects) {
    const Eigen::Vector3d at = object.world_from_object.translation();
    char line[200];
    std::snprintf(line, sizeof line,
                  "%-20s %8.2f  %.3f, %.3f m  %4.1f cm  %3.0f deg  %.1f x %.1f x %.1f cm\n",
                  object.name.c_str(), object.confidence, at.x(), at.y(),
                  100.0 * object.position_error, object.yaw_error / kDegreeInRadian,
                  100.0 * object.size.x(), 100.0 * object.size.y(), 100.0 * object.size.z());
    text += line;
  }
  char last[160];
  std::snprintf(last, sizeof last, "%zu objects in %.0f s; %s\n", outcome.record.objects.size(),
                outcome.seconds,
                outcome.record.stands ? "the scene stands still" : "not all objects stand");
  return text + last;
}

}  // namespace simwright::workflows
