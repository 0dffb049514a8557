#include "scene/model/limited_classes.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "nn/noise.h"

namespace simwright::scene {
namespace {

constexpr int kMostTiltPasses = 60;
constexpr double kTiltTolerance = 1e-3;   // objects
constexpr double kLeastExpected = 1e-12;  // objects, in a ratio
constexpr double kLargestTilt = 1e12;     // of a limit's weight
constexpr double kLeastRowSum = 1e-30;    // of an entry's probabilities

}  // namespace

// The numbers of objects of each limit while the entries of a scene are decided one by one.
class LimitedClasses::Counter {
 public:
  Counter(const SceneLimits& scene, const std::int64_t* noisy, std::int64_t entries, int mask)
      : scene_(scene), counts_(scene.limits.size(), 0) {
    for (std::int64_t i = 0; i < entries; ++i) {
      if (noisy[i] == mask) {
        ++open_;
      } else if (const int limit = scene.limit_of[static_cast<size_t>(noisy[i])]; limit >= 0) {
        ++counts_[static_cast<size_t>(limit)];
      }
    }
    for (size_t i = 0; i < counts_.size(); ++i) missing_ += Missing(i);
  }

  int Missing(size_t limit) const {
    return std::max(0, scene_.limits[limit].least - counts_[limit]);
  }
  int Room(size_t limit) const { return std::max(0, scene_.limits[limit].most - counts_[limit]); }

  // Returns true if a masked entry may become `index` so that the limits can still be met.
  bool Allows(std::int64_t index) const {
    const int limit = scene_.limit_of[static_cast<size_t>(index)];
    if (limit >= 0 && Room(static_cast<size_t>(limit)) == 0) return false;
    const bool is_missing = limit >= 0 && Missing(static_cast<size_t>(limit)) > 0;
    return is_missing || open_ > missing_;
  }
  void Add(std::int64_t index) {
    --open_;
    const int limit = scene_.limit_of[static_cast<size_t>(index)];
    if (limit < 0) return;
    if (Missing(static_cast<size_t>(limit)) > 0) --missing_;
    ++counts_[static_cast<size_t>(limit)];
  }

