#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "asset_lift/prior_training.h"
#include "core/progress.h"

namespace simwright::pipeline {

struct PriorTrainingRequest {
  // Furniture catalogues (.sh3f) whose pieces are learned from; missing ones are an error.
  std::vector<std::filesystem::path> catalogues;
  std::filesystem::path output;  // folder of the weights
  bool shape = true;             // which of the two to train
  bool view = true;              // builds upon the shape prior in the folder
  asset_lift::PriorTrainingOptions shape_options, view_options;

  // The shipped weights' settings.
  PriorTrainingRequest();
};

// Where Debian's sweethome3d-furniture keeps its CC0 part: what the shipped weights learned from.
std::filesystem::path DefaultTrainingCatalogue();

// Trains the learned priors and writes their weights into the folder: shape_prior.pt and
// view_prior.pt. `report`
// hears a line now and then. Throws core::Error, core::Cancelled.
void TrainPriors(const PriorTrainingRequest& request, core::Progress* progress,
                 const std::function<void(const std::string&)>& report);

}  // namespace simwright::pipeline
