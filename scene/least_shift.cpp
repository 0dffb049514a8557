#include "scene/least_shift.h"

#include <algorithm>

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

// Of each step on a row. Any below 2 converges (Cryer 1971).
constexpr double kOverRelaxation = 1.4;
constexpr int kSweepsBetween = 10;  // over the rows that press, between two over all

// Gauss and Seidel on the dual, one row after the other.
class DualSweeps {
 public:
  DualSweeps(const std::vector<char>& fixed, const LeastShiftOptions& options,
             std::vector<SeparationRow>* rows, std::vector<Vector3d>* shifts)
      : options_(options), rows_(*rows), shifts_(*shifts) {
    shifts_.assign(fixed.size(), Vector3d::Zero());
    for (const char body : fixed) free_.push_back(body ? 0.0 : 1.0);
    for (const SeparationRow& row : rows_) Push(row, row.pressure);
  }

  // m that the worst row is short of.
  double Run() {
    for (int sweep = 0; sweep < options_.sweeps; sweep += kSweepsBetween) {
      pressing_.clear();
      largest_ = 0.0;
      for (size_t i = 0; i < rows_.size(); ++i) {
        Relax(&rows_[i]);
        if (rows_[i].pressure > 0.0) pressing_.push_back(i);
      }
      if (largest_ < options_.tolerance) break;
      bool bounded = true;
      for (int k = 1; k < kSweepsBetween && largest_ >= options_.tolerance; ++k) {
        largest_ = 0.0;
        for (const size_t i : pressing_) Relax(&rows_[i]);
      }
      for (const size_t i : pressing_) bounded = bounded && rows_[i].pressure < options_.unbounded;
      if (!bounded) break;
    }
    double worst = 0.0;
    for (const SeparationRow& row : rows_) {
      if (Free(row) > 0.0) worst = std::max(worst, Missing(row));
    }
    return worst;
  }

 private:
  double Free(const SeparationRow& row) const {
    return free_[static_cast<size_t>(row.a)] + free_[static_cast<size_t>(row.b)];
  }
  double Missing(const SeparationRow& row) const {
    return row.least - row.normal.dot(shifts_[static_cast<size_t>(row.b)] -
                                      shifts_[static_cast<size_t>(row.a)]);
  }
  void Push(const SeparationRow& row, double pressure) {
    const auto a = static_cast<size_t>(row.a), b = static_cast<size_t>(row.b);
    shifts_[a] -= (free_[a] * pressure) * row.normal;
    shifts_[b] += (free_[b] * pressure) * row.normal;
  }
  void Relax(SeparationRow* row) {
    const double free = Free(*row);
    if (free == 0.0) return;
    const double before = row->pressure;
    const double step =
        (Missing(*row) - options_.compliance * before) / (free + options_.compliance);
    row->pressure = std::max(0.0, before + kOverRelaxation * step);
    const double change = row->pressure - before;
    if (change == 0.0) return;
    Push(*row, change);
    largest_ = std::max(largest_, std::abs(change));
  }

  const LeastShiftOptions& options_;
  std::vector<SeparationRow>& rows_;
  std::vector<Vector3d>& shifts_;
  std::vector<double> free_;  // 1 or 0
  std::vector<size_t> pressing_;
  double largest_ = 0.0;  // change of a pressure in a sweep, m
};

}  // namespace

double LeastShift(const std::vector<char>& fixed, const LeastShiftOptions& options,
                  std::vector<SeparationRow>* rows, std::vector<Vector3d>* shifts) {
  return DualSweeps(fixed, options, rows, shifts).Run();
}

}  // namespace simwright::scene
