#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/random.h"

namespace simwright::library_fit {

struct CmaEsOptions {
  int population = 14;
  int generations = 30;
  double step = 0.5;         // initial standard deviation in every dimension
  double least_step = 0.01;  // stops when the largest standard deviation falls below it
};

struct CmaEsResult {
  Eigen::VectorXd best;
  double loss = 0.0;
  int evaluations = 0;
};

// Minimizes `loss` from `start` by the covariance matrix adaptation evolution strategy, with
// rank-mu and rank-one updates and cumulative step-size adaptation (Hansen, "The CMA evolution
// strategy: a tutorial", 2016, arXiv:1604.00772). `loss` is called from several threads at once and
// must not depend on the order. The result does not depend on the number of threads. Throws
// core::Error for a start without dimensions or a population below 4.
CmaEsResult MinimizeByCmaEs(const std::function<double(const Eigen::VectorXd&)>& loss,
                            const Eigen::VectorXd& start, const CmaEsOptions& options,
                            core::Rng* rng);

}  // namespace simwright::library_fit
