#include "asset_lift/radiance_field/field_adam.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/radiance_field/field_model.h"
#include "core/parallel.h"

namespace simwright::asset_lift {
namespace {

constexpr std::size_t kChunk = 16384;

}  // namespace

bool FieldAdam::Step(double rate, RadianceField* field, FieldGradient<float>* gradient) {
  std::vector<float>& parameters = field->parameters();
  const std::size_t size = parameters.size();
  gradient->Prepare(*field);
  if (mean_.size() != size) {
    mean_.assign(size, 0.0f);
    square_.assign(size, 0.0f);
    steps_ = 0;
  }
  const int chunks = static_cast<int>((size + kChunk - 1) / kChunk);
  const FieldKernels<float>& kernels = FastestFieldKernels<float>();
  std::vector<char> finite(chunks, 1);
  std::vector<float>& sum = gradient->parts[0];
  core::ParallelFor(chunks, [&](int c) {
    const std::size_t first = c * kChunk, count = std::min(kChunk, size - first);
    for (std::size_t p = 1; p < gradient->parts.size(); ++p) {
      finite[c] = kernels.accumulate_part(count, &gradient->parts[p][first], &sum[first]);
    }
    if (gradient->parts.size() == 1) {
      finite[c] =
          std::all_of(&sum[first], &sum[first] + count, [](float g) { return std::isfinite(g); });
    }
  });
  if (std::find(finite.begin(), finite.end(), 0) != finite.end()) {
    std::fill(sum.begin(), sum.end(), 0.0f);
    return false;
  }
  ++steps_;
  const AdamStep<float> step = {
      static_cast<float>(options_.beta1), static_cast<float>(options_.beta2),
      static_cast<float>(rate / (1.0 - std::pow(options_.beta1, steps_))),
      static_cast<float>(1.0 / std::sqrt(1.0 - std::pow(options_.beta2, steps_))),
      static_cast<float>(options_.epsilon)};
  core::ParallelFor(chunks, [&](int c) {
    const std::size_t first = c * kChunk;
    kernels.adam(step, std::min(kChunk, size - first), &sum[first], &mean_[first], &square_[first],
                 &parameters[first]);
  });
  return true;
}

}  // namespace simwright::asset_lift
