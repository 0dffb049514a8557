#include "rl/reward_scaler.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace simwright::rl {

RewardScaler::RewardScaler(int environments, double discount)
    : discount_(discount), discounted_returns_(static_cast<std::size_t>(environments), 0.0) {}

void RewardScaler::Scale(const std::vector<std::uint8_t>& ended,
                         const std::vector<std::uint8_t>& dropped, std::vector<float>* rewards) {
  Rows returns(static_cast<Eigen::Index>(rewards->size()), 1);
  for (std::size_t i = 0; i < rewards->size(); ++i) {
    if (!dropped[i]) {
      discounted_returns_[i] = discount_ * discounted_returns_[i] + (*rewards)[i];
    }
    // The moments leave out rows that are not finite.
    returns(static_cast<Eigen::Index>(i), 0) = dropped[i]
                                                   ? std::numeric_limits<float>::quiet_NaN()
                                                   : static_cast<float>(discounted_returns_[i]);
  }
  moments_.Add(returns);
  const auto factor = static_cast<float>(1.0 / std::sqrt(moments_.Variance()[0] + 1e-8));
  for (std::size_t i = 0; i < rewards->size(); ++i) {
    (*rewards)[i] = dropped[i] ? 0.0f : std::clamp((*rewards)[i] * factor, -kLimit, kLimit);
    if (ended[i] || dropped[i]) discounted_returns_[i] = 0.0;
  }
}

void RewardScaler::Restore(const RunningMoments& moments,
                           const std::vector<double>& discounted_returns) {
  moments_ = moments;
  discounted_returns_ = discounted_returns;
}

}  // namespace simwright::rl
