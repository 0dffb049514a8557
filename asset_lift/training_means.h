#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "asset_lift/prior_training.h"

namespace simwright::asset_lift {

// Sums what each step of a training says, and reports the means every 50 steps and at the end.
class TrainingMeans {
 public:
  TrainingMeans(std::vector<std::string> metrics, int steps, const PriorTrainingListener& listener)
      : names_(std::move(metrics)), sums_(names_.size(), 0.0), steps_(steps), listener_(listener) {}

  // `metrics` as many as named.
  void Add(int step, double loss, const std::vector<double>& metrics) {
    loss_ += loss;
    for (size_t i = 0; i < sums_.size(); ++i) sums_[i] += metrics[i];
    ++count_;
    if ((step + 1) % 50 != 0 && step + 1 != steps_) return;
    last_ = {step + 1, loss_ / count_, {}, 0.0};
    last_.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    for (size_t i = 0; i < sums_.size(); ++i)
      last_.metrics.emplace_back(names_[i], sums_[i] / count_);
    if (listener_) listener_(last_);
    sums_.assign(names_.size(), 0.0);
    loss_ = 0.0;
    count_ = 0;
  }

  const PriorTrainingReport& last() const { return last_; }

 private:
  std::vector<std::string> names_;
  std::vector<double> sums_;
  int steps_;
  const PriorTrainingListener& listener_;
  double loss_ = 0.0;
  int count_ = 0;
  PriorTrainingReport last_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace simwright::asset_lift
