#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "assets/asset.h"
#include "core/finding.h"
#include "physics_params/physical_parameters.h"

// The conversions of asset.json's values (docs/formats.md), shared by rigid and articulated assets.
// The readers throw nlohmann::json::exception for missing values and wrong types.
namespace simwright::assets {

using Json = nlohmann::ordered_json;
constexpr int kFormatVersion = 1;

Json ToJson(const physics_params::Estimate& estimate);
Json ToJson(const Eigen::Vector3d& v);
Json ToJson(const Eigen::Matrix3d& m);       // rows
Json ToJson(const Eigen::Isometry3d& pose);  // rotation_wxyz, translation
Json ToJson(const Inertial& inertial);       // mass, center_of_mass, inertia
Json ToJson(const core::Findings& findings);
// Returns the category's row: category, category_resolution, size_m, mass_kg, material, friction,
// restitution.
Json ToJson(const physics_params::PhysicalParameters& parameters);

physics_params::Estimate EstimateFrom(const Json& json);
Eigen::Vector3d VectorFrom(const Json& json);
Eigen::Isometry3d PoseFrom(const Json& json);
Inertial InertialFrom(const Json& json);
core::Findings FindingsFrom(const Json& json);
physics_params::PhysicalParameters ParametersFrom(const Json& json);

}  // namespace simwright::assets
