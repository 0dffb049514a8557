#include "robot/tube_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "robot/quintic_spline.h"

namespace simwright::robot {
namespace {

constexpr int kBand = QuinticSpline::kSupport - 1;  // largest index difference of control points
                                                    // that interact
// The weight of the third differences relative to a sample's, with one knot per sample: it halves
// oscillations of 2.5 Hz in samples at 60 Hz (1 + kStiffness * (2 sin(pi f / 60))^6 = 2).
constexpr double kStiffness = 3000.0;
constexpr double kEndWeight = 1e10;   // of the first and the last sample: met up to rounding
constexpr double kMostWeight = 1e12;  // of any sample
constexpr int kRounds = 80;
constexpr double kAim = 0.9;  // share of the radius above which a sample's weight grows

// Returns the weight of the same penalty on the integral of the squared third derivative, for
// `fineness` knots per sample.
double StiffnessFor(double fineness) {
  return kStiffness * std::pow(fineness, 5);
}

class TubeFit {
 public:
  TubeFit(const std::vector<double>& times, const Eigen::VectorXd& values, double spacing,
          const Tube& tube)
      : values_(values),
        aims_(values.cwiseMax(tube.lower).cwiseMin(tube.upper)),
        tube_(tube),
        intervals_(std::llround(times.back() / spacing)),
        count_(intervals_ + kBand),
        stiffness_(
            StiffnessFor(static_cast<double>(intervals_) / static_cast<double>(values.size() - 1))),
        weights_(Eigen::VectorXd::Ones(values.size())),
        held_(static_cast<std::size_t>(count_), 0) {
    for (const double time : times) {
      bases_.push_back(QuinticSpline::At(time, spacing, intervals_, 0));
    }
    weights_[0] = weights_[weights_.size() - 1] = kEndWeight;
    penalty_ = Eigen::MatrixXd::Zero(kBand + 1, count_);
    constexpr double kThird[4] = {-1.0, 3.0, -3.0, 1.0};
    for (Eigen::Index i = 0; i + 3 < count_; ++i) {
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b <= a; ++b) penalty_(a - b, i + b) += stiffness_ * kThird[a] * kThird[b];
      }
    }
  }

  void SetWeights(const Eigen::VectorXd& weights) { weights_ = weights; }
  const Eigen::VectorXd& weights() const { return weights_; }
  Eigen::VectorXd Run();

 private:
  void Assemble();
  void Solve();
  void TakeOutHeld();
  bool HoldAtLimits();
  bool RaiseWeights();

  Eigen::VectorXd values_, aims_;  // (K) as given, and clamped to the limits
  Tube tube_;
  Eigen::Index intervals_, count_;
  double stiffness_;
  Eigen::VectorXd weights_;
  std::vector<int> held_;  // (count) -1 or 1: the control point is at its lower or upper limit
  std::vector<QuinticSpline::Basis> bases_;
  // (kBand + 1 x count): row k, column i is the element (i + k, i) of the penalty alone, of the
  // normal equations, and of their factors.
  Eigen::MatrixXd penalty_, band_, factors_;
  Eigen::VectorXd right_, controls_;
};

void TubeFit::Assemble() {
  band_ = penalty_;
  right_ = Eigen::VectorXd::Zero(count_);
  for (std::size_t s = 0; s < bases_.size(); ++s) {
    const auto& [first, basis] = bases_[s];
    const double weight = weights_[static_cast<Eigen::Index>(s)];
    const double aim = aims_[static_cast<Eigen::Index>(s)];
    for (int b = 0; b <= kBand; ++b) {
      const double weighted = weight * basis[static_cast<std::size_t>(b)];
      right_[first + b] += weighted * aim;
      double* column = band_.col(first + b).data();
      for (int a = b; a <= kBand; ++a)
        column[a - b] += weighted * basis[static_cast<std::size_t>(a)];
    }
  }
}

