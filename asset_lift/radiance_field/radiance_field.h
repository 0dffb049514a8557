#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/radiance_field/field_fit_options.h"
#include "asset_lift/radiance_field/hash_grid.h"

namespace simwright::asset_lift {

template <typename Real>
struct FieldModel;

// The points that a field evaluates together, and the results. Points outside the cube are clamped
// to it: the caller must exclude them.
inline constexpr int kFieldBatch = 64;
inline constexpr int kMaxFieldInputs = 64;  // features of all grid levels together

template <typename Real>
struct FieldBatch {
  alignas(64) Real position[3][kFieldBatch];  // in half sides from the centre, [-1, 1]
  alignas(64) Real raw[kFieldBatch];          // the density before softplus, bias included
  alignas(64) Real density[kFieldBatch];      // density_scale * softplus(raw), per half side
  alignas(64) Real color[3][kFieldBatch];     // sRGB in (0, 1)
  // The grid's features, with row stride `feature_stride()`. Gradients need them, and reading the
  // table again would cost more than keeping them.
  alignas(64) Real features[kFieldBatch * kMaxFieldInputs];
};

// The gradient of a loss with respect to the outputs of a batch. `raw` is in addition to the
// gradient through `density`.
template <typename Real>
struct FieldBatchGradient {
  alignas(64) Real raw[kFieldBatch];
  alignas(64) Real density[kFieldBatch];
  alignas(64) Real color[3][kFieldBatch];
};

// The density and colour of a cube of space: a hash grid whose features pass through one hidden
// layer shared by the density and the three colours, with all parameters in one vector. `Real` is
// float; double exists to check gradients. Evaluate and AddGradient are const and thread-safe.
template <typename Real>
class BasicRadianceField {
 public:
  // Initializes weights (He uniform) and features (within 1e-4) randomly from `seed`. Throws
  // core::Error for invalid options or a bias that is not finite.
  BasicRadianceField(const RadianceFieldOptions& options, std::uint64_t seed);

  const RadianceFieldOptions& options() const { return options_; }
  const HashGridLayout& layout() const { return layout_; }

  // The grid's table (entries x features), then the hidden layer's weights (grid outputs x hidden),
  // then the outputs' weights (4 x hidden: density, red, green, blue).
  std::vector<Real>& parameters() { return parameters_; }
  const std::vector<Real>& parameters() const { return parameters_; }
  std::size_t table_size() const { return table_size_; }  // the table's share

  // Returns the row length in FieldBatch::features: the grid's outputs, rounded up to a multiple of
  // 8.
  int feature_stride() const { return (layout_.outputs() + 7) / 8 * 8; }

  // Fills all fields except `position`, for all kFieldBatch points.
  void Evaluate(FieldBatch<Real>* batch) const;

  // Adds dL/d(parameters) to `sum` (as long as the parameters), given the results of Evaluate
  // (except `raw`, which is ignored) and the gradient with respect to them.
  void AddGradient(const FieldBatch<Real>& batch, const FieldBatchGradient<Real>& gradient,
                   Real* sum) const;

  // Return the density (1/m), (N), and the colour (sRGB), (N x 3), at world points; the density is
  // 0 outside the cube. The work is distributed over threads.
  std::vector<float> DensityAt(const std::vector<Eigen::Vector3d>& points) const;
  std::vector<Eigen::Vector3f> ColorAt(const std::vector<Eigen::Vector3d>& points) const;

  // Returns true if the AVX2 kernels are in use (decided at start; otherwise plain x86-64).
  static bool UsesAvx2();

  FieldModel<Real> Model() const;  // for the inner loops; valid for the field's lifetime

 private:
  void TabulateBias();
  template <typename Visit>
  void EvaluateAll(const std::vector<Eigen::Vector3d>& points, const Visit& visit) const;

  RadianceFieldOptions options_;
  HashGridLayout layout_;
  std::size_t table_size_ = 0;
  std::vector<Real> parameters_;
  std::vector<Real> bias_;  // 65^3 values, x fastest; empty: the blob
};

extern template class BasicRadianceField<float>;
extern template class BasicRadianceField<double>;
using RadianceField = BasicRadianceField<float>;

}  // namespace simwright::asset_lift
