#pragma once

#include <optional>
#include <string>

#include "core/error.h"
#include "core/finding.h"
#include "validation/appearance.h"
#include "validation/check_grade.h"

namespace simwright::validation {

// The results of `simwright check`, one finding per property: code, figure, and a sentence with the
// limit. The severity is kError for a failure, kWarning for a tolerable fault, and kInfo for a
// property that passes or is only reported.
struct CheckReport {
  std::string subject;
  core::Findings results;
  std::optional<Appearance> appearance = {};  // of an asset that has the photo it was made from
  Grade grade() const { return GradeOf(results); }
  bool passed() const { return grade() != Grade::kFail; }
  core::Findings Warnings() const;  // the results that the user must be told about
};

// Limits of a check (DESIGN.md, "An asset is right when").
struct CheckLimits {
  double surface_distance_ratio = 0.005;  // solid to the visual's outer surface, both directions
  // The distance from the solid's surface to the nearest part over the diagonal. Hulls of 64
  // vertices lie up to 2 % inside a ball.
  double cover_distance_ratio = 0.03;
  double reader_tolerance = 1e-6;  // mass, centre of mass, inertia against asset.json, relative
  double rest_time = 2.0;          // s
  // Degrees from the rest pose. Beyond the worst value the body fell over (FindRestPose uses the
  // same bound).
  GradedLimit tilt{2.0, 5.0};
  GradedLimit rocking_tilt{5.0, 20.0};  // degrees, for bodies that no pose held when built
  // The drift of a resting body in 2 s, m. For a small body the worst value is `drift_share` of its
  // diagonal instead, but at least twice the good one.
  GradedLimit drift{1e-3, 1e-2};
  double drift_share = 0.05;
  // The drift of a rolling body in 2 s, over its diagonal. A body that gains speed always fails.
  GradedLimit rolling_drift{0.1, 5.0};
  GradedLimit sinking{1e-3, 3e-3};           // depth of the lowest point below the floor at rest, m
  GradedLimit engines_distance{1e-3, 3e-3};  // Bullet to MuJoCo at rest, m
  GradedLimit engines_tilt{2.0, 5.0};        // degrees
  double joint_reach = 0.99;                 // fraction of the range, driven by a human's force
  double joint_drift = 0.02;                 // fraction of the range in 1 s after release
};

// Returns the results that warn or fail.
core::Findings NotableResults(const CheckReport& report);

// The error of an asset that fails its check. The message counts and names the failed checks;
// `rows` holds them.
class CheckFailed : public core::Error {
 public:
  CheckFailed(const CheckReport& report, const std::string& name);
  const core::Findings& results() const { return rows_; }

 private:
  core::Findings rows_;
};

// Throws CheckFailed if the report has not passed.
void RequirePassed(const CheckReport& report, const std::string& name);

// Returns "passes", "passes with warnings" or "does not pass".
const char* GradeSentence(Grade grade);

// Returns "it looks B: its outline differs from the photo's (0.95)".
std::string AppearanceSentence(const Appearance& appearance);

// Formats the report as a table for a terminal, one row per property.
std::string CheckTable(const CheckReport& report);
std::string CheckJson(const CheckReport& report);

}  // namespace simwright::validation
