#include "scene/metrics/frechet.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

#include "core/error.h"

namespace simwright::scene {
namespace {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

Eigen::MatrixXd SymmetricRoot(const Eigen::MatrixXd& matrix) {
  const Solver solver(matrix);
  const Eigen::VectorXd roots = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return solver.eigenvectors() * roots.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

Gaussian GaussianOf(const FeatureMatrix& features) {
  if (features.rows() < 2)
    throw core::Error("a covariance needs the features of at least 2 images");
  if (!features.allFinite()) throw core::Error("the features of an image are not finite");
  const Eigen::MatrixXd rows = features.cast<double>();
  Gaussian gaussian;
  gaussian.mean = rows.colwise().mean();
  const Eigen::MatrixXd centred = rows.rowwise() - gaussian.mean.transpose();
  gaussian.covariance = centred.transpose() * centred / static_cast<double>(rows.rows() - 1);
  return gaussian;
}

double FrechetDistance(const Gaussian& a, const Gaussian& b) {
  const auto size = a.mean.size();
  const auto fits = [&](const Eigen::MatrixXd& s) { return s.rows() == size && s.cols() == size; };
  if (b.mean.size() != size || !fits(a.covariance) || !fits(b.covariance)) {
    throw core::Error("the Frechet distance needs Gaussians of one size");
  }
  const Eigen::MatrixXd root = SymmetricRoot(a.covariance);
  Eigen::MatrixXd product = root * b.covariance * root;
  product = 0.5 * (product + product.transpose()).eval();
  const Solver solver(product, Eigen::EigenvaluesOnly);
  const double trace_of_root = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().sum();
  const double spread = a.covariance.trace() + b.covariance.trace() - 2.0 * trace_of_root;
  return std::max(0.0, (a.mean - b.mean).squaredNorm() + spread);
}

}  // namespace simwright::scene
