#include "rl/actor_critic.h"

#include <cmath>

#include "rl/orthogonal_weights.h"

namespace simwright::rl {
namespace {

using Shapes = std::vector<std::vector<std::int64_t>>;

void AppendLayers(const ActorCriticSizes& sizes, int outputs, Shapes* shapes) {
  std::int64_t inputs = sizes.observations;
  for (const int size : sizes.hidden) {
    shapes->push_back({size, inputs});
    shapes->push_back({size});
    inputs = size;
  }
  shapes->push_back({outputs, inputs});
  shapes->push_back({outputs});
}

Shapes ShapesOf(const ActorCriticSizes& sizes) {
  Shapes shapes = {{sizes.actions}};
  AppendLayers(sizes, sizes.actions, &shapes);
  AppendLayers(sizes, 1, &shapes);
  return shapes;
}

void SetOrthogonal(double gain, core::Rng& rng, torch::Tensor weights) {
  const int rows = static_cast<int>(weights.size(0)), columns = static_cast<int>(weights.size(1));
  Rows values = OrthogonalWeights(rows, columns, gain, rng).cast<float>();
  weights.copy_(torch::from_blob(values.data(), {rows, columns}));
}

Eigen::Map<const Rows> MapOf(const torch::Tensor& matrix) {
  return {matrix.data_ptr<float>(), matrix.size(0), matrix.size(1)};
}

}  // namespace

ActorCritic::ActorCritic(const ActorCriticSizes& sizes, double initial_std, core::Rng& rng,
                         torch::Device device)
    : sizes_(sizes), parameters_(ShapesOf(sizes), device) {
  const torch::NoGradGuard no_grad;
  torch::Tensor(log_std()).fill_(std::log(initial_std));
  const std::size_t layers = sizes.hidden.size() + 1;
  for (std::size_t layer = 0; layer < 2 * layers; ++layer) {
    double gain = std::sqrt(2.0);
    if (layer + 1 == layers) gain = 0.01;
    if (layer + 1 == 2 * layers) gain = 1.0;
    SetOrthogonal(gain, rng, parameters_[1 + 2 * layer]);
  }
}

torch::Tensor ActorCritic::Forward(std::size_t first, const torch::Tensor& observations) const {
  torch::Tensor x = observations;
  const std::size_t layers = sizes_.hidden.size() + 1;
  for (std::size_t layer = 0; layer < layers; ++layer) {
    const torch::Tensor& weights = parameters_[first + 2 * layer];
    x = torch::addmm(parameters_[first + 2 * layer + 1], x, weights.t());
    if (layer + 1 == layers) break;
    x = sizes_.activation == Activation::kTanh ? x.tanh_() : torch::elu_(x);
  }
  return x;
}

torch::Tensor ActorCritic::Means(const torch::Tensor& observations) const {
  return Forward(1, observations);
}

torch::Tensor ActorCritic::Values(const torch::Tensor& observations) const {
  return Forward(1 + 2 * (sizes_.hidden.size() + 1), observations).squeeze(1);
}

Mlp ActorCritic::Actor() const {
  std::vector<Mlp::Layer> layers(sizes_.hidden.size() + 1);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const torch::Tensor weights = parameters_[1 + 2 * i].detach().cpu();
    const torch::Tensor bias = parameters_[2 + 2 * i].detach().cpu();
    layers[i].weights = MapOf(weights).transpose();
    layers[i].bias = MapOf(bias.unsqueeze(0));
  }
  return Mlp(std::move(layers), sizes_.activation);
}

Eigen::RowVectorXf ActorCritic::Std() const {
  const torch::Tensor std = log_std().detach().exp().cpu();
  return MapOf(std.unsqueeze(0));
}

void ActorCritic::ClampStd(double low, double high) {
  const torch::NoGradGuard no_grad;
  torch::Tensor(log_std()).clamp_(std::log(low), std::log(high));
}

}  // namespace simwright::rl
