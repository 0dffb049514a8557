#pragma once

#include <vector>

#include <Eigen/Core>

#include "robot/joint_limits.h"
#include "robot/path_limits.h"
#include "robot/path_speed.h"
#include "robot/time_law.h"

namespace simwright::robot {

constexpr int kTimeLawLevels = 6;  // of knots, each with half the spacing of the one before

// Returns the number of steps of the search's grid for a path of `length`; the knots, where jerk
// peaks, lie on the grid.
Eigen::Index TimeLawGrid(double length);

// A value over its limit between the points of the grid.
struct LimitPeak {
  double from = 0.0, to = 0.0;  // it lies between these parameters
  double ratio = 1.0;           // value over limit
};

// Searches a time law that keeps velocity, acceleration and jerk on the grid within a share of the
// limits and is locally optimal: it starts from the fastest law that velocity and acceleration
// allow, raises it where a limit is exceeded, then lowers it on stretches of decreasing length
// while all limits hold, on levels of knots, each with half the spacing of the previous one. The
// finer the knots, the more jerk may peak between the points of the grid.
class TimeLawSearch {
 public:
  // `path`, on TimeLawGrid(length) steps, must outlive this object. `fastest` (points): how many
  // times as fast as recorded the path may run.
  TimeLawSearch(const PathDerivatives& path, double length, const std::vector<JointLimits>& limits,
                std::vector<double> fastest);

  // Starts a search, without the `coarser` finest levels. Returns false if no law was found: then
  // law() is the slowest that was tried.
  bool Find(double share, int coarser = 0);
  // Lowers the share around the peaks of the found law, so that they fall to the share that was
  // asked for, and slows the law accordingly. Returns false as Find does.
  bool Tighten(const std::vector<LimitPeak>& peaks);

  const TimeLaw& law() const { return law_; }

 private:
  // Coefficients that are lowered together.
  struct Stretch {
    std::size_t first, count;
  };

  std::size_t intervals() const;
  Eigen::Index EndOf(std::size_t interval) const;
  TimeLaw::Slowness SlownessAt(std::size_t interval, Eigen::Index point) const;
  bool SearchAll(int last, double longest);
  bool SearchFrom(int first, int last, double longest);
  void SetLevel(int level, int last);
  void CountAllPoints(int last);
  void FindLeast();
  void Begin();
  bool MeetLimits();
  bool Raise();
  double FindRaises(const std::vector<char>& changed, std::vector<double>* factors) const;
  void Lower(long since, std::size_t first_factor);
  bool Repair();
  bool TryLower(Stretch stretch, double factor);
  bool HoldsOn(std::size_t first, std::size_t last);
  long LastChange(Stretch stretch) const;

  const PathDerivatives& path_;
  std::vector<JointLimits> limits_;
  PathLimits path_limits_;
  std::vector<double> fastest_;  // (points)
  std::vector<double> shares_;   // (points) of the limits
  double share_ = 1.0;
  double least_seconds_ = 0.0;  // without jerk
  double first_seconds_ = 0.0;  // of the law on the first level of the last search
  TimeLaw law_;
  std::vector<double> least_;           // lower bound of each coefficient
  Eigen::Index per_interval_ = 1;       // points
  Eigen::Index stride_ = 1;             // every stride_-th point counts
  std::vector<TimeLaw::Basis> bases_;   // (per_interval_ + 1)
  std::vector<Eigen::Index> blocking_;  // by interval: the point that last stopped a lowering
  std::vector<long> changes_;           // by coefficient: the count of changes at its last one
  long change_ = 0;
};

}  // namespace simwright::robot
