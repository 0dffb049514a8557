#pragma once

#include <vector>

#include "asset_lift/radiance_field.h"
#include "asset_lift/volume_rendering.h"

namespace simwright::asset_lift {

struct FieldAdamOptions {
  // Kingma and Ba, "Adam", 2015; the figures of threestudio's Zero-1-to-3.
  double beta1 = 0.9;
  double beta2 = 0.99;
  double epsilon = 1e-8;
};

// Adam over all of a field's parameters. Dense, not sparse: a step over the default field's 442
// thousand numbers takes about a millisecond, and entries that a step does not touch follow
// their momentum as published.
class FieldAdam {
 public:
  explicit FieldAdam(const FieldAdamOptions& options = {}) : options_(options) {}

  // One step at `rate` against the sum of the gradient's parts, which become zero. False, and
  // nothing is moved, where the sum is not finite.
  bool Step(double rate, RadianceField* field, FieldGradient<float>* gradient);

 private:
  FieldAdamOptions options_;
  int steps_ = 0;
  std::vector<float> mean_, square_;
};

}  // namespace simwright::asset_lift
