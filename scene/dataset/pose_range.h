#pragma once

#include <array>
#include <string>

#include "scene/dataset/scene_dataset.h"

namespace simwright::scene {

// How poses are brought to [-1, 1]: feature by feature, from the least to the greatest value that
// scenes have (Pfaff et al., appendix). Padding's zeros are among them, for the model has to make
// them too.
class PoseRange {
 public:
  // Throws core::Error where a low is above its high, or one is not finite.
  PoseRange(const std::array<double, kPoseWidth>& low, const std::array<double, kPoseWidth>& high);

  // Of scenes first .. first + count - 1, read part by part.
  static PoseRange Of(const SceneDataset& dataset, int first, int count);

  const std::array<double, kPoseWidth>& low() const { return low_; }
  const std::array<double, kPoseWidth>& high() const { return high_; }

  // Of the 12 numbers of one pose; what lies outside the range comes to lie outside [-1, 1].
  void ToUnit(const float* pose, float* unit) const;
  void FromUnit(const float* unit, float* pose) const;

  // As JSON, and back. Throws core::Error for what is none.
  std::string Text() const;
  static PoseRange FromText(const std::string& text);

 private:
  double HalfWidth(size_t feature) const;
  std::array<double, kPoseWidth> low_, high_;
};

}  // namespace simwright::scene
