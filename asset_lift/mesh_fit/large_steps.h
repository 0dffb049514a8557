#pragma once

#include <memory>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::asset_lift {

// The coordinates in which a mesh is fitted: u = (I + lambda L) v, with L the mesh's combinatorial
// Laplacian. A step du in u moves v by (I + lambda L)^-1 du: a smooth displacement with global
// support, so that noisy gradients at silhouettes move the surface without folds (Nicolet, Jacobson
// and Jakob 2021, "Large steps in inverse rendering of geometry", eq. 8). The matrix is factored
// once per topology.
class LargeSteps {
 public:
  // Throws core::Error for lambda < 0 or an invalid mesh.
  LargeSteps(const core::TriangleMesh& mesh, double lambda);
  ~LargeSteps();
  LargeSteps(const LargeSteps&) = delete;
  LargeSteps& operator=(const LargeSteps&) = delete;

  // Returns (I + lambda L) v. (N x 3)
  Eigen::MatrixX3d Apply(const Eigen::MatrixX3d& v) const;
  // Returns (I + lambda L)^-1 u. It maps u to v, and dL/dv to dL/du, since the matrix is symmetric.
  // (N x 3)
  Eigen::MatrixX3d Solve(const Eigen::MatrixX3d& u) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

// The Adam optimizer with one divisor for all coordinates, the largest second moment, so that steps
// keep the gradient's direction (the same paper, section 3.3).
class AdamUniform {
 public:
  explicit AdamUniform(Eigen::Index rows) : mean_(Eigen::MatrixX3d::Zero(rows, 3)) {}

  // Returns the increment of the parameters for a step of size `rate`.
  Eigen::MatrixX3d Step(const Eigen::MatrixX3d& gradient, double rate);

 private:
  Eigen::MatrixX3d mean_;
  double square_ = 0.0;
  double decayed_mean_ = 1.0, decayed_square_ = 1.0;  // beta^t
};

}  // namespace simwright::asset_lift
