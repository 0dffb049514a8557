#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/hash_grid.h"

namespace simwright::asset_lift {

template <typename Real>
struct FieldModel;

struct RadianceFieldOptions {
  HashGridOptions grid;
  // Units of the one hidden layer (ReLU, no biases), a multiple of 8 up to 128.
  int hidden = 32;
  // The field lives in a cube about `center` (m, world); beyond it there is nothing.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double half_side = 0.5;  // m
  // Density = density_scale * softplus(raw), per half side. At 1 as published a fit of 200 steps
  // ends in a haze; at 5 a chair's silhouette from 8 views rises from 0.90 to 0.94.
  double density_scale = 5.0;
  // What is added to the density before its softplus: by default a blob, blob_scale *
  // (1 - |x| / blob_std) with x in half sides. Poole et al., "DreamFusion", 2022, with the figures
  // of threestudio's Zero-1-to-3.
  double blob_scale = 10.0;
  double blob_std = 0.5;
  // ... or this function of a world point, where it is given. It is tabulated at 65^3 points and
  // read trilinearly; its values must be finite.
  std::function<double(const Eigen::Vector3d&)> density_bias;

  bool IsValid(std::string* error) const;
};

// Points that the field looks at together, and what it says there. Points beyond the cube are
// clamped to it: whoever asks leaves them out.
inline constexpr int kFieldBatch = 64;
inline constexpr int kMaxFieldInputs = 64;  // features of the grid, all levels together

template <typename Real>
struct FieldBatch {
  alignas(64) Real position[3][kFieldBatch];  // in half sides from the centre, [-1, 1]
  alignas(64) Real raw[kFieldBatch];          // the density before softplus, bias included
  alignas(64) Real density[kFieldBatch];      // density_scale * softplus(raw), per half side
  alignas(64) Real color[3][kFieldBatch];     // sRGB in (0, 1)
  // The grid's features, rows `feature_stride()` apart: gradients need them, and reading the table
  // again would cost more than keeping them.
  alignas(64) Real features[kFieldBatch * kMaxFieldInputs];
};

// dL/d(what the field said). `raw` is beside what comes through `density`.
template <typename Real>
struct FieldBatchGradient {
  alignas(64) Real raw[kFieldBatch];
  alignas(64) Real density[kFieldBatch];
  alignas(64) Real color[3][kFieldBatch];
};

// Density and colour of a cube of space: a hash grid whose features pass through one hidden layer
// shared by the density and the three colours, all read from one vector of parameters.
// `Real` is float; double exists to check gradients.
// Evaluate and AddGradient are const and safe from several threads.
template <typename Real>
class BasicRadianceField {
 public:
  // Random weights (He uniform) and features (within 1e-4), drawn from `seed`. Throws core::Error
  // for options that are not valid, or a bias that is not finite.
  BasicRadianceField(const RadianceFieldOptions& options, std::uint64_t seed);

  const RadianceFieldOptions& options() const { return options_; }
  const HashGridLayout& layout() const { return layout_; }

  // The grid's table (entries x features), then the hidden layer's weights (grid outputs x
  // hidden), then the outputs' (4 x hidden: density, red, green, blue).
  std::vector<Real>& parameters() { return parameters_; }
  const std::vector<Real>& parameters() const { return parameters_; }
  std::size_t table_size() const { return table_size_; }  // how many of them are the table's

  // Numbers of a point's row in FieldBatch::features: the grid's outputs, in eights.
  int feature_stride() const { return (layout_.outputs() + 7) / 8 * 8; }

  // Fills all but `position`, for all kFieldBatch points.
  void Evaluate(FieldBatch<Real>* batch) const;

  // Adds dL/d(parameters) to `sum` (as long as the parameters), given what Evaluate filled in
  // (but for `raw`, which may be anything) and the gradient with respect to it.
  void AddGradient(const FieldBatch<Real>& batch, const FieldBatchGradient<Real>& gradient,
                   Real* sum) const;

  // Density (1/m) and colour (sRGB) at world points; the density is 0 beyond the cube. Shared among
  // threads. (N), (N x 3).
  std::vector<float> DensityAt(const std::vector<Eigen::Vector3d>& points) const;
  std::vector<Eigen::Vector3f> ColorAt(const std::vector<Eigen::Vector3d>& points) const;

  // Whether the vector instructions of AVX2 are in use (decided at start; plain x86-64 else).
  static bool UsesAvx2();

  FieldModel<Real> Model() const;  // for the inner loops: valid while the field is

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
