#pragma once

#include <filesystem>
#include <string>

#include "core/finding.h"

namespace simwright::pipeline {

// The rows of `simwright check`, one finding a property: code, figure, a sentence with the limit;
// severity kError where it fails, kInfo where it passes or is only reported.
struct CheckReport {
  std::string subject;
  core::Findings rows;
  bool passed() const;
};

// Limits of a check (DESIGN.md, "An asset is right when").
struct CheckLimits {
  double surface_distance_ratio = 0.005;  // solid to visual's outer surface, both ways
  // From the solid's surface to the nearest part: hulls of 64 vertices lie up to 2 % inside a ball.
  double cover_distance_ratio = 0.03;
  double reader_tolerance = 1e-6;  // mass, centre, inertia against asset.json, relative
  double rest_time = 2.0;          // s
  double tilt = 2.0;               // degrees from the rest pose
  double drift = 1e-3;             // m in 2 s
  double engines_distance = 1e-3;  // m, Bullet against MuJoCo at rest
  double engines_tilt = 2.0;       // degrees
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

// Each row that failed, with its figure and limit; empty where the report passed.
std::string FailedRows(const CheckReport& report);

// Throws core::Error with them where the report did not pass.
void RequirePassed(const CheckReport& report, const std::string& name);

// A table for a terminal, a row a property.
std::string CheckTable(const CheckReport& report);
std::string CheckJson(const CheckReport& report);

}  // namespace simwright::pipeline
