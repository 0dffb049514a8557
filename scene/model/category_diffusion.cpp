#include "scene/model/category_diffusion.h"

#include "core/error.h"
#include "nn/noise.h"

namespace simwright::scene {
namespace {

constexpr double kAlmostOne = 0.99999, kAlmostZero = 9e-6;  // Gu et al. 2022
constexpr double kLeast = 1e-30;  // smallest probability in a logarithm: log is
                                  // -69

// Returns `steps`. Throws core::Error for too few steps or classes.
int CheckedSteps(int steps, int classes) {
  if (steps < 2 || classes < 1) {
    throw core::Error("a diffusion of classes has at least two steps and one class");
  }
  return steps;
}

// Returns `clean`, that of the clean class, and the values of all steps.
torch::Tensor LinearTable(double clean, double first, double last, int steps) {
  return torch::cat({torch::full({1}, clean, torch::kDouble),
                     torch::linspace(first, last, steps, torch::kDouble)});
}

}  // namespace

CategoryDiffusion::CategoryDiffusion(int steps, int classes)
    : steps_(CheckedSteps(steps, classes)),
      classes_(classes),
      kept_(LinearTable(1.0, kAlmostOne, kAlmostZero, steps)),
      masked_(LinearTable(0.0, kAlmostZero, kAlmostOne, steps)),
      replaced_((1.0 - kept_.On(torch::kCPU) - masked_.On(torch::kCPU)).clamp_min(0.0) / classes) {}

torch::Tensor CategoryDiffusion::At(const nn::DeviceTable& table, const torch::Tensor& t) const {
  return table.On(t.device()).index_select(0, t + 1).reshape({-1, 1, 1});
}

torch::Tensor CategoryDiffusion::Draw(const torch::Tensor& probabilities,
                                      const at::Generator& generator) {
  const torch::Tensor uniform =
      nn::UniformNumbers(probabilities.sizes(), generator).to(probabilities.device());
  const torch::Tensor gumbel =
      -torch::log((-torch::log(uniform.clamp_min(1e-20))).clamp_min(1e-20));
  return (torch::log(probabilities.clamp_min(kLeast)) + gumbel).argmax(-1);
}

torch::Tensor CategoryDiffusion::AddNoise(const torch::Tensor& clean, const torch::Tensor& t,
                                          const at::Generator& generator) const {
  const torch::Tensor one_hot = torch::one_hot(clean, classes_).to(torch::kFloat);
  const torch::Tensor classes = (At(kept_, t) * one_hot + At(replaced_, t)).to(torch::kFloat);
  const torch::Tensor mask =
      At(masked_, t).to(torch::kFloat).expand({clean.size(0), clean.size(1), 1});
  return Draw(torch::cat({classes, mask}, -1), generator);
}

torch::Tensor CategoryDiffusion::Posterior(const torch::Tensor& noisy, const torch::Tensor& clean,
                                           const torch::Tensor& t, const torch::Tensor& s) const {
  // From s to t a class is kept with probability a, masked with c, and replaced with the rest,
  // which is about a millionth: a difference of numbers near one that single precision would lose.
  const torch::Tensor kept = At(kept_, t) / At(kept_, s);
  const torch::Tensor stays = (1.0 - At(masked_, t)) / (1.0 - At(masked_, s));
  const auto single = [](const torch::Tensor& x) { return x.to(torch::kFloat); };
  const torch::Tensor a = single(kept), c = single(1.0 - stays);
  const torch::Tensor b = single((stays - kept).clamp_min(0.0) / classes_);
  const torch::Tensor a_t = single(At(kept_, t)), a_s = single(At(kept_, s));
  const torch::Tensor b_t = single(At(replaced_, t)), b_s = single(At(replaced_, s));
  const torch::Tensor c_t = single(At(masked_, t)), c_s = single(At(masked_, s));
  const torch::Tensor here = torch::one_hot(noisy, classes_ + 1).to(torch::kFloat);
  const torch::Tensor classes_here = here.narrow(-1, 0, classes_);
  const torch::Tensor masked_here = here.narrow(-1, classes_, 1);
  const torch::Tensor open = 1.0 - masked_here;
  // r_k = p(k) / q(x_t | x_0 = k).
  const torch::Tensor evidence = open * (a_t * classes_here + b_t) + masked_here * c_t;
  const torch::Tensor r = clean / evidence.clamp_min(kLeast);
  const torch::Tensor sum = r.sum(-1, true);
  // q(x_t | x_s = i) for a class i, and for the mask, which stays masked.
  const torch::Tensor step = open * (a * classes_here + b) + masked_here * c;
  const torch::Tensor posterior =
      torch::cat({step * (a_s * r + b_s * sum), masked_here * c_s * sum}, -1);
  return posterior / posterior.sum(-1, true).clamp_min(kLeast);
}

torch::Tensor CategoryDiffusion::Divergence(const torch::Tensor& clean, const torch::Tensor& noisy,
                                            const torch::Tensor& log_clean,
                                            const torch::Tensor& t) const {
  const torch::Tensor truth =
      Posterior(noisy, torch::one_hot(clean, classes_).to(torch::kFloat), t, t - 1);
  const torch::Tensor prediction = Posterior(noisy, log_clean.exp(), t, t - 1);
  const torch::Tensor difference =
      torch::log(truth.clamp_min(kLeast)) - torch::log(prediction.clamp_min(kLeast));
  return (truth * difference).sum(-1);
}

}  // namespace simwright::scene
