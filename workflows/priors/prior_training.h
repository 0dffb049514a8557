#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "asset_lift/priors/prior_training.h"
#include "core/progress.h"
#include "library_fit/library_training.h"
#include "twin/detector_training.h"

namespace simwright::workflows {

struct PriorTrainingRequest {
  // The furniture catalogues (.sh3f) with the training pieces; missing ones are an error.
  std::vector<std::filesystem::path> catalogues;
  std::filesystem::path output;  // the weights' folder
  bool shape = true;             // trains the shape prior
  bool view = true;              // trains the view prior, which uses the shape prior in the folder
  bool library = true;   // trains the prior of the library's kinds, on the library and `photos`
  bool detector = true;  // trains the detector of objects on tables, on the library, the small
                         // pieces of the catalogues and `photos`
  // Photos of tables, walls and rooms, or folders of them, that stand behind and below the objects;
  // empty: only patterns.
  std::vector<std::filesystem::path> photos;
  // Their samplers are set by TrainPriors to instances of the library, unless the shares are 0.
  asset_lift::PriorTrainingOptions shape_options, view_options;
  library_fit::LibraryTrainingOptions library_options;
  twin::DetectorTrainingOptions detector_options;

  // Sets the steps and rates of trainings that take hours on two cores. models/README.md has the
  // commands of the shipped weights.
  PriorTrainingRequest();
};

// Returns the path of the CC0 catalogue of Debian's sweethome3d-furniture, the training data of the
// shipped weights.
std::filesystem::path DefaultTrainingCatalogue();

// Returns the path of each prior's weights in a folder.
std::filesystem::path ShapeWeights(const std::filesystem::path& folder);
std::filesystem::path ViewWeights(const std::filesystem::path& folder);
std::filesystem::path LibraryWeights(const std::filesystem::path& folder);
std::filesystem::path DetectorWeights(const std::filesystem::path& folder);

struct TrainedPrior {
  std::string name;                        // "shape", "view", "library" or "detector"
  std::filesystem::path weights;           // a file in the request's folder
  asset_lift::PriorTrainingReport report;  // the report on the last steps
};

// A listener that is called with each prior's report from time to time.
using TrainedPriorListener = std::function<void(const TrainedPrior&)>;

// Trains the learned priors and writes their weights into the folder. Throws core::Error and
// core::Cancelled.
std::vector<TrainedPrior> TrainPriors(const PriorTrainingRequest& request, core::Progress* progress,
                                      const TrainedPriorListener& listener = {});

}  // namespace simwright::workflows
