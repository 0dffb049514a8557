#include "capture/mat_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <opencv2/imgproc/detail/gcgraph.hpp>

#include "capture/color_mixture.h"
#include "core/error.h"

namespace simwright::capture {
namespace {

constexpr int kCuts = 3;
constexpr float kSmoothness = 30.0f;     // cost of two equal neighbours on both sides of the cut
constexpr float kPatternWeight = 12.0f;  // cost per correlation with the mat's pattern
constexpr float kUnsure = 4.0f;          // difference of costs that decides nothing
constexpr float kUsualPattern = 0.6f;  // correlation that speaks neither for the mat nor against it
constexpr float kMatNoise = 6.0f;      // of the differences' unit, of 255
constexpr float kMostDifference = 6.0f;
constexpr std::size_t kLeastSample = 30;
constexpr float kCertain = 1e4f;
constexpr float kUniformCost = 16.6355f;  // log(256^3): a background whose colours are not known

struct Neighbor {
  int dx, dy;
  float closeness;
};
constexpr std::array<Neighbor, 4> kNeighbors = {
    {{1, 0, 1.0f}, {0, 1, 1.0f}, {1, 1, 0.70710678f}, {-1, 1, 0.70710678f}}};

class Cut {
 public:
  Cut(const core::Image& photo, const MatEvidence& evidence, const std::vector<CutLabel>& labels,
      const ColorMixture* others)
      : evidence_(evidence),
        labels_(labels),
        others_(others),
        width_(photo.width),
        height_(photo.height) {
    const std::size_t pixels = static_cast<std::size_t>(width_) * height_;
    colors_.resize(pixels);
    expected_.resize(pixels);
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const std::uint8_t* p = photo.At(x, y);
        const std::uint8_t* e = evidence.expected.At(x, y);
        colors_[At(x, y)] = {float(p[0]), float(p[1]), float(p[2])};
        expected_[At(x, y)] = Eigen::Vector3f(e[0], e[1], e[2]);
      }
    }
    for (std::size_t i = 0; i < pixels; ++i) inside_.push_back(LikelyObject(i) ? 1.0f : 0.0f);
    unsure_.assign(pixels, 0.0f);
  }

  MatCut Run() {
    LearnBesideMat();
    MeasureEdges();
    for (int i = 0; i < kCuts; ++i) {
      if (!LearnObject()) break;
      Solve();
    }
    MatCut cut;
    cut.inside = cut.unsure = core::FloatImage(width_, height_, 1);
    cut.inside.values = std::move(inside_);
    cut.unsure.values = std::move(unsure_);
    return cut;
  }

 private:
  std::size_t At(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }
  bool OnMat(std::size_t i) const { return evidence_.difference.values[i] >= 0.0f; }

  bool LikelyObject(std::size_t i) const {
    return labels_[i] == CutLabel::kLikelyObject || labels_[i] == CutLabel::kObject;
  }
  bool OnMargin(std::size_t i) const {
    return !evidence_.margin.empty() && evidence_.margin.values[i] > 0.0f;
  }

  // Learns the colours beside the mat: the page's margin apart, as its white is no wall's.
  void LearnBesideMat() {
    std::vector<Eigen::Vector3f> beside, margin;
    for (std::size_t i = 0; i < colors_.size(); ++i) {
      if (OnMat(i) || LikelyObject(i)) continue;
      (OnMargin(i) ? margin : beside).push_back(colors_[i]);
    }
    if (beside.size() >= kLeastSample) beside_.emplace(beside);
    if (margin.size() >= kLeastSample) margin_.emplace(margin);
  }

  bool LearnObject() {
    std::vector<Eigen::Vector3f> sample;
    for (std::size_t i = 0; i < colors_.size(); ++i) {
      if (inside_[i] > 0.0f) sample.push_back(colors_[i]);
    }
    if (sample.size() < kLeastSample) return others_ != nullptr;
    object_.emplace(sample);
    return true;
  }

  // Returns the squared change of colour from a pixel to its neighbour that the mat's pattern does
  // not explain.
  float Change(std::size_t a, std::size_t b) const {
    const float seen = (colors_[a] - colors_[b]).squaredNorm();
    if (!OnMat(a) || !OnMat(b)) return seen;
    // Under a shadow the pattern changes less.
    const Eigen::Vector3f pattern = expected_[a] - expected_[b];
    const Eigen::Vector3f change = colors_[a] - colors_[b];
    const float squared = pattern.squaredNorm();
    const float light =
        squared > 0.0f ? std::clamp(change.dot(pattern) / squared, 0.0f, 1.0f) : 0.0f;
    return (change - light * pattern).squaredNorm();
  }

