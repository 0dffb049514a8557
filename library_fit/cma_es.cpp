#include "library_fit/cma_es.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Eigenvalues>

#include "core/error.h"
#include "core/parallel.h"

namespace simwright::library_fit {
namespace {

// The constants of the tutorial's table 1, with positive weights only.
struct Strategy {
  Strategy(int n, int population) {
    const int parents = population / 2;
    weights.resize(parents);
    for (int i = 0; i < parents; ++i) weights[i] = std::log(parents + 0.5) - std::log(i + 1.0);
    weights /= weights.sum();
    mass = 1.0 / weights.squaredNorm();
    sigma_rate = (mass + 2.0) / (n + mass + 5.0);
    sigma_damping =
        1.0 + 2.0 * std::max(0.0, std::sqrt((mass - 1.0) / (n + 1.0)) - 1.0) + sigma_rate;
    path_rate = (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n);
    rank_one = 2.0 / ((n + 1.3) * (n + 1.3) + mass);
    rank_mu =
        std::min(1.0 - rank_one, 2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0) * (n + 2.0) + mass));
    expected_norm = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
  }
  Eigen::VectorXd weights;
  double mass, sigma_rate, sigma_damping, path_rate, rank_one, rank_mu, expected_norm;
};

struct Candidate {
  Eigen::VectorXd z, y, x;  // standard normal, scaled by the covariance, and in the search space
  double loss = 0.0;
};

}  // namespace

CmaEsResult MinimizeByCmaEs(const std::function<double(const Eigen::VectorXd&)>& loss,
                            const Eigen::VectorXd& start, const CmaEsOptions& options,
                            core::Rng* rng) {
  const int n = static_cast<int>(start.size());
  if (n < 1 || options.population < 4) {
    throw core::Error("a search needs a dimension and a population of four or more");
  }
  const Strategy s(n, options.population);
  Eigen::VectorXd mean = start, sigma_path = Eigen::VectorXd::Zero(n), path = sigma_path;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n);
  double sigma = options.step;
  CmaEsResult result{start, loss(start), 1};
  std::vector<Candidate> candidates(static_cast<size_t>(options.population));
  for (int generation = 0; generation < options.generations; ++generation) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
    const Eigen::VectorXd lengths = axes.eigenvalues().cwiseMax(1e-12).cwiseSqrt();
    if (sigma * lengths.maxCoeff() < options.least_step) break;
    for (Candidate& c : candidates) {
      c.z.resize(n);
      for (int i = 0; i < n; ++i) c.z[i] = core::Normal(*rng);
      c.y = axes.eigenvectors() * lengths.cwiseProduct(c.z);
      c.x = mean + sigma * c.y;
    }
    core::ParallelFor(options.population, [&](int i) {
      Candidate& c = candidates[static_cast<size_t>(i)];
      c.loss = loss(c.x);
    });
    result.evaluations += options.population;
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.loss < b.loss; });
    if (candidates.front().loss < result.loss) {
      result.loss = candidates.front().loss;
      result.best = candidates.front().x;
    }
    Eigen::VectorXd y = Eigen::VectorXd::Zero(n), z = y;
    for (int i = 0; i < s.weights.size(); ++i) {
      y += s.weights[i] * candidates[static_cast<size_t>(i)].y;
      z += s.weights[i] * candidates[static_cast<size_t>(i)].z;
    }
    mean += sigma * y;
    sigma_path = (1.0 - s.sigma_rate) * sigma_path +
                 std::sqrt(s.sigma_rate * (2.0 - s.sigma_rate) * s.mass) * axes.eigenvectors() * z;
    const double decay = 1.0 - std::pow(1.0 - s.sigma_rate, 2.0 * (generation + 1));
    const bool moves =
        sigma_path.norm() / std::sqrt(decay) < (1.4 + 2.0 / (n + 1.0)) * s.expected_norm;
    path = (1.0 - s.path_rate) * path;
    if (moves) path += std::sqrt(s.path_rate * (2.0 - s.path_rate) * s.mass) * y;
    const double kept = moves ? 0.0 : s.rank_one * s.path_rate * (2.0 - s.path_rate);
    covariance =
        (1.0 - s.rank_one - s.rank_mu + kept) * covariance + s.rank_one * path * path.transpose();
    for (int i = 0; i < s.weights.size(); ++i) {
      const Eigen::VectorXd& step = candidates[static_cast<size_t>(i)].y;
      covariance += s.rank_mu * s.weights[i] * step * step.transpose();
    }
    sigma *= std::exp(s.sigma_rate / s.sigma_damping * (sigma_path.norm() / s.expected_norm - 1.0));
  }
  return result;
}

}  // namespace simwright::library_fit
