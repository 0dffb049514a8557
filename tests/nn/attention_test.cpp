// Attention and norms against their formulas in double precision, with gradients. The program may
// be built with a libtorch that has kernels for them or with one that has not
// (run_with_libtorch2.py).
#include <gtest/gtest.h>

#include <cmath>

#include "nn/blocks.h"
#include "nn/mixed_precision.h"
#include "nn/transformer.h"

namespace simwright::nn {
namespace {

// Returns softmax(q k^T / sqrt(d)) v in double precision, with minus infinity where the mask is
// false: (B x heads x N x d).
torch::Tensor AttentionFormula(const torch::Tensor& q, const torch::Tensor& k,
                               const torch::Tensor& v, const torch::Tensor& key_mask = {}) {
  torch::Tensor scores = torch::matmul(q, k.transpose(2, 3)) / std::sqrt(q.size(3));
  if (key_mask.defined()) {
    scores = scores + torch::where(key_mask, 0.0, -INFINITY)
                          .to(torch::kDouble)
                          .view({key_mask.size(0), 1, 1, key_mask.size(1)});
  }
  const torch::Tensor weights = torch::exp(scores - scores.amax(3, true));
  return torch::matmul(weights / weights.sum(3, true), v);
}

torch::Tensor RmsFormula(const torch::Tensor& x, const torch::Tensor& scale) {
  return x / torch::sqrt((x * x).mean(-1, true) + 1e-6) * scale;
}

torch::Tensor Leaf(at::IntArrayRef sizes) {
  return torch::randn(sizes).requires_grad_();
}

torch::Tensor DoubleLeaf(const torch::Tensor& x) {
  return x.detach().to(torch::kDouble).requires_grad_();
}

double LargestDifference(const torch::Tensor& a, const torch::Tensor& b) {
  return (a.to(torch::kDouble) - b.to(torch::kDouble)).abs().max().item<double>();
}

// Compares results, and gradients of a weighted sum of them, to 1e-5.
void ExpectSame(const torch::Tensor& ours, const std::vector<torch::Tensor>& inputs,
                const torch::Tensor& truth, const std::vector<torch::Tensor>& true_inputs) {
  EXPECT_LT(LargestDifference(ours, truth), 1e-5);
  const torch::Tensor weights = torch::randn(ours.sizes());
  const auto gradients = torch::autograd::grad({(ours * weights).sum()}, inputs);
  const auto true_gradients =
      torch::autograd::grad({(truth * weights.to(torch::kDouble)).sum()}, true_inputs);
  for (size_t i = 0; i < inputs.size(); ++i) {
    EXPECT_GT(true_gradients[i].abs().max().item<double>(), 1e-3) << i;
    EXPECT_LT(LargestDifference(gradients[i], true_gradients[i]), 1e-5) << i;
  }
}

TEST(Attention, IsItsFormula) {
  torch::manual_seed(1);
  const torch::Tensor q = Leaf({3, 4, 17, 16}), k = Leaf({3, 4, 23, 16}), v = Leaf({3, 4, 23, 16});
  const torch::Tensor dq = DoubleLeaf(q), dk = DoubleLeaf(k), dv = DoubleLeaf(v);
  const torch::Tensor truth = AttentionFormula(dq, dk, dv).transpose(1, 2).reshape({3, 17, 64});
  ExpectSame(Attention(q, k, v), {q, k, v}, truth, {dq, dk, dv});
}

TEST(Attention, LeavesMaskedKeysOut) {
  torch::manual_seed(2);
  const torch::Tensor q = Leaf({3, 2, 9, 8}), k = Leaf({3, 2, 11, 8}), v = Leaf({3, 2, 11, 8});
  torch::Tensor mask = torch::rand({3, 11}) < 0.5;
  mask.select(1, 4).fill_(true);
  mask[2].fill_(false);
  mask[2][10] = true;  // a single key, whose values are the result
  const torch::Tensor dq = DoubleLeaf(q), dk = DoubleLeaf(k), dv = DoubleLeaf(v);
  const torch::Tensor truth =
      AttentionFormula(dq, dk, dv, mask).transpose(1, 2).reshape({3, 9, 16});
  ExpectSame(Attention(q, k, v, mask), {q, k, v}, truth, {dq, dk, dv});
  const torch::Tensor single = v[2].select(1, 10).reshape({1, 16}).expand({9, 16});
  EXPECT_LT(LargestDifference(Attention(q, k, v, mask)[2], single), 1e-6);
}

// The layers of a denoiser's block: a linear map in bfloat16, norms, attention.
TEST(Attention, FollowsItsFormulaInMixedPrecision) {
  torch::manual_seed(6);
  torch::nn::Linear map(32, 96);
  RmsNorm norm(8);
  const torch::Tensor x = torch::randn({2, 10, 32});
  const auto heads = [&](const torch::Tensor& all) { return SplitHeads(all, 4); };
  torch::Tensor ours;
  {
    const MixedPrecision half(torch::kCPU, true);
    const std::vector<torch::Tensor> qkv = map(x).chunk(3, -1);
    ours = Attention(norm(heads(qkv[0])), norm(heads(qkv[1])), heads(qkv[2]));
    torch::autograd::grad({ours.to(torch::kFloat).square().sum()}, map->parameters());
  }
  const std::vector<torch::Tensor> qkv = map(x).to(torch::kDouble).chunk(3, -1);
  const torch::Tensor one = torch::ones({8}, torch::kDouble);
  const torch::Tensor truth = AttentionFormula(RmsFormula(heads(qkv[0]), one),
                                               RmsFormula(heads(qkv[1]), one), heads(qkv[2]));
  EXPECT_LT(LargestDifference(ours, truth.transpose(1, 2).reshape({2, 10, 32})), 0.03);
}

TEST(RmsNorm, IsItsFormulaForHeadsInAnyLayout) {
  torch::manual_seed(3);
  RmsNorm norm(16);
  const torch::Tensor scale = norm->parameters()[0];
  {
    const torch::NoGradGuard no_gradient;
    scale.uniform_(0.5, 2.0);
  }
  const torch::Tensor x = Leaf({2, 13, 64}), dx = DoubleLeaf(x), dscale = DoubleLeaf(scale);
  const torch::Tensor truth = RmsFormula(SplitHeads(dx, 4), dscale);
  ExpectSame(norm(SplitHeads(x, 4)), {x, scale}, truth, {dx, dscale});
}

TEST(PlainLayerNorm, IsItsFormula) {
  torch::manual_seed(4);
  const torch::Tensor x = Leaf({5, 7, 32}), dx = DoubleLeaf(x);
  const torch::Tensor off = dx - dx.mean(-1, true);
  ExpectSame(PlainLayerNorm(x), {x}, off / torch::sqrt((off * off).mean(-1, true) + 1e-6), {dx});
}

TEST(SpatialAttention, IsItsFormula) {
  torch::manual_seed(5);
  constexpr std::int64_t kChannels = 24, kHeads = 3, kSide = 6;
  SpatialAttention block(kChannels, kHeads);
  {
    const torch::NoGradGuard no_gradient;
    for (torch::Tensor& one : block->parameters()) one.normal_(0.0, 0.3);
  }
  const auto named = block->named_parameters();
  const auto weight = [&](const char* name) { return named[name].detach().to(torch::kDouble); };
  const torch::Tensor x = Leaf({2, kChannels, kSide, kSide}), dx = DoubleLeaf(x);
  // Eight channels a group, as in blocks.cpp.
  const torch::Tensor normed =
      torch::group_norm(dx, 3, weight("norm.weight"), weight("norm.bias"), 1e-5);
  const std::vector<torch::Tensor> qkv =
      torch::conv2d(normed, weight("qkv.weight"), weight("qkv.bias")).chunk(3, 1);
  const auto heads = [&](const torch::Tensor& one) {
    return one.reshape({2, kHeads, kChannels / kHeads, kSide * kSide}).transpose(2, 3);
  };
  const torch::Tensor attended = AttentionFormula(heads(qkv[0]), heads(qkv[1]), heads(qkv[2]));
  const torch::Tensor mixed = attended.transpose(2, 3).reshape(dx.sizes());
  const torch::Tensor truth = dx + torch::conv2d(mixed, weight("out.weight"), weight("out.bias"));
  ExpectSame(block(x), {x}, truth, {dx});
}

}  // namespace
}  // namespace simwright::nn
