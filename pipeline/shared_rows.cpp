#include "pipeline/shared_rows.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::pipeline {

double InertialDifference(const assets::Inertial& a, const assets::Inertial& b, double size) {
  const double mass = std::abs(a.mass - b.mass) / b.mass;
  const double center = (a.center_of_mass - b.center_of_mass).norm() / size;
  const double inertia = (a.inertia - b.inertia).norm() / b.inertia.norm();
  return std::max({mass, center, inertia});
}

void RowOrFailure(const std::string& code, CheckRows* rows, const std::function<void()>& load) {
  try {
    load();
  } catch (const core::Error& error) {
    rows->Fail(code, error.what());
  }
}

void AddRestRows(const sim::DropResult& drop, const std::string& engine, bool rolls,
                 const CheckLimits& limits, CheckRows* rows) {
  if (rolls) {
    rows->Report("settles-" + engine, drop.rest_time, "s; it rolls and is judged by its drift");
  } else {
    rows->Require("settles-" + engine, drop.rests && drop.rest_time <= limits.rest_time,
                  drop.rest_time, "s until it rests, limit 2");
    rows->AtMost("rest-pose-" + engine, drop.tilt * kDegrees, limits.tilt,
                 "degrees from its rest pose");
  }
  rows->AtMost("drift-" + engine, drop.drift * 1e3, limits.drift * 1e3, "mm in 2 s at rest");
}

}  // namespace simwright::pipeline
