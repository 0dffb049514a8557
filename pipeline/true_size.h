#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/finding.h"
#include "core/mesh.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/size_plausibility.h"

namespace simwright::pipeline {

// The size that a user states, m: {} none, {s} the longest side, {l, w, h} the longer and the
// shorter side on the ground, and the height as the thing stands.
using StatedSize = std::vector<double>;

// Throws core::Error unless it has none, 1 or 3 sides, each above 0 and finite.
void Validate(const StatedSize& size);

// The sides of a thing as it lies: along a direction on the ground, across it, and its height. The
// direction is that of the x axis, unless another one gives a rectangle smaller by a twentieth: a
// hammer across the corner of a photo is as long as it is, and not as wide.
struct GroundBox {
  double angle = 0.0;  // rad, of the direction, from x towards y
  Eigen::Vector3d sides = Eigen::Vector3d::Zero();
};
GroundBox GroundBoxOf(const core::TriangleMesh& mesh);

// What scales a thing of `sides` (m) to a stated size: the same along all axes for a longest side,
// else each by its own.
Eigen::Vector3d ScalesTo(const StatedSize& size, const Eigen::Vector3d& sides);

// Scales `mesh` to a stated size, along the axes of its ground box, and says as "stretched" where that changes its proportions by
// more than 5 %. Throws core::Error where it has no extent along a side.
void ScaleToSize(const StatedSize& size, const std::string& where, core::TriangleMesh* mesh,
                 core::Findings* findings);

// Throws core::Error for a thing whose sides (m) are absurd for its category
// (physics_params::IsAbsurdSize), with its size, the usual one, and the unit that would make it
// usual. `unit`: metres a number of the file; `most`: how many times too large or small is absurd.
void RequirePlausibleSize(const physics_params::Category& category, const Eigen::Vector3d& sides,
                          double unit, const std::string& where,
                          double most = physics_params::kAbsurdFactor);

// URDFs are in metres by what they are, and models of cars or dogs are called cars and dogs: theirs
// is absurd where a unit is wrong, inches being the nearest.
constexpr double kAbsurdUrdf = 20.0;

}  // namespace simwright::pipeline
