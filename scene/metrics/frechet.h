#pragma once

#include <Eigen/Core>

#include "scene/metrics/feature_matrix.h"

namespace simwright::scene {

struct Gaussian {
  Eigen::VectorXd mean;        // (D)
  Eigen::MatrixXd covariance;  // (D x D), symmetric, positive semi-definite
};

// Returns the mean and unbiased covariance of features (N x D). Throws core::Error for fewer than 2
// rows, or features that are not finite.
Gaussian GaussianOf(const FeatureMatrix& features);

// Returns the Frechet distance of two Gaussians, squared as usually reported (Dowson and Landau
// 1982; Heusel et al. 2017): |m - n|^2 + tr(S + T - 2 (S^1/2 T S^1/2)^1/2), with matrix roots by
// eigendecomposition and negative rounding errors clamped to 0. >= 0. Throws core::Error if their
// sizes differ.
double FrechetDistance(const Gaussian& a, const Gaussian& b);

}  // namespace simwright::scene
