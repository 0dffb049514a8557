#include "scene/model/class_counts.h"

namespace simwright::scene {
namespace {

constexpr double kCountUnit = 8.0;  // objects; divides counts
constexpr double kPieceUnit = 8.0;  // word pieces; divides the sum over a prompt

}  // namespace

ClassCountsImpl::ClassCountsImpl(std::int64_t width, int classes, bool text) : classes_(classes) {
  // Counts as such, whose differences to the wanted ones are linear, and their logarithms, whose
  // differences give the logits of the classes that are missing.
  from_counts_ = register_module("from_counts", torch::nn::Linear(2 * (classes + 1), 2 * width));
  if (text) from_text_ = register_module("from_text", torch::nn::Linear(width, 2 * width));
  out_ = register_module("out", torch::nn::Linear(2 * width, width));
}

torch::Tensor ClassCountsImpl::forward(const torch::Tensor& classes, const EncodedText& text) {
  const torch::Tensor counts =
      torch::one_hot(classes, classes_ + 1).sum(1).to(from_counts_->weight.dtype());
  torch::Tensor hidden = from_counts_(torch::cat({counts / kCountUnit, torch::log1p(counts)}, -1));
  if (text.IsDefined()) {
    const torch::Tensor pieces = text.features * text.mask.unsqueeze(-1);
    hidden = hidden + from_text_(pieces.sum(1) / kPieceUnit);
  }
  return out_(torch::silu(hidden));
}

}  // namespace simwright::scene
