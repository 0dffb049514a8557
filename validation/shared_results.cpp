#include "validation/shared_results.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::validation {

double InertialDifference(const assets::Inertial& a, const assets::Inertial& b, double size) {
  const double mass = std::abs(a.mass - b.mass) / b.mass;
  const double center = (a.center_of_mass - b.center_of_mass).norm() / size;
  const double inertia = (a.inertia - b.inertia).norm() / b.inertia.norm();
  return std::max({mass, center, inertia});
}

void AddResultOrFailure(const std::string& code, CheckResults* results,
                        const std::function<void()>& load) {
  try {
    load();
  } catch (const core::Error& error) {
    results->Fail(code, error.what());
  }
}

namespace {

// Returns true if a rolling body gains speed. It may keep or lose speed, or gain what its centre of
// mass fell by from edge to facet: v^2 <= v0^2 + 2 g h. One that gains more is driven by its
// contacts.
bool GainsSpeed(const sim::DropResult& drop) {
  constexpr double kNoise = 2e-3;  // m, rocking from facet to facet
  const double half = 0.5 * sim::DropOptions().drift_time;
  const double fallen = std::sqrt(2.0 * 9.81 * drop.fall) * half;
  return drop.late_drift > std::hypot(1.5 * drop.early_drift, fallen) + kNoise;
}

void AddRollingRow(const sim::DropResult& drop, const std::string& engine, double size,
                   const CheckLimits& limits, CheckResults* results) {
  const std::string code = "rolls-" + engine;
  if (GainsSpeed(drop)) {
    results->Fail(code, "it accelerates while rolling on a level floor");
    return;
  }
  results->AtMost(code, drop.drift / size, limits.rolling_drift,
                  "of its diagonal in 2 s; it is graded as a rolling body");
}

GradedLimit AllowedDrift(double size, const CheckLimits& limits) {
  GradedLimit allowed = limits.drift;
  allowed.worst = std::clamp(limits.drift_share * size, 2.0 * allowed.good, allowed.worst);
  return allowed;
}

void AddSinkingRow(const sim::DropResult& drop, const std::string& engine,
                   const CheckLimits& limits, CheckResults* results) {
  results->AtMost("sinks-" + engine, -drop.lowest_point * 1e3, InUnit(limits.sinking, 1e3),
                  "mm below the floor at rest");
}

void AddDriftRow(const sim::DropResult& drop, const std::string& engine, double size,
                 const CheckLimits& limits, CheckResults* results) {
  results->AtMost("drift-" + engine, drop.drift * 1e3, InUnit(AllowedDrift(size, limits), 1e3),
                  "mm in 2 s at rest");
}

void AddStandingRows(const sim::DropResult& drop, const std::string& engine, double size,
                     const CheckLimits& limits, CheckResults* results) {
  const core::Severity drift = SeverityAtMost(drop.drift, AllowedDrift(size, limits));
  const bool settles = drop.rests && drop.rest_time <= limits.rest_time;
  // A body that still moves after that is graded by its drift.
  results->Add("settles-" + engine,
               settles ? core::Severity::kInfo : std::max(core::Severity::kWarning, drift),
               drop.rest_time, "s until it is at rest, limit 2");
  results->AtMost("rest-pose-" + engine, drop.tilt * kDegrees, limits.tilt,
                  "degrees from its rest pose");
  AddDriftRow(drop, engine, size, limits, results);
}

}  // namespace

void AddRestResults(const sim::DropResult& drop, const std::string& engine, bool rolls, double size,
                    const CheckLimits& limits, CheckResults* results) {
  if (rolls) {
    AddRollingRow(drop, engine, size, limits, results);
  } else {
    AddStandingRows(drop, engine, size, limits, results);
  }
  AddSinkingRow(drop, engine, limits, results);
}

void AddRockingResults(const sim::DropResult& drop, const std::string& engine, double size,
                       const CheckLimits& limits, CheckResults* results) {
  results->Report("settles-" + engine, drop.rest_time, "s; no pose holds, so its drift is graded");
  results->AtMost("rest-pose-" + engine, drop.tilt * kDegrees, limits.rocking_tilt,
                  "degrees from its rest pose, which does not hold");
  AddDriftRow(drop, engine, size, limits, results);
  AddSinkingRow(drop, engine, limits, results);
}

}  // namespace simwright::validation
