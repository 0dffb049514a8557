#pragma once

#include <vector>

#include "asset_lift/radiance_field/radiance_field.h"
#include "asset_lift/radiance_field/volume_rendering.h"

namespace simwright::asset_lift {

struct FieldAdamOptions {
  // Kingma and Ba, "Adam", 2015, with the hyperparameters of threestudio's Zero-1-to-3.
  double beta1 = 0.9;
  double beta2 = 0.99;
  double epsilon = 1e-8;
};

// The Adam optimizer over all parameters of a field. It is dense, not sparse: a step over the
// default field's 442 thousand parameters takes about a millisecond, and entries without a gradient
// follow their momentum as published.
class FieldAdam {
 public:
  explicit FieldAdam(const FieldAdamOptions& options = {}) : options_(options) {}

  // Takes one step at `rate` against the sum of the gradient's parts and zeroes the parts. Returns
  // false and changes no parameter if the sum is not finite.
  bool Step(double rate, RadianceField* field, FieldGradient<float>* gradient);

 private:
  FieldAdamOptions options_;
  int steps_ = 0;
  std::vector<float> mean_, square_;
};

}  // namespace simwright::asset_lift
