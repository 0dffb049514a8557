#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/metrics/feature_matrix.h"

namespace simwright::scene {

struct AccuracyOptions {
  int runs = 10;
  std::vector<int> scored = {50, 100};  // passes over the training half, ascending
  // As published. Adam moves a weight by no more than this a step: of few features, which have to
  // be weighed against each other, a classifier is only learned at a higher one.
  double learning_rate = 1e-4;
  int batch = 256;
  // Each feature by the mean and deviation of the training half: for features that are of unlike
  // size. Off as published, for a network of ImageNet.
  bool standardise = true;
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

struct AccuracyScore {
  int passes = 0;
  double percent = 0.0;    // mean over runs, those below 50 reflected
  double deviation = 0.0;  // of the runs
};

// How well a linear classifier tells generated from data (CA): features (N x D) and (M x D), of
// each min(N, M) drawn, halved at random, logistic regression by Adam from weights of zero on one
// half, scored on the other; one score for each of `scored`. 50: it cannot tell. After Paschalidou
// et al. 2021, whose classifier goes on passes over AlexNet's features. Throws core::Error for
// options that are not valid, fewer than 4 rows, different D, or features that are not finite.
std::vector<AccuracyScore> ClassifierAccuracy(const FeatureMatrix& data,
                                              const FeatureMatrix& generated,
                                              const AccuracyOptions& options = {});

}  // namespace simwright::scene
