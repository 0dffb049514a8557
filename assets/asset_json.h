#pragma once

#include <cstdint>
#include <filesystem>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assets/asset.h"
#include "core/error.h"
#include "core/json.h"
#include "physics_params/physical_parameters.h"

// The conversions of asset.json's values (docs/formats.md), shared by rigid and articulated assets.
// The readers throw core::Error for missing values and wrong types.
namespace simwright::assets {

constexpr int kFormatVersion = 1;

core::OrderedJson ToJson(const physics_params::Estimate& estimate);
core::OrderedJson ToJson(const Eigen::Vector3d& v);
core::OrderedJson ToJson(const Eigen::Matrix3d& m);       // rows
core::OrderedJson ToJson(const Eigen::Isometry3d& pose);  // rotation_wxyz, translation
core::OrderedJson ToJson(const Inertial& inertial);       // mass, center_of_mass, inertia
// Returns the category's row: category, category_resolution, size_m, mass_kg, material, friction,
// restitution, and interval_90 if intervals are stated.
core::OrderedJson ToJson(const physics_params::PhysicalParameters& parameters);

// Reads the asset.json of a folder. Throws core::Error if it is damaged or of a newer version.
core::JsonDocument ReadAssetJson(const std::filesystem::path& folder);
Eigen::Isometry3d PoseFrom(const core::JsonField& field);
Inertial InertialFrom(const core::JsonField& field);
physics_params::PhysicalParameters ParametersFrom(const core::JsonField& field);

// Ends messages about a damaged asset.json.
constexpr const char* kAssetRemedy = "make the asset again";

// Returns the error of an asset.json whose name cannot name the asset's files.
core::Error InvalidName(const std::string& name, const std::string& file);
constexpr std::uint64_t kMaxAssetJsonBytes = 16 << 20;
constexpr int kMaxParts = 10000;  // collision parts of a body

}  // namespace simwright::assets