 private:
  const SceneLimits& scene_;
  std::vector<int> counts_;
  int missing_ = 0, open_ = 0;  // objects that limits still need; masked entries
};

LimitedClasses::LimitedClasses(std::vector<std::vector<ClassLimit>> limits, int classes)
    : classes_(classes) {
  for (std::vector<ClassLimit>& of_scene : limits) {
    std::string error;
    if (!AreValid(of_scene, classes, &error)) throw core::Error(error);
    SceneLimits scene{std::move(of_scene), std::vector<int>(static_cast<size_t>(classes), -1), {}};
    for (size_t i = 0; i < scene.limits.size(); ++i) {
      for (const int index : scene.limits[i].classes) {
        scene.limit_of[static_cast<size_t>(index)] = static_cast<int>(i);
      }
    }
    size_t next = scene.limits.size();
    for (const int limit : scene.limit_of) {
      scene.weight_of.push_back(limit >= 0 ? static_cast<size_t>(limit) : next++);
    }
    scenes_.push_back(std::move(scene));
  }
}

torch::Tensor LimitedClasses::Tilt(const torch::Tensor& probabilities,
                                   const torch::Tensor& noisy) const {
  const std::int64_t entries = noisy.size(1);
  if (noisy.size(0) != static_cast<std::int64_t>(scenes_.size())) {
    throw core::Error("there must be limits of classes for each scene of the batch");
  }
  const torch::Tensor classes = noisy.cpu().contiguous();
  torch::Tensor tilted = probabilities.cpu().to(torch::kFloat).contiguous().clone();
  for (size_t i = 0; i < scenes_.size(); ++i) {
    if (scenes_[i].limits.empty()) continue;
    const auto first = static_cast<std::int64_t>(i) * entries;
    TiltScene(scenes_[i], classes.data_ptr<std::int64_t>() + first, entries,
              tilted.data_ptr<float>() + first * classes_);
  }
  return tilted.to(probabilities.device());
}

// Iterative proportional fitting: each limit, and each class without one, has a weight, by which
// the probabilities of its classes are multiplied before those of an entry are normalised. The
// weights are set in turn, so that the expected number is within its limit, or as predicted.
void LimitedClasses::TiltScene(const SceneLimits& scene, const std::int64_t* noisy,
                               std::int64_t entries, float* probabilities) const {
  const Counter counter(scene, noisy, entries, classes_);
  const size_t limits = scene.limits.size(), empty = scene.weight_of.back(), columns = empty + 1;
  std::vector<float*> rows;
  for (std::int64_t i = 0; i < entries; ++i) {
    if (noisy[i] == classes_) rows.push_back(probabilities + i * classes_);
  }
  // The probabilities of each weight's classes by entry, and their sums over entries.
  std::vector<double> parts(rows.size() * columns, 0.0), predicted(columns, 0.0);
  std::vector<double> weights(columns, 1.0), sums(rows.size(), 0.0);
  for (size_t r = 0; r < rows.size(); ++r) {
    for (int k = 0; k < classes_; ++k) {
      const size_t column = scene.weight_of[static_cast<size_t>(k)];
      const auto p = static_cast<double>(rows[r][k]);
      parts[r * columns + column] += p;
      predicted[column] += p;
      sums[r] += p;
    }
  }
  for (int pass = 0; pass < kMostTiltPasses; ++pass) {
    double largest = 0.0;
    for (size_t g = 0; g < empty; ++g) {
      double expected = 0.0;
      for (size_t r = 0; r < rows.size(); ++r) {
        expected += weights[g] * parts[r * columns + g] / std::max(sums[r], kLeastRowSum);
      }
      const double wanted = g < limits
                                ? std::clamp(expected, static_cast<double>(counter.Missing(g)),
                                             static_cast<double>(counter.Room(g)))
                                : predicted[g];
      largest = std::max(largest, std::abs(wanted - expected));
      if (wanted == expected) continue;
      const double before = weights[g];
      weights[g] = std::min(before * wanted / std::max(expected, kLeastExpected), kLargestTilt);
      for (size_t r = 0; r < rows.size(); ++r) {
        sums[r] += (weights[g] - before) * parts[r * columns + g];
      }
    }
    if (largest < kTiltTolerance) break;
  }
  for (size_t r = 0; r < rows.size(); ++r) {
    if (sums[r] <= kLeastRowSum) continue;  // no class is left: Hold decides
    for (int k = 0; k < classes_; ++k) {
      const double weight = weights[scene.weight_of[static_cast<size_t>(k)]];
      rows[r][k] = static_cast<float>(static_cast<double>(rows[r][k]) * weight / sums[r]);
    }
  }
}

void LimitedClasses::Hold(const torch::Tensor& before, const torch::Tensor& tilted, bool last,
                          const at::Generator& generator, torch::Tensor* drawn) const {
  const std::int64_t entries = before.size(1);
  const torch::Tensor classes = before.cpu().contiguous();
  const torch::Tensor probabilities = tilted.cpu().contiguous();
  const torch::Tensor uniform = nn::UniformNumbers({before.size(0), entries}, generator).cpu();
  torch::Tensor held = drawn->cpu().contiguous().clone();
  for (size_t i = 0; i < scenes_.size(); ++i) {
    if (scenes_[i].limits.empty()) continue;
    const auto first = static_cast<std::int64_t>(i) * entries;
    HoldScene(scenes_[i], classes.data_ptr<std::int64_t>() + first,
              probabilities.data_ptr<float>() + first * classes_, uniform.data_ptr<float>() + first,
              last, entries, held.data_ptr<std::int64_t>() + first);
  }
  *drawn = held.to(drawn->device());
}

void LimitedClasses::HoldScene(const SceneLimits& scene, const std::int64_t* before,
                               const float* tilted, const float* uniform, bool last,
                               std::int64_t entries, std::int64_t* drawn) const {
  Counter counter(scene, before, entries, classes_);
  std::vector<double> allowed(static_cast<size_t>(classes_));
  for (std::int64_t i = 0; i < entries; ++i) {
    if (before[i] != classes_) {
      drawn[i] = before[i];
      continue;
    }
    if (drawn[i] == classes_) continue;
    if (!counter.Allows(drawn[i])) {
      if (!last) {
        drawn[i] = classes_;
        continue;
      }
      double sum = 0.0;
      for (int k = 0; k < classes_; ++k) {
        const double p = counter.Allows(k) ? static_cast<double>(tilted[i * classes_ + k]) : 0.0;
        allowed[static_cast<size_t>(k)] = sum += p;
      }
      // Without an allowed class, the limits cannot be met, and the drawn one stays.
      const double at = static_cast<double>(uniform[i]) * sum;
      for (int k = 0; k < classes_ && sum > 0.0; ++k) {
        if (allowed[static_cast<size_t>(k)] <= at) continue;
        drawn[i] = k;
        break;
      }
    }
    counter.Add(drawn[i]);
  }
}

}  // namespace simwright::scene
