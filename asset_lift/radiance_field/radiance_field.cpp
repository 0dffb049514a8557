#include "asset_lift/radiance_field/radiance_field.h"

#include <cmath>

#include "asset_lift/radiance_field/field_model.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"

namespace simwright::asset_lift {
namespace {

#if defined(__x86_64__)
const bool uses_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
const bool uses_avx2 = false;
#endif

const RadianceFieldOptions& RequireValidOptions(const RadianceFieldOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "radiance field");
  return options;
}

}  // namespace

template <typename Real>
const FieldKernels<Real>& FastestFieldKernels() {
  static const FieldKernels<Real> kernels =
      uses_avx2 ? Avx2FieldKernels<Real>() : PlainFieldKernels<Real>();
  return kernels;
}

template const FieldKernels<float>& FastestFieldKernels();
template const FieldKernels<double>& FastestFieldKernels();

bool RadianceFieldOptions::IsValid(std::string* error) const {
  if (!grid.IsValid(error)) return false;
  const char* fault = nullptr;
  if (grid.levels * grid.features > kMaxFieldInputs) {
    fault = "a field's grid must have at most 64 features: use fewer levels or features per level";
  }
  if (hidden < 8 || hidden > kMaxFieldHidden || hidden % 8 != 0) {
    fault = "a field must have 8 to 128 hidden units, a multiple of 8";
  }
  if (!(half_side > 0.0) || !std::isfinite(half_side) || !center.allFinite()) {
    fault = "a field's cube needs a finite centre and a positive size";
  }
  if (!(density_scale > 0.0) || !std::isfinite(density_scale)) {
    fault = "density_scale must be positive";
  }
  if (!std::isfinite(blob_scale) || !(blob_std > 0.0)) {
    fault = "the density's blob needs a finite scale and a positive width";
  }
  if (fault != nullptr && error != nullptr) *error = fault;
  return fault == nullptr;
}

template <typename Real>
BasicRadianceField<Real>::BasicRadianceField(const RadianceFieldOptions& options,
                                             std::uint64_t seed)
    : options_(RequireValidOptions(options)), layout_(options.grid) {
  const int inputs = layout_.outputs();
  table_size_ = static_cast<std::size_t>(layout_.entries()) * layout_.features();
  const std::size_t hidden_size = static_cast<std::size_t>(inputs) * options.hidden;
  parameters_.resize(table_size_ + hidden_size +
                     static_cast<std::size_t>(kFieldOutputs) * options.hidden);
  core::Rng rng = core::StreamRng(seed, 0);
  const double hidden_bound = std::sqrt(6.0 / inputs),
               output_bound = std::sqrt(6.0 / options.hidden);
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const double bound = i < table_size_                 ? 1e-4
                         : i < table_size_ + hidden_size ? hidden_bound
                                                         : output_bound;
    parameters_[i] = static_cast<Real>(core::Uniform(rng, -bound, bound));
  }
  if (options.density_bias) TabulateBias();
}

template <typename Real>
void BasicRadianceField<Real>::TabulateBias() {
  constexpr int kSide = kBiasCells + 1;
  bias_.resize(kSide * kSide * kSide);
  std::size_t at = 0;
  for (int k = 0; k < kSide; ++k) {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const Eigen::Vector3d unit = Eigen::Vector3d(i, j, k) * (2.0 / kBiasCells);
        const double value = options_.density_bias(
            options_.center + options_.half_side * (unit - Eigen::Vector3d::Ones()));
        if (!std::isfinite(value)) throw core::Error("the density's bias is not finite", "field");
        bias_[at++] = static_cast<Real>(value);
      }
    }
  }
}

template <typename Real>
FieldModel<Real> BasicRadianceField<Real>::Model() const {
  FieldModel<Real> model;
  model.layout = &layout_;
  model.inputs = layout_.outputs();
  model.hidden = options_.hidden;
  model.table = parameters_.data();
  model.hidden_weights = model.table + table_size_;
  model.output_weights = model.hidden_weights + model.inputs * model.hidden;
  model.density_scale = static_cast<Real>(options_.density_scale);
  model.bias.blob_scale = static_cast<Real>(options_.blob_scale);
  model.bias.blob_slope = static_cast<Real>(options_.blob_scale / options_.blob_std);
  model.bias.table = bias_.empty() ? nullptr : bias_.data();
  return model;
}

template <typename Real>
void BasicRadianceField<Real>::Evaluate(FieldBatch<Real>* batch) const {
  FastestFieldKernels<Real>().evaluate(Model(), batch);
}

template <typename Real>
void BasicRadianceField<Real>::AddGradient(const FieldBatch<Real>& batch,
                                           const FieldBatchGradient<Real>& gradient,
                                           Real* sum) const {
  FastestFieldKernels<Real>().add_gradient(Model(), batch, gradient, sum);
}

template <typename Real>
bool BasicRadianceField<Real>::UsesAvx2() {
  return uses_avx2;
}

template <typename Real>
template <typename Visit>
void BasicRadianceField<Real>::EvaluateAll(const std::vector<Eigen::Vector3d>& points,
                                           const Visit& visit) const {
  const int batches = static_cast<int>((points.size() + kFieldBatch - 1) / kFieldBatch);
  core::ParallelFor(batches, [&](int b) {
    FieldBatch<Real> batch;
    const std::size_t first = static_cast<std::size_t>(b) * kFieldBatch;
    const std::size_t count = std::min<std::size_t>(kFieldBatch, points.size() - first);
    for (std::size_t s = 0; s < kFieldBatch; ++s) {
      const Eigen::Vector3d at =
          (points[first + std::min(s, count - 1)] - options_.center) / options_.half_side;
      for (int a = 0; a < 3; ++a) batch.position[a][s] = static_cast<Real>(at[a]);
    }
    Evaluate(&batch);
    for (std::size_t s = 0; s < count; ++s) visit(batch, static_cast<int>(s), first + s);
  });
}

template <typename Real>
std::vector<float> BasicRadianceField<Real>::DensityAt(
    const std::vector<Eigen::Vector3d>& points) const {
  std::vector<float> density(points.size());
  EvaluateAll(points, [&](const FieldBatch<Real>& batch, int s, std::size_t i) {
    const bool inside = std::abs(batch.position[0][s]) <= 1 &&
                        std::abs(batch.position[1][s]) <= 1 && std::abs(batch.position[2][s]) <= 1;
    density[i] = inside ? static_cast<float>(batch.density[s] / options_.half_side) : 0.0f;
  });
  return density;
}

template <typename Real>
std::vector<Eigen::Vector3f> BasicRadianceField<Real>::ColorAt(
    const std::vector<Eigen::Vector3d>& points) const {
  std::vector<Eigen::Vector3f> color(points.size());
  EvaluateAll(points, [&](const FieldBatch<Real>& batch, int s, std::size_t i) {
    for (int c = 0; c < 3; ++c) color[i][c] = static_cast<float>(batch.color[c][s]);
  });
  return color;
}

template class BasicRadianceField<float>;
template class BasicRadianceField<double>;

}  // namespace simwright::asset_lift
