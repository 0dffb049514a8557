#pragma once

#include <array>
#include <string>

#include "scene/dataset/scene_dataset.h"

namespace simwright::scene {

// The normalization of poses to [-1, 1]: feature by feature, from the smallest to the largest value
// in the scenes (Pfaff et al., appendix). The zeros of padding are included, because the model
// generates them too.
class PoseRange {
 public:
  // Throws core::Error if a low exceeds its high, or one is not finite.
  PoseRange(const std::array<double, kPoseWidth>& low, const std::array<double, kPoseWidth>& high);

  // Returns the range of scenes first .. first + count - 1, read in blocks.
  static PoseRange Of(const SceneDataset& dataset, int first, int count);

  const std::array<double, kPoseWidth>& low() const { return low_; }
  const std::array<double, kPoseWidth>& high() const { return high_; }

  // Normalizes the 12 numbers of one pose; values outside the range map outside [-1, 1].
  void ToUnit(const float* pose, float* unit) const;
  void FromUnit(const float* unit, float* pose) const;

  // Converts to JSON and back. FromText throws core::Error for text that is not a valid range.
  std::string Text() const;
  static PoseRange FromText(const std::string& text);

 private:
  double HalfWidth(size_t feature) const;
  std::array<double, kPoseWidth> low_, high_;
};

}  // namespace simwright::scene