// Solves the normal equations by L D L' within the band. Held control points are known: their rows
// and columns leave the system.
void TubeFit::Solve() {
  factors_ = band_;
  controls_ = right_;
  if (std::any_of(held_.begin(), held_.end(), [](int held) { return held != 0; })) TakeOutHeld();
  for (Eigen::Index i = 0; i < count_; ++i) {
    double* column = factors_.col(i).data();
    const Eigen::Index below = std::min<Eigen::Index>(kBand, count_ - 1 - i);
    for (Eigen::Index k = 1; k <= below; ++k) {
      const double factor = column[k] / column[0];
      double* updated = factors_.col(i + k).data();
      for (Eigen::Index m = k; m <= below; ++m) updated[m - k] -= factor * column[m];
      controls_[i + k] -= factor * controls_[i];
    }
  }
  for (Eigen::Index i = count_ - 1; i >= 0; --i) {
    const double* column = factors_.col(i).data();
    const Eigen::Index below = std::min<Eigen::Index>(kBand, count_ - 1 - i);
    for (Eigen::Index k = 1; k <= below; ++k) controls_[i] -= column[k] * controls_[i + k];
    controls_[i] /= column[0];
  }
}

// Replaces the equations of held control points by their values.
void TubeFit::TakeOutHeld() {
  const auto is_held = [&](Eigen::Index i) { return held_[static_cast<std::size_t>(i)] != 0; };
  const auto limit = [&](Eigen::Index i) {
    return held_[static_cast<std::size_t>(i)] > 0 ? tube_.upper : tube_.lower;
  };
  for (Eigen::Index i = 0; i < count_; ++i) {
    for (Eigen::Index k = 1; k <= kBand && i + k < count_; ++k) {
      if (is_held(i)) controls_[i + k] -= factors_(k, i) * limit(i);
      if (is_held(i + k)) controls_[i] -= factors_(k, i) * limit(i + k);
      if (is_held(i) || is_held(i + k)) factors_(k, i) = 0.0;
    }
  }
  for (Eigen::Index i = 0; i < count_; ++i) {
    if (!is_held(i)) continue;
    factors_(0, i) = 1.0;
    controls_[i] = limit(i);
  }
}

// Holds control points that left the limits, and releases those that the fit would move inside.
// Returns true if anything changed.
bool TubeFit::HoldAtLimits() {
  Eigen::VectorXd pull = right_;  // minus half the gradient
  for (Eigen::Index i = 0; i < count_; ++i) {
    pull[i] -= band_(0, i) * controls_[i];
    for (Eigen::Index k = 1; k <= kBand && i + k < count_; ++k) {
      pull[i + k] -= band_(k, i) * controls_[i];
      pull[i] -= band_(k, i) * controls_[i + k];
    }
  }
  bool changed = false;
  for (Eigen::Index i = 0; i < count_; ++i) {
    int& held = held_[static_cast<std::size_t>(i)];
    const int before = held;
    if (held != 0 && held * pull[i] < 0.0) held = 0;
    if (before == 0 && controls_[i] > tube_.upper) held = 1;
    if (before == 0 && controls_[i] < tube_.lower) held = -1;
    changed = changed || held != before;
  }
  controls_ = controls_.cwiseMax(tube_.lower).cwiseMin(tube_.upper);
  return changed;
}

// Increases the weights of samples near or outside the tube's wall. Returns true if a sample is
// outside.
bool TubeFit::RaiseWeights() {
  bool outside = false;
  for (std::size_t s = 0; s < bases_.size(); ++s) {
    double miss = -values_[static_cast<Eigen::Index>(s)];
    for (int k = 0; k <= kBand; ++k) {
      miss += bases_[s].weights[static_cast<std::size_t>(k)] * controls_[bases_[s].first + k];
    }
    const double ratio = std::abs(miss) / tube_.radius;
    outside = outside || ratio > 1.0;
    if (ratio <= kAim) continue;
    double& weight = weights_[static_cast<Eigen::Index>(s)];
    weight = std::min(kMostWeight, weight * std::pow(ratio / kAim, 2) * 1.2);
  }
  return outside;
}

Eigen::VectorXd TubeFit::Run() {
  for (int round = 0; round < kRounds; ++round) {
    Assemble();
    for (int i = 0; i < 8; ++i) {
      Solve();
      if (!HoldAtLimits()) break;
    }
    if (!RaiseWeights()) return controls_;
  }
  return {};
}

}  // namespace

Eigen::VectorXd FitWithinTube(const std::vector<double>& times, const Eigen::VectorXd& values,
                              double spacing, const Tube& tube, Eigen::VectorXd* weights) {
  TubeFit fit(times, values, spacing, tube);
  if (weights->size() == values.size()) fit.SetWeights(*weights);
  Eigen::VectorXd controls = fit.Run();
  if (controls.size() > 0) *weights = fit.weights();
  return controls;
}

}  // namespace simwright::robot
