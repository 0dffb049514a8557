#include "rl/mlp.h"

#include "core/error.h"

namespace simwright::rl {
namespace {

void Activate(Activation activation, Rows* rows) {
  if (activation == Activation::kTanh) {
    *rows = rows->array().tanh();
  } else {
    // ELU without branches: e^min(x, 0) - 1 is 0 for positive x, max(x, 0) is 0 otherwise.
    *rows = rows->array().max(0.0f) + (rows->array().min(0.0f).exp() - 1.0f);
  }
}

}  // namespace

Mlp::Mlp(std::vector<Layer> layers, Activation activation)
    : layers_(std::move(layers)), activation_(activation) {
  if (layers_.empty()) throw core::Error("a network needs at least one layer", "network");
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    if (layers_[i].weights.cols() != layers_[i].bias.size() ||
        (i > 0 && layers_[i - 1].weights.cols() != layers_[i].weights.rows())) {
      throw core::Error("its size does not match the previous layer", "layer " + std::to_string(i));
    }
  }
}

void Mlp::Forward(const Rows& inputs, Rows* outputs) const {
  Rows rows, next;
  const Rows* from = &inputs;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    next.noalias() = *from * layers_[i].weights;
    next.rowwise() += layers_[i].bias;
    if (i + 1 < layers_.size()) Activate(activation_, &next);
    rows.swap(next);
    from = &rows;
  }
  outputs->swap(rows);
}

int Mlp::input_size() const {
  return layers_.empty() ? 0 : static_cast<int>(layers_.front().weights.rows());
}

int Mlp::output_size() const {
  return layers_.empty() ? 0 : static_cast<int>(layers_.back().weights.cols());
}

}  // namespace simwright::rl
