#include "scene/least_shift.h"

#include <algorithm>

namespace simwright::scene {

using Eigen::Vector3d;

double LeastShift(const std::vector<char>& fixed, const LeastShiftOptions& options,
                  std::vector<SeparationRow>* rows, std::vector<Vector3d>* shifts) {
  shifts->assign(fixed.size(), Vector3d::Zero());
  const auto push = [&](const SeparationRow& row, double pressure) {
    const auto a = static_cast<size_t>(row.a), b = static_cast<size_t>(row.b);
    if (!fixed[a]) (*shifts)[a] -= pressure * row.normal;
    if (!fixed[b]) (*shifts)[b] += pressure * row.normal;
  };
  for (const SeparationRow& row : *rows) push(row, row.pressure);
  double worst = 0.0;
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    worst = 0.0;
    double largest = 0.0;  // change, m
    for (SeparationRow& row : *rows) {
      const auto a = static_cast<size_t>(row.a), b = static_cast<size_t>(row.b);
      const double free = (fixed[a] ? 0.0 : 1.0) + (fixed[b] ? 0.0 : 1.0);
      if (free == 0.0) continue;
      const double now = row.normal.dot((*shifts)[b] - (*shifts)[a]);
      const double missing = row.least - now;
      worst = std::max(worst, missing);
      const double before = row.pressure;
      const double wanted =
          before + (missing - options.compliance * before) / (free + options.compliance);
      row.pressure = std::max(0.0, wanted);
      push(row, row.pressure - before);
      largest = std::max(largest, std::abs(row.pressure - before));
    }
    if (largest < options.tolerance) break;
  }
  return worst;
}

}  // namespace simwright::scene
