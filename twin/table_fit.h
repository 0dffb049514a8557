#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/random.h"
#include "library_fit/fit_loss.h"
#include "library_fit/library_prior.h"
#include "twin/observed_object.h"
#include "twin/table_pose.h"

namespace simwright::twin {

struct TableFitOptions {
  int most_kinds = 5;               // fitted: the most probable ones
  double least_probability = 0.02;  // of a kind that is fitted; the most probable always is
  int proposals = 24;               // compared per kind before the search
  int starts = 2;                   // proposals from which the search starts
  int generations = 18;             // of each of its passes
  // The mean absolute error of the logarithm of the camera's height: as uncertain are all sizes.
  double log_scale_error = 0.0;
  std::vector<int> kinds;  // the only kinds considered; empty: TableKinds()
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

// An object of the library on the table.
struct TableFit {
  library_fit::Instance instance;
  TablePose pose;
  library_fit::FitAgreement agreement;
  double probability = 0.0;  // of the kind, by the library prior
  double shape_loss = 1e9;   // of the agreement and the improbability of all but the sizes
  // The logarithms of the instance's sizes minus those that the prior expects of its kind, and the
  // expected errors.
  Eigen::Vector3d size_off{0, 0, 0}, size_error{1, 1, 1};

  // Returns the loss if all lengths are larger by exp(log_scale): the smaller the better.
  double Score(double log_scale) const;
};

// Fits objects of the library that stand on the table, z = 0, to what the photo shows; the best
// fit of each kind, the best kind first. `camera`: of the photo. Throws core::Error for invalid
// options.
std::vector<TableFit> FitOnTable(const library_fit::LibraryPrior& prior,
                                 const ObservedObject& object, const core::Camera& camera,
                                 const TableFitOptions& options);

// Returns the fit with the pose and the size that give it the same bounding box in the pictures of
// `after` as it has in those of `before`.
TableFit MovedToCamera(const TableFit& fit, const core::Camera& before, const core::Camera& after);

// Compares a fit with the photo again, after its pose, its size or the camera changed.
void CompareOnTable(const ObservedObject& object, const core::Camera& camera, TableFit* fit);

// Refines a fit from where it is: pose, sizes and continuous choices.
void RefineOnTable(const library_fit::LibraryPrior& prior, const ObservedObject& object,
                   const core::Camera& camera, const TableFitOptions& options, TableFit* fit);

}  // namespace simwright::twin
