#include "workflows/twin/twin.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "library_fit/library_prior.h"
#include "twin/object_detector.h"
#include "twin/table_reconstruction.h"
#include "workflows/priors/models_folder.h"
#include "workflows/priors/prior_training.h"
#include "workflows/twin/twin_detections.h"
#include "workflows/twin/twin_objects.h"
#include "workflows/twin/twin_page.h"
#include "workflows/twin/twin_pictures.h"
#include "workflows/twin/twin_settling.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr double kDegreeInRadian = M_PI / 180.0;
constexpr int kLongerSide = 960;     // pixels of the photo as used
constexpr double kFilmWidth = 36.0;  // mm, of EXIF's equivalent focal length
constexpr double kExifError = 0.03;  // of the logarithm of such a focal length
constexpr std::uint64_t kMostPhotoBytes = 256u << 20;
constexpr double kLeastShare = 2e-4;  // of the photo's pixels that show objects

// The photo in RGB, and what its file says.
struct TwinPhoto {
  core::Image rgb;
  int width = 0, height = 0;  // of the file
  double focal_35mm = 0.0;
};

core::Image InRgb(const core::Image& image) {
  if (image.channels == 3) return image;
  core::Image rgb(image.width, image.height, 3);
  for (size_t i = 0; i < rgb.pixels.size() / 3; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      rgb.pixels[3 * i + c] =
          image.pixels[i * static_cast<size_t>(image.channels) + (image.channels == 4 ? c : 0)];
    }
  }
  return rgb;
}

TwinPhoto ReadTwinPhoto(const fs::path& path) {
  TwinPhoto photo;
  const std::string bytes = core::ReadFile(path, kMostPhotoBytes);
  const core::Image whole = core::DecodeImage(bytes, path.string());
  photo.width = whole.width;
  photo.height = whole.height;
  photo.focal_35mm = core::ExifFocalLength35mm(bytes);
  const double scale =
      std::min(1.0, static_cast<double>(kLongerSide) / std::max(whole.width, whole.height));
  photo.rgb = InRgb(whole);
  if (scale < 1.0) {
    photo.rgb = core::Resize(photo.rgb, static_cast<int>(std::lround(scale * whole.width)),
                             static_cast<int>(std::lround(scale * whole.height)));
  }
  if (photo.rgb.width < 64 || photo.rgb.height < 64) {
    throw core::Error("the photo has less than 64 pixels a side", path.string());
  }
  return photo;
}

TwinDetections DetectObjects(const TwinRequest& request, const TwinPhoto& photo,
                             core::Progress* progress) {
  progress->Stage("detecting objects");
  const fs::path weights =
      request.detector.empty() ? DetectorWeights(ModelsFolder()) : request.detector;
  const bool has_weights = fs::exists(weights);
  if (!request.detector.empty() && !has_weights && request.objects.empty()) {
    throw core::Error("no such weights of a detector", weights.string());
  }
  if (!request.objects.empty()) {
    TwinDetections stated = ReadTwinObjects(request.objects, photo.rgb, photo.width, photo.height);
    if (has_weights) {
      stated.found.camera = twin::ObjectDetector(weights).Detect(photo.rgb).camera;
    }
    return stated;
  }
  if (!has_weights) {
    throw core::Error("the weights of the table detector are missing", weights.string(),
                      "simwright prior train --only detector -o models makes them; --objects gives "
                      "boxes instead");
  }
  TwinDetections detected;
  detected.found = twin::ObjectDetector(weights).Detect(photo.rgb);
  return detected;
}

// Replaces guessed numbers by what the user and the file know.
void StateCamera(const TwinCameraFlags& flags, const TwinPhoto& photo,
                 twin::TableCameraGuess* guess, core::Findings* findings) {
  twin::TableCamera& camera = guess->camera;
  if (flags.fov > 0.0) {
    camera.focal = 0.5 / std::tan(0.5 * flags.fov * kDegreeInRadian);
    guess->log_focal_error = 0.0;
  } else if (photo.focal_35mm > 0.0) {
    // The equivalent refers to the longer side.
    const double longer = std::max(photo.width, photo.height);
    camera.focal = photo.focal_35mm / kFilmWidth * longer / photo.width;
    guess->log_focal_error = kExifError;
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
    return;
  }
  findings->push_back({"twin-scale-guessed", core::Severity::kInfo, "",
                       "the camera's height above the table is not known; the scale is that with "
                       "which the objects have usual sizes",
                       0.0, "--camera-height gives true sizes"});
}

core::Findings KindFindings(const twin::TableReconstruction& table) {
  constexpr double kDoubtful = 0.25;
  core::Findings findings;
  for (const twin::ReconstructedObject& object : table.objects) {
    if (object.confidence >= kDoubtful) continue;
    const std::string& kind =
        library_fit::FitKinds()[static_cast<size_t>(object.fit.instance.kind)].name;
    char sentence[160];
    std::snprintf(sentence, sizeof sentence,
                  "object %d is doubtful: taken for a %s with confidence %.2f, outline IoU %.2f",
                  object.detection + 1, kind.c_str(), object.confidence, object.fit.agreement.iou);
    findings.push_back({"twin-doubtful", core::Severity::kWarning, "", sentence, object.confidence,
                        "--objects states its box and category"});
  }
  return findings;
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
  const TwinPhoto photo = ReadTwinPhoto(request.photo);
  TwinDetections detected = DetectObjects(request, photo, progress);
  TwinOutcome outcome;
  if (detected.found.objects.empty() ||
      (request.objects.empty() && detected.found.object_share < kLeastShare)) {
    throw core::Error("no object on a table is found in the photo", request.photo.string(),
                      "take it from above so that the whole table top shows, in even light, or "
                      "give boxes with --objects");
  }
  LimitDetections(request.most_objects, &detected, &outcome.findings);
  StateCamera(request.camera, photo, &detected.found.camera, &outcome.findings);
  const library_fit::LibraryPrior prior(LibraryWeights(ModelsFolder()));
  twin::TableReconstructionOptions options;
  options.kinds = detected.kinds;
  options.seed = request.seed;
  const twin::TableReconstruction table =
      twin::ReconstructTable(photo.rgb, detected.found, prior, options, progress);
  const core::Findings doubtful = KindFindings(table);
  outcome.findings.insert(outcome.findings.end(), doubtful.begin(), doubtful.end());
  progress->Stage("assets", static_cast<std::int64_t>(table.objects.size()));
  outcome.record.photo = request.photo.filename().string();
  outcome.record.camera = table.camera.At(photo.rgb.width, photo.rgb.height);
  outcome.record.log_scale_error = table.log_scale_error;
  const fs::path assets = staged.staging() / "assets";
  outcome.record.objects = WriteTwinAssets(table, photo.rgb, detected.found, request.seed, assets,
                                           progress, &outcome.findings);
  if (outcome.record.objects.empty()) {
    throw core::Error("no asset could be made of the photo's objects", request.photo.string());
  }
  progress->Stage("physics");
  SettleTwin(assets, &outcome.record, &outcome.findings);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  WriteTwinFiles(outcome, photo.rgb, staged.staging());
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
