#pragma once

#include <vector>

#include <Eigen/Core>

#include "rl/activation.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// The forward pass of a multi-layer perceptron with activations between its layers and none after
// the last. Runs on the calling thread alone: a few rows are done before a second thread wakes.
class Mlp {
 public:
  struct Layer {
    Eigen::MatrixXf weights;  // (inputs x outputs)
    Eigen::RowVectorXf bias;  // (outputs)
  };

  Mlp() = default;
  // Throws core::Error if the layer sizes do not match.
  Mlp(std::vector<Layer> layers, Activation activation);

  // Maps (n x inputs) to (n x outputs). Thread-safe.
  void Forward(const Rows& inputs, Rows* outputs) const;

  int input_size() const;
  int output_size() const;
  const std::vector<Layer>& layers() const { return layers_; }
  Activation activation() const { return activation_; }

 private:
  std::vector<Layer> layers_;
  Activation activation_ = Activation::kElu;
};

}  // namespace simwright::rl
