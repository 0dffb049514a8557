#pragma once

#include "nn/torch.h"
#include "scene/model/asset_shapes.h"

namespace simwright::scene {

// An embedding of classes by shape, in place of a table of classes: a network on every surface
// point and a max-pool over the points (Qi et al. 2017, PointNet) give the features of an asset,
// and linear maps of these give its input embedding and the key that its logits are products with.
// The empty class and the mask have vectors of their own. No parameter belongs to a class index, so
// that a new class needs no training: a class whose surface resembles another's is sampled like
// that one. K classes: assets, then the empty one; the mask is not among them.
class ClassShapesImpl : public torch::nn::Module {
 public:
  // `classes`: K; `points`: points per surface, P; `entry`: width of the input embedding; `exit`:
  // width of the features that the logits are computed from. All surface points are at the origin
  // until Set.
  ClassShapesImpl(int classes, int points, std::int64_t entry, std::int64_t exit);

  // Sets the surfaces. Throws core::Error for another number of classes or points.
  void Set(const AssetShapes& shapes);
  AssetShapes Shapes() const;  // in single precision

  // Returns the input embeddings (K + 1 x entry): the classes, then the mask.
  torch::Tensor InputEmbeddings();
  // Returns the logits (... x K) of features (... x exit).
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