  void MeasureEdges() {
    double sum = 0.0;
    std::size_t count = 0;
    for (int y = 0; y + 1 < height_; ++y) {
      for (int x = 0; x + 1 < width_; ++x) {
        sum += Change(At(x, y), At(x + 1, y)) + Change(At(x, y), At(x, y + 1));
        count += 2;
      }
    }
    beta_ = sum > 0.0 ? static_cast<float>(0.5 * static_cast<double>(count) / sum) : 0.0f;
  }

  float BackgroundCost(std::size_t i) const {
    if (!OnMat(i)) {
      const std::optional<ColorMixture>& mixture = OnMargin(i) && margin_ ? margin_ : beside_;
      return mixture ? mixture->Cost(colors_[i]) : kUniformCost;
    }
    const float difference = std::min(evidence_.difference.values[i], kMostDifference);
    const float pattern = evidence_.pattern.values[i];
    const float evidence =
        pattern == 0.0f ? 0.0f : kPatternWeight * (kUsualPattern - std::max(pattern, 0.0f));
    // Three channels with the differences' noise.
    const float normalisation =
        3.0f * std::log(kMatNoise * std::sqrt(2.0f * std::numbers::pi_v<float>));
    return normalisation + 1.5f * difference * difference + evidence;
  }

  float ObjectCost(std::size_t i) const {
    if (others_ == nullptr) return object_->Cost(colors_[i]);
    const float others = others_->Cost(colors_[i]);
    return object_ ? std::min(object_->Cost(colors_[i]), others) : others;
  }

  void Solve() {
    const int pixels = width_ * height_;
    cv::detail::GCGraph<float> graph(static_cast<unsigned>(pixels),
                                     static_cast<unsigned>(2 * kNeighbors.size() * pixels));
    unsure_.assign(colors_.size(), 0.0f);
    for (std::size_t i = 0; i < colors_.size(); ++i) {
      graph.addVtx();
      float background = BackgroundCost(i), object = ObjectCost(i);
      const bool certain = labels_[i] == CutLabel::kBackground || labels_[i] == CutLabel::kObject;
      if (!certain && OnMat(i)) unsure_[i] = std::abs(background - object) < kUnsure;
      if (labels_[i] == CutLabel::kBackground) object += kCertain;
      if (labels_[i] == CutLabel::kObject) background += kCertain;
      // Costs are positive after adding the same to both.
      const float least = std::min(background, object);
      graph.addTermWeights(static_cast<int>(i), background - least, object - least);
    }
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        for (const Neighbor& n : kNeighbors) {
          const int u = x + n.dx, v = y + n.dy;
          if (u < 0 || u >= width_ || v >= height_) continue;
          const float weight =
              kSmoothness * n.closeness * std::exp(-beta_ * Change(At(x, y), At(u, v)));
          graph.addEdges(static_cast<int>(At(x, y)), static_cast<int>(At(u, v)), weight, weight);
        }
      }
    }
    graph.maxFlow();
    for (int i = 0; i < pixels; ++i) {
      inside_[static_cast<std::size_t>(i)] = graph.inSourceSegment(i) ? 1.0f : 0.0f;
    }
  }

  const MatEvidence& evidence_;
  const std::vector<CutLabel>& labels_;
  const ColorMixture* others_;
  int width_, height_;
  std::vector<Eigen::Vector3f> colors_, expected_;  // RGB in [0, 255]
  std::optional<ColorMixture> object_, beside_, margin_;
  float beta_ = 0.0f;
  std::vector<float> inside_, unsure_;
};

}  // namespace

MatCut CutFromMat(const core::Image& photo, const MatEvidence& evidence,
                  const std::vector<CutLabel>& labels, const ColorMixture* others) {
  const auto fits = [&](int width, int height) {
    return width == photo.width && height == photo.height;
  };
  if (photo.channels < 3) throw core::Error("the photo has no colours", "cut on the mat");
  if (photo.width < 2 || photo.height < 2)
    throw core::Error("the photo is empty", "cut on the mat");
  if (labels.size() != static_cast<std::size_t>(photo.width) * photo.height ||
      !fits(evidence.expected.width, evidence.expected.height) ||
      !fits(evidence.difference.width, evidence.difference.height) ||
      !fits(evidence.pattern.width, evidence.pattern.height) ||
      (!evidence.margin.empty() && !fits(evidence.margin.width, evidence.margin.height))) {
    throw core::Error("photo, mat and labels differ in size", "cut on the mat");
  }
  return Cut(photo, evidence, labels, others).Run();
}

}  // namespace simwright::capture
