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

  // What makes weights like the shipped ones.
  PriorTrainingRequest();
};

// Where Debian's sweethome3d-furniture keeps its CC0 part: what the shipped weights learned from.
std::filesystem::path DefaultTrainingCatalogue();

// The two files of weights in a folder.
std::filesystem::path ShapeWeights(const std::filesystem::path& folder);
std::filesystem::path ViewWeights(const std::filesystem::path& folder);

struct TrainedPrior {
  std::string name;                        // "shape" or "view"
  std::filesystem::path weights;           // in the request's folder
  asset_lift::PriorTrainingReport report;  // of the last steps
};

// Hears of every prior's means now and then.
using TrainedPriorListener = std::function<void(const TrainedPrior&)>;

// Trains the learned priors and writes their weights into the folder. Throws core::Error,
// core::Cancelled.
std::vector<TrainedPrior> TrainPriors(const PriorTrainingRequest& request, core::Progress* progress,
                                      const TrainedPriorListener& listener = {});

}  // namespace simwright::pipeline
