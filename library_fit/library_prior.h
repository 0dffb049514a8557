#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/image.h"
#include "core/random.h"
#include "library_fit/fit_kinds.h"
#include "library_fit/fit_view.h"

namespace simwright::library_fit {

// The network's prediction for a kind: distributions over the view and the instance's parameters.
struct KindPrediction {
  int kind = 0;
  double probability = 0.0;
  std::vector<double> azimuth;               // probabilities of equal bins of the circle, from 0
  std::vector<std::vector<double>> choices;  // per choice, probabilities of equal bins of [0, 1)
  std::vector<double> opening;               // the same for the opening
  // Mean and mean absolute error of the logarithms of the size (m), of the elevation (rad), and of
  // the nearness.
  std::array<double, 5> numbers{}, errors{};
};

// Returns the most probable instance and view.
std::pair<Instance, FitView> LikeliestInstance(const KindPrediction& prediction);
// Samples an instance and a view.
std::pair<Instance, FitView> SampledInstance(const KindPrediction& prediction, core::Rng* rng);

// The learned prior over the library's objects: one small network, a few milliseconds per crop.
class LibraryPrior {
 public:
  // Throws core::Error where the weights are missing, damaged, or of another list of kinds.
  explicit LibraryPrior(const std::filesystem::path& weights);
  ~LibraryPrior();
  LibraryPrior(const LibraryPrior&) = delete;
  LibraryPrior& operator=(const LibraryPrior&) = delete;

  // Returns the probability of each kind for a crop: RGBA, kPriorSide pixels per side, with the
  // margin kPriorMargin around the object.
  std::vector<double> KindProbabilities(const core::Image& crop) const;
  // Returns the predictions for the crop if it shows each of `kinds`, with the probabilities of
  // KindProbabilities.
  std::vector<KindPrediction> Predict(const core::Image& crop, const std::vector<int>& kinds) const;

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

}  // namespace simwright::library_fit
