#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/finding.h"
#include "pipeline/check_grade.h"

namespace simwright::pipeline {

// The rows of `simwright check`, one finding a property: code, figure, a sentence with the limit;
// severity kError where it fails, kWarning where its fault is small enough to live with, kInfo
// where it passes or is only reported.
struct CheckReport {
  std::string subject;
  core::Findings rows;
  Grade grade() const { return GradeOf(rows); }
  bool passed() const { return grade() != Grade::kFail; }
  core::Findings Warnings() const;  // the rows that warn: what a user has to be told
};

// Limits of a check (DESIGN.md, "An asset is right when").
struct CheckLimits {
  double surface_distance_ratio = 0.005;  // solid to visual's outer surface, both ways
  // From the solid's surface to the nearest part: hulls of 64 vertices lie up to 2 % inside a ball.
  double cover_distance_ratio = 0.03;
  double reader_tolerance = 1e-6;  // mass, centre, inertia against asset.json, relative
  double rest_time = 2.0;  // s
  // Degrees from the rest pose: beyond the worst it fell over (FindRestPose takes the same bound).
  GradedLimit tilt{2.0, 5.0};
  GradedLimit rocking_tilt{5.0, 20.0};  // degrees, of what no pose held when it was made
  // m in 2 s, of what rests; for a small body the worst is this share of its diagonal instead, but
  // at least twice the good.
  GradedLimit drift{1e-3, 1e-2};
  double drift_share = 0.05;
  // m in 2 s over the diagonal, of what rolls; one that gains speed fails whatever it is.
  GradedLimit rolling_drift{0.1, 5.0};
  GradedLimit sinking{1e-3, 3e-3};  // m below the floor, of the lowest point at rest
  GradedLimit engines_distance{1e-3, 3e-3};  // m, Bullet against MuJoCo at rest
  GradedLimit engines_tilt{2.0, 5.0};        // degrees
  double joint_reach = 0.99;       // of its range, driven by a hand's force
  double joint_drift = 0.02;       // of its range in a second, let go
};

// Checks an asset folder, rigid or articulated, with its files as they are on disk. Throws
// core::Error when the folder cannot be read at all; whatever else is wrong is a failed row.
CheckReport CheckAsset(const std::filesystem::path& folder, const CheckLimits& limits = {});

// Checks a URDF of any origin: collision shapes, inertials, drop in Bullet, all joints held at
// zero; where every link has an inertial, also that each joint swings through its range. `root`: no
// mesh is read from outside it; empty for the default of ReadUrdf.
CheckReport CheckUrdf(const std::filesystem::path& urdf, const std::filesystem::path& root,
                      const CheckLimits& limits = {});

// The rows that warn or fail.
core::Findings NotableRows(const CheckReport& report);

// An asset that fails its check: the message counts and names the rows that failed, `rows` has
// them.
class CheckFailed : public core::Error {
 public:
  CheckFailed(const CheckReport& report, const std::string& name);
  const core::Findings& rows() const { return rows_; }

 private:
  core::Findings rows_;
};

// Throws CheckFailed where the report did not pass.
void RequirePassed(const CheckReport& report, const std::string& name);

// Checks the folder of an asset that is being made, before it is kept: throws as RequirePassed
// where it fails, else writes the rows that warn into the findings of its asset.json.
CheckReport CheckBeforeKeeping(const std::filesystem::path& folder, const std::string& name,
                               const CheckLimits& limits = {});

// "passes", "passes with warnings" or "does not pass".
const char* GradeSentence(Grade grade);

// A table for a terminal, a row a property.
std::string CheckTable(const CheckReport& report);
std::string CheckJson(const CheckReport& report);

}  // namespace simwright::pipeline
