#include "library_fit/fit_search.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "library_fit/cma_es.h"

namespace simwright::library_fit {
namespace {

// One standard deviation of the search, by dimension.
constexpr double kAzimuthStep = 0.25;    // rad
constexpr double kElevationStep = 0.12;  // rad
constexpr double kRollStep = 0.03;       // rad
constexpr double kNearnessStep = 0.25;   // of the logarithm
constexpr double kSizeStep = 0.15;       // of the logarithm
constexpr double kChoiceStep = 0.2;
constexpr int kViewNumbers = 4, kFixedNumbers = kViewNumbers + 3;

constexpr double kLowest = -0.15, kHighest = 1.45;  // rad, of the elevation
constexpr std::uint64_t kProbedSeeds = 8;
constexpr double kProbe = 0.02;          // step of a choice that tells continuous ones
constexpr double kChoiceWeight = 0.012;  // of the negative log probability of a choice
constexpr double kNumberWeight = 0.02;   // of a deviation of size, elevation or nearness
constexpr double kRollWeight = 0.02;     // of a squared deviation of the roll
constexpr double kUsualRoll = 0.04;      // rad

// Returns the value reflected into [0, 1].
double Reflected(double value) {
  const double turn = std::fmod(std::abs(value), 2.0);
  return std::min(turn <= 1.0 ? turn : 2.0 - turn, 1.0 - 1e-9);
}

double LogProbability(const std::vector<double>& bins, double share) {
  const auto count = static_cast<double>(bins.size());
  const auto bin = static_cast<size_t>(std::clamp(share * count, 0.0, count - 1.0));
  return std::log(bins[bin] * count + 1e-3);
}

bool SameVertices(const core::TriangleMesh& a, const core::TriangleMesh& b) {
  return a.vertices == b.vertices;
}

bool CanOpen(const FitPoint& point) {
  return FitKinds()[static_cast<size_t>(point.instance.kind)].opening > 0.0;
}

// Returns `start` moved by `x`, in units of the steps.
FitPoint Moved(const FitPoint& start, const std::vector<int>& choices, const Eigen::VectorXd& x) {
  FitPoint point = start;
  point.view.azimuth += kAzimuthStep * x[0];
  point.view.elevation =
      std::clamp(point.view.elevation + kElevationStep * x[1], kLowest, kHighest);
  point.view.roll += kRollStep * x[2];
  point.view.nearness = std::clamp(point.view.nearness * std::exp(kNearnessStep * x[3]),
                                   kLeastNearness, kMostNearness);
  for (int i = 0; i < 3; ++i) {
    point.instance.size[i] *= std::exp(kSizeStep * std::clamp(x[kViewNumbers + i], -8.0, 8.0));
  }
  for (size_t i = 0; i < choices.size(); ++i) {
    double& draw = point.instance.draws[static_cast<size_t>(choices[i])];
    draw = Reflected(draw + kChoiceStep * x[kFixedNumbers + static_cast<Eigen::Index>(i)]);
  }
  if (CanOpen(start)) {
    point.instance.opening = Reflected(point.instance.opening + kChoiceStep * x[x.size() - 1]);
  }
  return point;
}

}  // namespace

FitSearch::FitSearch(const KindPrediction& prediction, const FitTarget& target)
    : prediction_(prediction), target_(target) {
  // Their number depends on the choices themselves.
  for (std::uint64_t seed = 1; seed <= kProbedSeeds; ++seed) {
    choices_ = std::max(choices_, SampleInstance(prediction.kind, seed).draws.size());
  }
  choices_ = std::min(choices_, prediction.choices.size());
}

double FitSearch::Improbability(const FitPoint& point) const {
  double sum = 0.0;
  for (size_t i = 0; i < choices_; ++i) {
    sum -= kChoiceWeight * LogProbability(prediction_.choices[i], point.instance.draws[i]);
  }
  const std::array<double, 5> values{
      std::log(point.instance.size[0]), std::log(point.instance.size[1]),
      std::log(point.instance.size[2]), point.view.elevation, point.view.nearness};
  for (size_t i = 0; i < values.size(); ++i) {
    const double least = i == 4 ? 0.02 : 0.05;
    const double off = std::abs(values[i] - prediction_.numbers[i]);
    sum += kNumberWeight * off / std::max(least, prediction_.errors[i]);
  }
  const double turn = std::fmod(point.view.azimuth / (2.0 * M_PI) + 4.0, 1.0);
  sum -= kChoiceWeight * LogProbability(prediction_.azimuth, turn);
  const double roll = point.view.roll / kUsualRoll;
  return sum + kRollWeight * roll * roll;
}

double FitSearch::Evaluate(FitPoint* point) const {
  point->agreement = CompareWithPhoto(InstanceMesh(point->instance), point->view, target_);
  point->loss = point->agreement.Loss() + Improbability(*point);
  return point->loss;
}

std::vector<FitPoint> FitSearch::Proposals(int proposals, int count, core::Rng* rng) const {
  std::vector<FitPoint> points(static_cast<size_t>(proposals));
  for (size_t i = 0; i < points.size(); ++i) {
    const auto [instance, view] =
        i == 0 ? LikeliestInstance(prediction_) : SampledInstance(prediction_, rng);
    points[i] = {instance, view, {}, 1e9};
    // Every other proposal keeps the likeliest size, which samples of three sides seldom match.
    if (i % 2 == 0) points[i].instance.size = LikeliestInstance(prediction_).first.size;
  }
  core::ParallelFor(proposals, [&](int i) { Evaluate(&points[static_cast<size_t>(i)]); });
  std::stable_sort(points.begin(), points.end(),
                   [](const FitPoint& a, const FitPoint& b) { return a.loss < b.loss; });
  points.resize(static_cast<size_t>(std::min(proposals, count)));
  return points;
}

std::vector<int> FitSearch::ContinuousChoices(const FitPoint& point) const {
  const core::TexturedMesh base = InstanceMesh(point.instance);
  std::vector<int> continuous;
  for (size_t i = 0; i < choices_; ++i) {
    Instance other = point.instance;
    other.draws[i] += other.draws[i] > 0.5 ? -kProbe : kProbe;
    const core::TexturedMesh mesh = InstanceMesh(other);
    // A choice of another number of parts is no continuous one.
    if (mesh.mesh.vertices.size() == base.mesh.vertices.size() &&
        !SameVertices(mesh.mesh, base.mesh)) {
      continuous.push_back(static_cast<int>(i));
    }
  }
  return continuous;
}

void FitSearch::Refine(int generations, double step, core::Rng* rng, FitPoint* point) const {
  CmaEsOptions options;
  options.generations = generations;
  options.step = step;
  Refine(
      [&](int dimensions, const std::function<double(const Eigen::VectorXd&)>& loss) {
        return MinimizeByCmaEs(loss, Eigen::VectorXd::Zero(dimensions), options, rng).best;
      },
      point);
}

void FitSearch::Refine(const FitMinimizer& minimizer, FitPoint* point) const {
  const std::vector<int> choices = ContinuousChoices(*point);
  const int dimensions =
      kFixedNumbers + static_cast<int>(choices.size()) + (CanOpen(*point) ? 1 : 0);
  const FitPoint start = *point;
  const Eigen::VectorXd best = minimizer(dimensions, [&](const Eigen::VectorXd& x) {
    FitPoint moved = Moved(start, choices, x);
    return Evaluate(&moved);
  });
  *point = Moved(start, choices, best);
  Evaluate(point);
}

void FitSearch::TryChoices(FitPoint* point) const {
  for (size_t i = 0; i < choices_; ++i) {
    const std::vector<double>& bins = prediction_.choices[i];
    const core::TexturedMesh base = InstanceMesh(point->instance);
    std::vector<FitPoint> others;
    for (size_t bin = 0; bin < bins.size(); ++bin) {
      FitPoint other = *point;
      other.instance.draws[i] = (static_cast<double>(bin) + 0.5) / static_cast<double>(bins.size());
      others.push_back(other);
    }
    core::ParallelFor(static_cast<int>(others.size()), [&](int k) {
      FitPoint& other = others[static_cast<size_t>(k)];
      const core::TexturedMesh mesh = InstanceMesh(other.instance);
      // A choice that changes nothing but colours needs no render.
      if (SameVertices(mesh.mesh, base.mesh) && mesh.triangle_material == base.triangle_material) {
        other.agreement = point->agreement;
        other.loss = other.agreement.Loss() + Improbability(other);
      } else {
        Evaluate(&other);
      }
    });
    for (const FitPoint& other : others) {
      if (other.loss < point->loss) *point = other;
    }
  }
}

}  // namespace simwright::library_fit
