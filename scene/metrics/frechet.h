#pragma once

#include <Eigen/Core>

#include "scene/metrics/feature_matrix.h"

namespace simwright::scene {

struct Gaussian {
  Eigen::VectorXd mean;        // (D)
  Eigen::MatrixXd covariance;  // (D x D), symmetric, positive semi-definite
};

// Mean and unbiased covariance of features (N x D). Throws core::Error for fewer than 2 rows, or
// features that are not finite.
Gaussian GaussianOf(const FeatureMatrix& features);

// The Frechet distance of two Gaussians, squared as it is reported (Dowson and Landau 1982; Heusel
// et al. 2017): |m - n|^2 + tr(S + T - 2 (S^1/2 T S^1/2)^1/2), roots by eigen-decomposition, what
// rounding makes negative taken as 0. >= 0. Throws core::Error where their sizes differ.
double FrechetDistance(const Gaussian& a, const Gaussian& b);

}  // namespace simwright::scene
