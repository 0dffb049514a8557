#pragma once

#include "nn/torch.h"
#include "scene/model/asset_shapes.h"

namespace simwright::scene {

// Classes known by their shape, in place of a table of each: a network on every surface point and
// the largest of each feature over the points (Qi et al. 2017, PointNet) give a thing's features,
// and linear maps of these what enters a denoiser and what its logits are products with. The empty
// class and the mask have vectors of their own. Nothing is learned of a class by its number, so
// that one more needs no training: where its surface is like another's, it is drawn as that is. K
// classes: things, the empty one last; the mask is not among them.
class ClassShapesImpl : public torch::nn::Module {
 public:
  // `classes`: K; `points`: of a surface, P; `entry`: the width that enters; `exit`: of the
  // features that logits are of. Surfaces are points at the origin until they are set.
  ClassShapesImpl(int classes, int points, std::int64_t entry, std::int64_t exit);

  // Throws core::Error for another number of classes or points.
  void Set(const AssetShapes& shapes);
  AssetShapes Shapes() const;  // in single precision

  // (K + 1 x entry): the classes, then the mask.
  torch::Tensor Entries();
  // (... x exit) -> (... x K).
  torch::Tensor Logits(const torch::Tensor& features);

 private:
  torch::Tensor Features();  // (K - 1 x kFeatures)

  std::int64_t exit_;
  torch::Tensor surfaces_;  // (K - 1 x P x 3) m, a buffer
  torch::nn::Sequential point_{nullptr}, whole_{nullptr};
  torch::nn::Linear entry_map_{nullptr}, key_map_{nullptr}, bias_map_{nullptr};
  torch::Tensor own_entries_;             // (2 x entry): empty, mask
  torch::Tensor empty_key_, empty_bias_;  // (exit), (1)
};
TORCH_MODULE(ClassShapes);

}  // namespace simwright::scene
