#pragma once

#include "nn/torch.h"
#include "scene/model/text_encoder.h"

namespace simwright::scene {

// An embedding of the numbers of objects of each class in noisy scenes of a mixed diffusion, and of
// those that the prompt asks for. Attention averages over tokens: the difference between four and
// five apples among sixty entries is a sixtieth of its result, which is learned late. An MLP on the
// sums has them from the start.
class ClassCountsImpl : public torch::nn::Module {
 public:
  // `classes`: K, without the mask. `text`: true if there are prompts.
  ClassCountsImpl(std::int64_t width, int classes, bool text);

  // classes (B x N) int64, 0 .. K; `text` may be undefined. Returns (B x width), for the
  // conditioning vector of the blocks.
  torch::Tensor forward(const torch::Tensor& classes, const EncodedText& text);

 private:
  std::int64_t classes_;
  torch::nn::Linear from_counts_{nullptr}, from_text_{nullptr}, out_{nullptr};
};
TORCH_MODULE(ClassCounts);

}  // namespace simwright::scene
