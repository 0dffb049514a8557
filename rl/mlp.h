#pragma once

#include <vector>

#include <Eigen/Core>

#include "rl/activation.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// A multi-layer perceptron's forward pass, with the activation between its layers and none after
// the last. Runs on the calling thread alone: a few rows are done before a second thread wakes.
class Mlp {
 public:
  struct Layer {
    Eigen::MatrixXf weights;  // (inputs x outputs)
    Eigen::RowVectorXf bias;  // (outputs)
  };

  Mlp() = default;
  // Throws core::Error where the layers do not fit each other.
  Mlp(std::vector<Layer> layers, Activation activation);

  // (n x inputs) to (n x outputs). Safe from several threads.
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
