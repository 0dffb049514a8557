#include "asset_lift/mesh_fit/large_steps.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"

namespace simwright::asset_lift {
namespace {

Eigen::SparseMatrix<double> SystemMatrix(const core::TriangleMesh& mesh, double lambda) {
  std::set<std::pair<int, int>> edges;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  }
  std::vector<double> diagonal(mesh.vertices.size(), 1.0);
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [a, b] : edges) {
    if (a == b) continue;
    entries.emplace_back(a, b, -lambda);
    entries.emplace_back(b, a, -lambda);
    diagonal[a] += lambda;
    diagonal[b] += lambda;
  }
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i), diagonal[i]);
  }
  const auto n = static_cast<Eigen::Index>(mesh.vertices.size());
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

struct LargeSteps::Factor {
  Eigen::SparseMatrix<double> matrix;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky;
};

LargeSteps::LargeSteps(const core::TriangleMesh& mesh, double lambda)
    : factor_(std::make_unique<Factor>()) {
  core::RequireValid(mesh, "large steps");
  if (!(lambda >= 0.0) || !std::isfinite(lambda)) {
    throw core::Error("the smoothing must be finite and not negative", "large steps");
  }
  factor_->matrix = SystemMatrix(mesh, lambda);
  factor_->cholesky.compute(factor_->matrix);
  if (factor_->cholesky.info() != Eigen::Success) {
    throw core::Error("the smoothing system cannot be factored", "large steps");
  }
}

LargeSteps::~LargeSteps() = default;

Eigen::MatrixX3d LargeSteps::Apply(const Eigen::MatrixX3d& v) const {
  return factor_->matrix * v;
}

Eigen::MatrixX3d LargeSteps::Solve(const Eigen::MatrixX3d& u) const {
  return factor_->cholesky.solve(u);
}

Eigen::MatrixX3d AdamUniform::Step(const Eigen::MatrixX3d& gradient, double rate) {
  constexpr double kBeta1 = 0.9, kBeta2 = 0.999;
  decayed_mean_ *= kBeta1;
  decayed_square_ *= kBeta2;
  mean_ = kBeta1 * mean_ + (1.0 - kBeta1) * gradient;
  const double largest = gradient.size() == 0 ? 0.0 : gradient.array().square().maxCoeff();
  square_ = kBeta2 * square_ + (1.0 - kBeta2) * largest;
  const double scale = std::sqrt(square_ / (1.0 - decayed_square_));
  if (!(scale > 0.0)) return Eigen::MatrixX3d::Zero(gradient.rows(), 3);
  return -rate / ((1.0 - decayed_mean_) * scale) * mean_;
}

}  // namespace simwright::asset_lift
