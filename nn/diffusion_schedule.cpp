#include "nn/diffusion_schedule.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace simwright::nn {
namespace {

torch::Tensor Column(const DeviceTable& table, const torch::Tensor& t, std::int64_t rank) {
  std::vector<std::int64_t> shape(static_cast<size_t>(rank), 1);
  shape[0] = -1;
  return table.On(t.device()).index_select(0, t.to(torch::kLong)).to(torch::kFloat).reshape(shape);
}

}  // namespace

DiffusionSchedule::DiffusionSchedule(const torch::Tensor& kept)
    : signal_(torch::sqrt(kept)), noise_(torch::sqrt(1.0 - kept)) {}

DiffusionSchedule DiffusionSchedule::OfBetas(const torch::Tensor& betas) {
  return DiffusionSchedule(torch::cumprod(1.0 - betas, 0));
}

DiffusionSchedule DiffusionSchedule::Cosine(int steps) {
  if (steps < 2) throw core::Error("a diffusion needs at least two steps");
  const torch::Tensor time = torch::arange(steps + 1, torch::kDouble) / static_cast<double>(steps);
  const torch::Tensor kept = torch::pow(torch::cos((time + 0.008) / 1.008 * (0.5 * M_PI)), 2);
  const torch::Tensor betas = 1.0 - kept.slice(0, 1, steps + 1) / kept.slice(0, 0, steps);
  return OfBetas(torch::clamp(betas, 1e-6, 0.999));
}

DiffusionSchedule DiffusionSchedule::ScaledLinear(int steps, double first, double last) {
  if (steps < 2 || !(first > 0.0) || !(last > first) || last >= 1.0) {
    throw core::Error("a diffusion has at least two steps and betas that rise between 0 and 1");
  }
  return OfBetas(
      torch::pow(torch::linspace(std::sqrt(first), std::sqrt(last), steps, torch::kDouble), 2));
}

DiffusionSchedule DiffusionSchedule::Linear(int steps, double first, double last) {
  if (steps < 2 || !(first > 0.0) || !(last > first) || last >= 1.0) {
    throw core::Error("a diffusion has at least two steps and betas that rise between 0 and 1");
  }
  return OfBetas(torch::linspace(first, last, steps, torch::kDouble));
}

torch::Tensor DiffusionSchedule::Signal(const torch::Tensor& t, std::int64_t rank) const {
  return Column(signal_, t, rank);
}

torch::Tensor DiffusionSchedule::Noise(const torch::Tensor& t, std::int64_t rank) const {
  return Column(noise_, t, rank);
}

torch::Tensor DiffusionSchedule::AddNoise(const torch::Tensor& clean, const torch::Tensor& noise,
                                          const torch::Tensor& t) const {
  return Signal(t, clean.dim()) * clean + Noise(t, clean.dim()) * noise;
}

torch::Tensor DiffusionSchedule::CleanFrom(const torch::Tensor& noisy, const torch::Tensor& noise,
                                           const torch::Tensor& t) const {
  return (noisy - Noise(t, noisy.dim()) * noise) / Signal(t, noisy.dim());
}

torch::Tensor DiffusionSchedule::DdimStep(const torch::Tensor& noisy, const torch::Tensor& noise,
                                          int t, int previous) const {
  const torch::Tensor clean = (noisy - NoiseAt(t) * noise) / SignalAt(t);
  if (previous < 0) return clean;
  return SignalAt(previous) * clean + NoiseAt(previous) * noise;
}

double DiffusionSchedule::StepDeviation(int t, int previous, double eta) const {
  if (previous < 0) return 0.0;
  const double kept = SignalAt(t) / SignalAt(previous);  // signal kept from `previous` to t
  return eta * NoiseAt(previous) / NoiseAt(t) * std::sqrt(1.0 - kept * kept);
}

torch::Tensor DiffusionSchedule::StepMean(const torch::Tensor& noisy, const torch::Tensor& clean,
                                          int t, int previous, double eta) const {
  if (previous < 0) return clean;
  const double earlier_spread = NoiseAt(previous), deviation = StepDeviation(t, previous, eta);
  const torch::Tensor noise = (noisy - SignalAt(t) * clean) / NoiseAt(t);
  const double direct =
      std::sqrt(std::max(0.0, earlier_spread * earlier_spread - deviation * deviation));
  return SignalAt(previous) * clean + direct * noise;
}

torch::Tensor DiffusionSchedule::StochasticStep(const torch::Tensor& noisy,
                                                const torch::Tensor& clean, int t, int previous,
                                                double eta, const torch::Tensor& fresh) const {
  if (previous < 0) return clean;
  return StepMean(noisy, clean, t, previous, eta) + StepDeviation(t, previous, eta) * fresh;
}

}  // namespace simwright::nn
