#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/metrics/feature_matrix.h"

namespace simwright::scene {

struct AccuracyOptions {
  int runs = 10;
  std::vector<int> scored_epochs = {50, 100};  // epochs over the training half, ascending
  // The published value. Adam moves a weight by no more than this per step; a few features that
  // must be weighed against each other need a higher one.
  double learning_rate = 1e-4;
  int batch = 256;
  // Standardizes each feature by the mean and deviation of the training half: for features of
  // different scales. Off as published, for an ImageNet network.
  bool standardise = true;
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

struct AccuracyScore {
  int passes = 0;
  double percent = 0.0;    // mean over runs, those below 50 reflected
  double deviation = 0.0;  // of the runs
};

// Returns the accuracy of a linear classifier that separates generated scenes from data (CA), one
// score for each of `scored_epochs`: from features (N x D) and (M x D), min(N, M) of each are
// sampled and split at random into halves; logistic regression is trained by Adam from zero weights
// on one half and scored on the other. 50: indistinguishable. After Paschalidou et al. 2021, whose
// classifier trains on features of AlexNet. Throws core::Error for invalid options, fewer than 4
// rows, different D, or features that are not finite.
std::vector<AccuracyScore> ClassifierAccuracy(const FeatureMatrix& data,
                                              const FeatureMatrix& generated,
                                              const AccuracyOptions& options = {});

}  // namespace simwright::scene
