#include "twin/table_reconstruction.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "library_fit/fit_kinds.h"
#include "twin/camera_guess.h"
#include "twin/camera_search.h"
#include "twin/joint_refinement.h"
#include "twin/observed_object.h"
#include "twin/pose_uncertainty.h"

namespace simwright::twin {
namespace {

constexpr int kFirstKinds = 3;            // fitted with the guessed camera
constexpr int kLinesOfSearch = 3;         // of a pass of the camera search
constexpr double kWorstAgreement = 0.35;  // IoU at which an object's confidence is 0
constexpr double kJointRoll = 0.005;      // rad, of a roll that is known after the search

std::vector<int> KindsFor(const TableReconstructionOptions& options, size_t k) {
  return k < options.kinds.size() ? options.kinds[k] : std::vector<int>();
}

// Returns the fits of every object with a camera, the best kind first.
std::vector<std::vector<TableFit>> FitAll(const library_fit::LibraryPrior& prior,
                                          const std::vector<ObservedObject>& objects,
                                          const core::Camera& camera,
                                          const TableReconstructionOptions& options,
                                          const TableFitOptions& fit_options,
                                          core::Progress* progress) {
  std::vector<std::vector<TableFit>> all(objects.size());
  core::ParallelFor(static_cast<int>(objects.size()), [&](int k) {
    TableFitOptions of = fit_options;
    of.kinds = KindsFor(options, static_cast<size_t>(k));
    of.seed = options.seed + static_cast<std::uint64_t>(k);
    all[static_cast<size_t>(k)] = FitOnTable(prior, objects[static_cast<size_t>(k)], camera, of);
    progress->Advance();
  });
  return all;
}

// Searches for the camera from the guess, with fits of the few likeliest kinds.
void SearchFirstCamera(const core::Image& photo, const std::vector<ObservedObject>& observed,
                       const library_fit::LibraryPrior& prior,
                       const TableReconstructionOptions& options, const TableFitOptions& fit,
                       core::Progress* progress, TableCameraGuess* guess) {
  const int width = photo.width, height = photo.height;
  progress->Stage("camera", static_cast<std::int64_t>(observed.size()) +
                                kLinesOfSearch * options.camera_passes);
  TableFitOptions first = fit;
  first.most_kinds = std::min(first.most_kinds, kFirstKinds);
  first.starts = 1;
  std::vector<TableFit> fits;
  for (std::vector<TableFit>& alternatives :
       FitAll(prior, observed, guess->camera.At(width, height), options, first, progress)) {
    fits.push_back(std::move(alternatives.front()));
  }
  guess->camera = SearchCamera(prior, observed, width, height, *guess, std::move(fits),
                               options.camera_passes, fit, progress)
                      .camera;
  // The search has used what was guessed; what remains is its own error.
  guess->elevation_error = std::min(guess->elevation_error, 0.01);
  guess->log_focal_error = std::min(guess->log_focal_error, 0.02);
  guess->roll_error = std::min(guess->roll_error, kJointRoll);
}

// Scales all lengths of a reconstruction.
void ScaleLengths(double factor, TableFit* fit) {
  fit->instance.size *= factor;
  fit->pose.x *= factor;
  fit->pose.y *= factor;
  fit->size_off.array() += std::log(factor);
}

// Moves the objects together until the outlines agree; keeps each object's shape.
void RefineTogether(const Detections& detections, const TableCameraGuess& guess,
                    TableReconstruction* table) {
  std::vector<RefinedObject> objects;
  for (const ReconstructedObject& object : table->objects) {
    RefinedObject refined;
    refined.mesh = library_fit::InstanceMesh(object.fit.instance).mesh;
    refined.pose = {object.fit.pose, 1.0};
    refined.log_size_wanted = -object.fit.size_off.mean();
    refined.log_size_error = object.fit.size_error.mean();
    objects.push_back(std::move(refined));
  }
  const JointRefinement joint = RefineJointly(objects, detections.objects, guess, {});
  table->outline_error = std::min(joint.first_error, joint.last_error);
  if (joint.last_error >= joint.first_error) return;
  table->camera = joint.camera;
  for (size_t k = 0; k < objects.size(); ++k) {
    TableFit& fit = table->objects[k].fit;
    fit.pose = joint.poses[k].pose;
    fit.instance.size *= joint.poses[k].scale;
  }
}

}  // namespace

bool TableReconstructionOptions::IsValid(std::string* error) const {
  const auto fail = [error](const char* reason) {
    if (error) *error = reason;
    return false;
  };
  if (!fit.IsValid(error)) return false;
  if (side < 16 || side > 1024) return fail("the crops must be 16 to 1024 pixels a side");
  if (camera_passes < 0) return fail("the number of passes is negative");
  return true;
}

TableReconstruction ReconstructTable(const core::Image& photo, const Detections& detections,
                                     const library_fit::LibraryPrior& prior,
                                     const TableReconstructionOptions& options,
                                     core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "table reconstruction");
  if (detections.objects.empty()) throw core::Error("no object is detected on a table");
  const int width = photo.width, height = photo.height;
  TableCameraGuess guess = detections.camera;
  const std::vector<ObservedObject> observed =
      ObserveObjects(photo, detections.objects, options.side);
  const auto count = static_cast<std::int64_t>(observed.size());
  guess = GuessByObjects(observed, options.kinds, prior, width, height, guess);
  const bool search =
      guess.elevation_error > 0.0 || guess.log_focal_error > 0.0 || guess.roll_error > 0.0;
  TableFitOptions fit = options.fit;
  fit.log_scale_error = guess.log_height_error;
  if (search) SearchFirstCamera(photo, observed, prior, options, fit, progress, &guess);
  progress->Stage("objects", count);
  const std::vector<std::vector<TableFit>> alternatives =
      FitAll(prior, observed, guess.camera.At(width, height), options, fit, progress);
  const ScaleChoice scale = ChooseScale(alternatives, guess.log_height_error);
  TableReconstruction table;
  const double factor = std::exp(scale.log_scale);
  guess.camera.height *= factor;
  table.camera = guess.camera;
  table.log_scale_error = scale.error;
  for (size_t k = 0; k < alternatives.size(); ++k) {
    ReconstructedObject object;
    object.detection = static_cast<int>(k);
    object.fit = alternatives[k][static_cast<size_t>(scale.choice[k])];
    ScaleLengths(factor, &object.fit);
    object.hidden = observed[k].hidden;
    table.objects.push_back(std::move(object));
  }
  RefineTogether(detections, guess, &table);
  const core::Camera camera = table.camera.At(width, height);
  for (size_t k = 0; k < table.objects.size(); ++k) {
    ReconstructedObject& object = table.objects[k];
    CompareOnTable(observed[k], camera, &object.fit);
    const double agreement = std::clamp(
        (object.fit.agreement.iou - kWorstAgreement) / (1.0 - kWorstAgreement), 0.0, 1.0);
    object.confidence =
        detections.objects[k].confidence * agreement * std::sqrt(object.fit.probability);
    const PoseUncertainty uncertainty =
        UncertaintyOf(object.fit, observed[k].box, camera, object.hidden, table.log_scale_error);
    object.position_error = uncertainty.position;
    object.yaw_error = uncertainty.yaw;
    object.size_error = uncertainty.size;
  }
  return table;
}

}  // namespace simwright::twin
