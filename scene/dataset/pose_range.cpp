#include "scene/dataset/pose_range.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/json.h"

namespace simwright::scene {
namespace {

// Half the smallest range that is scaled to [-1, 1]: in a smaller one the noise of settling would
// be amplified to the size of real variation.
constexpr double kLeastHalf = 1e-3;
constexpr int kBlock = 256;  // scenes per read

}  // namespace

PoseRange::PoseRange(const std::array<double, kPoseWidth>& low,
                     const std::array<double, kPoseWidth>& high)
    : low_(low), high_(high) {
  for (size_t i = 0; i < kPoseWidth; ++i) {
    if (!std::isfinite(low[i]) || !std::isfinite(high[i]) || low[i] > high[i]) {
      throw core::Error("the range of a pose feature is invalid", std::to_string(i));
    }
  }
}

PoseRange PoseRange::Of(const SceneDataset& dataset, int first, int count) {
  std::array<double, kPoseWidth> low{}, high{};
  const auto width = static_cast<size_t>(dataset.vocabulary().TokenWidth());
  for (int at = first; at < first + count; at += kBlock) {
    const std::vector<float> tokens = dataset.Read(at, std::min(kBlock, first + count - at));
    for (size_t token = 0; token < tokens.size(); token += width) {
      for (size_t i = 0; i < kPoseWidth; ++i) {
        low[i] = std::min<double>(low[i], tokens[token + i]);
        high[i] = std::max<double>(high[i], tokens[token + i]);
      }
    }
  }
  return PoseRange(low, high);
}

double PoseRange::HalfWidth(size_t feature) const {
  return std::max(0.5 * (high_[feature] - low_[feature]), kLeastHalf);
}

void PoseRange::ToUnit(const float* pose, float* unit) const {
  for (size_t i = 0; i < kPoseWidth; ++i) {
    unit[i] = static_cast<float>((pose[i] - 0.5 * (low_[i] + high_[i])) / HalfWidth(i));
  }
}

void PoseRange::FromUnit(const float* unit, float* pose) const {
  for (size_t i = 0; i < kPoseWidth; ++i) {
    pose[i] = static_cast<float>(0.5 * (low_[i] + high_[i]) + HalfWidth(i) * unit[i]);
  }
}

std::string PoseRange::Text() const {
  return core::JsonLine(core::Json{{"low", low_}, {"high", high_}});
}

PoseRange PoseRange::FromText(const std::string& text) {
  const core::JsonDocument document(text, "the ranges of poses");
  const auto read = [&](const char* name) {
    const std::vector<double> numbers = document.root()[name].Numbers(kPoseWidth);
    std::array<double, kPoseWidth> values{};
    std::copy(numbers.begin(), numbers.end(), values.begin());
    return values;
  };
  return PoseRange(read("low"), read("high"));
}

}  // namespace simwright::scene
