#include "twin/camera_guess.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "library_fit/fit_kinds.h"
#include "twin/table_pose.h"

namespace simwright::twin {
namespace {

using library_fit::KindPrediction;

constexpr int kViewedKinds = 3;  // of an object, the most probable
constexpr double kLowestElevation = 4.0, kHighestElevation = 80.0, kElevationStep = 0.5;  // deg
constexpr double kLeastViewError = 0.03;  // rad, of an object's elevation
constexpr double kFarOff = 3.0;           // expected errors beyond which an object does not count
constexpr double kHiddenWeight = 0.4;     // of an object that is partly hidden
constexpr double kLeastElevationError = 0.035;  // rad, of the answer
constexpr double kLeastHeightError = 0.12;      // of the logarithm
constexpr double kRadian = M_PI / 180.0;

// The prior's answer for one object.
struct SeenObject {
  Eigen::Vector2d middle;  // pixels of the photo
  double weight = 1.0;
  std::vector<KindPrediction> kinds;
};

std::vector<SeenObject> SeeObjects(const std::vector<ObservedObject>& objects,
                                   const std::vector<std::vector<int>>& kinds,
                                   const library_fit::LibraryPrior& prior) {
  std::vector<SeenObject> seen(objects.size());
  core::ParallelFor(static_cast<int>(objects.size()), [&](int i) {
    const auto at = static_cast<size_t>(i);
    const std::vector<double> odds = prior.KindProbabilities(objects[at].prior_crop);
    std::vector<int> likely = at < kinds.size() ? kinds[at] : std::vector<int>();
    if (likely.empty()) {
      for (int kind = 0; kind < static_cast<int>(odds.size()); ++kind) likely.push_back(kind);
    }
    std::stable_sort(likely.begin(), likely.end(), [&](int a, int b) {
      return odds[static_cast<size_t>(a)] > odds[static_cast<size_t>(b)];
    });
    likely.resize(std::min<size_t>(likely.size(), kViewedKinds));
    seen[at] = {objects[at].box.center(), objects[at].hidden ? kHiddenWeight : 1.0,
                prior.Predict(objects[at].prior_crop, likely)};
    double sum = 0.0;
    for (const KindPrediction& kind : seen[at].kinds) sum += kind.probability;
    for (KindPrediction& kind : seen[at].kinds) kind.probability /= std::max(1e-9, sum);
  });
  return seen;
}

// Returns the angle (rad) below the horizon under which a camera sees a pixel.
double ElevationOf(const core::Camera& camera, const Eigen::Vector2d& pixel) {
  return -std::asin(std::clamp(camera.Ray(pixel).normalized().z(), -1.0, 1.0));
}

void GuessElevation(const std::vector<SeenObject>& objects, int width, int height,
                    TableCameraGuess* guess) {
  const TableCameraGuess before = *guess;
  double least = 1e9, information = 0.0;
  for (double degrees = kLowestElevation; degrees <= kHighestElevation; degrees += kElevationStep) {
    TableCamera candidate = before.camera;
    candidate.elevation = degrees * kRadian;
    const core::Camera camera = candidate.At(width, height);
    double cost = std::abs(candidate.elevation - before.camera.elevation) / before.elevation_error;
    for (const SeenObject& object : objects) {
      const double elevation = ElevationOf(camera, object.middle);
      for (const KindPrediction& kind : object.kinds) {
        const double error = std::max(kLeastViewError, kind.errors[3]);
        cost += object.weight * kind.probability *
                std::min(kFarOff, std::abs(elevation - kind.numbers[3]) / error);
      }
    }
    if (cost >= least) continue;
    least = cost;
    guess->camera.elevation = candidate.elevation;
  }
  for (const SeenObject& object : objects) {
    for (const KindPrediction& kind : object.kinds) {
      const double error = std::max(kLeastViewError, kind.errors[3]);
      information += object.weight * kind.probability / (error * error);
    }
  }
  guess->elevation_error = std::min(
      before.elevation_error, std::max(kLeastElevationError, 1.0 / std::sqrt(information + 1e-9)));
}

// Returns the weighted median.
double MedianOf(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  double sum = 0.0, below = 0.0;
  for (const auto& [value, weight] : values) sum += weight;
  for (const auto& [value, weight] : values) {
    below += weight;
    if (2.0 * below >= sum) return value;
  }
  return values.back().first;
}

void GuessHeight(const std::vector<SeenObject>& seen, const std::vector<ObservedObject>& objects,
                 int width, int height, TableCameraGuess* guess) {
  TableCamera unit = guess->camera;
  unit.height = 1.0;
  const core::Camera camera = unit.At(width, height);
  std::vector<std::pair<double, double>> heights;  // logarithms, weights
  for (size_t k = 0; k < seen.size(); ++k) {
    for (const KindPrediction& kind : seen[k].kinds) {
      const auto [instance, view] = library_fit::LikeliestInstance(kind);
      const double scale =
          PoseFromBox(library_fit::InstanceMesh(instance).mesh, 0.0, camera, objects[k].box).scale;
      if (!(scale > 1e-3 && scale < 1e3)) continue;
      const double error = std::max(0.05, (kind.errors[0] + kind.errors[1] + kind.errors[2]) / 3.0);
      heights.emplace_back(-std::log(scale), seen[k].weight * kind.probability / error);
    }
  }
  if (heights.empty()) return;
  const double middle = MedianOf(heights);
  for (auto& [value, weight] : heights) value = std::abs(value - middle);
  guess->camera.height = std::clamp(std::exp(middle), 0.06, 15.0);
  guess->log_height_error = std::max(
      kLeastHeightError, 1.5 * MedianOf(heights) / std::sqrt(static_cast<double>(seen.size())));
}

}  // namespace

TableCameraGuess GuessByObjects(const std::vector<ObservedObject>& objects,
                                const std::vector<std::vector<int>>& kinds,
                                const library_fit::LibraryPrior& prior, int width, int height,
                                const TableCameraGuess& guess) {
  TableCameraGuess better = guess;
  if (objects.empty() || (guess.elevation_error <= 0.0 && guess.log_height_error <= 0.0)) {
    return better;
  }
  const std::vector<SeenObject> seen = SeeObjects(objects, kinds, prior);
  if (guess.elevation_error > 0.0) GuessElevation(seen, width, height, &better);
  if (guess.log_height_error > 0.0) GuessHeight(seen, objects, width, height, &better);
  return better;
}

}  // namespace simwright::twin
