#include "twin/camera_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "core/parallel.h"

namespace simwright::twin {
namespace {

constexpr double kNat = 0.08;  // of a score: the weight of a unit of log probability
constexpr double kWidestScale = 0.7, kScaleStep = 0.01;  // of the logarithm
constexpr double kPassShrink = 0.45;                     // of the steps from pass to pass
constexpr int kSearchGenerations = 12;
constexpr double kFarthestStep = 2.0;  // of a parabola's minimum, in steps

// The numbers of the camera along which the search goes.
enum class CameraNumber { kElevation, kFocal, kRoll };

struct SearchLine {
  CameraNumber number;
  double error;        // mean absolute, expected
  double least, most;  // of the first step
};

TableCamera MovedCamera(const TableCamera& camera, CameraNumber number, double by) {
  TableCamera moved = camera;
  switch (number) {
    case CameraNumber::kElevation:
      moved.elevation = std::clamp(camera.elevation + by, 0.06, 1.5);
      break;
    case CameraNumber::kFocal:
      moved.focal = std::clamp(camera.focal * std::exp(by), 0.31, 9.9);
      break;
    case CameraNumber::kRoll:
      moved.roll = std::clamp(camera.roll + by, -0.75, 0.75);
      break;
  }
  return moved;
}

double CameraImprobability(const TableCamera& camera, const TableCameraGuess& guess) {
  const auto nats = [](double off, double error) {
    return error > 0.0 ? std::abs(off) / error : 0.0;
  };
  return kNat * (nats(camera.elevation - guess.camera.elevation, guess.elevation_error) +
                 nats(camera.roll - guess.camera.roll, guess.roll_error) +
                 nats(std::log(camera.focal / guess.camera.focal), guess.log_focal_error));
}

double LossOf(const FittedTable& table, const TableCameraGuess& guess) {
  std::vector<std::vector<TableFit>> alternatives;
  for (const TableFit& fit : table.fits) alternatives.push_back({fit});
  return ChooseScale(alternatives, guess.log_height_error).score +
         CameraImprobability(table.camera, guess);
}

// Returns the abscissa of the minimum of the parabola through (-1, a), (0, b), (1, c).
double ParabolaMinimum(double a, double b, double c) {
  const double curvature = a - 2.0 * b + c;
  if (curvature <= 1e-9) return a < c ? -1.0 : 1.0;
  return std::clamp(0.5 * (a - c) / curvature, -kFarthestStep, kFarthestStep);
}

}  // namespace

ScaleChoice ChooseScale(const std::vector<std::vector<TableFit>>& alternatives, double log_error) {
  const auto score_at = [&](double log_scale, std::vector<int>* choice) {
    double sum = log_error > 0.0 ? kNat * std::abs(log_scale) / log_error : 0.0;
    for (const std::vector<TableFit>& fits : alternatives) {
      int best = 0;
      for (int i = 1; i < static_cast<int>(fits.size()); ++i) {
        if (fits[static_cast<size_t>(i)].Score(log_scale) <
            fits[static_cast<size_t>(best)].Score(log_scale)) {
          best = i;
        }
      }
      sum += fits[static_cast<size_t>(best)].Score(log_scale);
      if (choice != nullptr) choice->push_back(best);
    }
    return sum;
  };
  ScaleChoice best;
  best.score = score_at(0.0, nullptr);
  if (log_error > 0.0) {
    for (double at = -kWidestScale; at <= kWidestScale; at += kScaleStep) {
      const double score = score_at(at, nullptr);
      if (score >= best.score) continue;
      best.score = score;
      best.log_scale = at;
    }
    int within = 0;
    for (double at = -kWidestScale; at <= kWidestScale; at += kScaleStep) {
      within += score_at(at, nullptr) < best.score + kNat ? 1 : 0;
    }
    best.error = 0.5 * kScaleStep * within;
  }
  score_at(best.log_scale, &best.choice);
  return best;
}

FittedTable SearchCamera(const library_fit::LibraryPrior& prior,
                         const std::vector<ObservedObject>& objects, int width, int height,
                         const TableCameraGuess& guess, std::vector<TableFit> fits, int passes,
                         const TableFitOptions& options, core::Progress* progress) {
  TableFitOptions refinement = options;
  refinement.generations = kSearchGenerations;
  FittedTable best;
  best.camera = guess.camera;
  best.fits = std::move(fits);
  // Returns the fits of `from`, refined for another camera.
  const auto refitted = [&](const FittedTable& from, const TableCamera& camera) {
    FittedTable table;
    table.camera = camera;
    table.fits = from.fits;
    const core::Camera before = from.camera.At(width, height), after = camera.At(width, height);
    core::ParallelFor(static_cast<int>(objects.size()), [&](int k) {
      TableFit& fit = table.fits[static_cast<size_t>(k)];
      fit = MovedToCamera(fit, before, after);
      RefineOnTable(prior, objects[static_cast<size_t>(k)], after, refinement, &fit);
    });
    table.loss = LossOf(table, guess);
    return table;
  };
  const std::array<SearchLine, 3> lines{
      SearchLine{CameraNumber::kElevation, guess.elevation_error, 0.03, 0.12},
      SearchLine{CameraNumber::kFocal, guess.log_focal_error, 0.05, 0.25},
      SearchLine{CameraNumber::kRoll, guess.roll_error, 0.01, 0.04}};
  best = refitted(best, best.camera);
  double shrink = 1.0;
  for (int pass = 0; pass < passes; ++pass, shrink *= kPassShrink) {
    for (const SearchLine& line : lines) {
      progress->Advance();
      if (line.error <= 0.0) continue;
      const double step = shrink * std::clamp(1.2 * line.error, line.least, line.most);
      const FittedTable middle = best;
      std::array<FittedTable, 2> sides;
      for (int side = 0; side < 2; ++side) {
        sides[static_cast<size_t>(side)] =
            refitted(middle, MovedCamera(middle.camera, line.number, side == 0 ? -step : step));
      }
      const double at = ParabolaMinimum(sides[0].loss, middle.loss, sides[1].loss);
      const FittedTable vertex =
          refitted(middle, MovedCamera(middle.camera, line.number, at * step));
      for (const FittedTable* table :
           {std::as_const(sides).data(), std::as_const(sides).data() + 1, &vertex}) {
        if (table->loss < best.loss) best = *table;
      }
    }
  }
  return best;
}

}  // namespace simwright::twin
