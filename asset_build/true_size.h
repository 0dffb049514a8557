#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/finding.h"
#include "core/mesh.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/physical_parameters.h"
#include "physics_params/size_plausibility.h"

namespace simwright::asset_build {

// The size that a user states, m: {} none, {s} the longest side, {l, w, h} the longer and the
// shorter horizontal side and the height in the standing pose.
using StatedSize = std::vector<double>;

// Throws core::Error unless it has 0, 1 or 3 sides, each positive and finite.
void Validate(const StatedSize& size);

// The sides of an object in its pose: along a horizontal direction, perpendicular to it, and the
// height. The direction is the x axis, unless another one gives a rectangle smaller by a twentieth,
// so that the length of a hammer lying diagonally in a photo is not split between both sides.
struct GroundBox {
  double angle = 0.0;  // the direction's, from x towards y, rad
  Eigen::Vector3d sides = Eigen::Vector3d::Zero();
};
GroundBox GroundBoxOf(const core::TriangleMesh& mesh);

// Returns the scale factors from an object with `sides` (m) to a stated size: equal ones for a
// longest side, else one per axis.
Eigen::Vector3d ScalesTo(const StatedSize& size, const Eigen::Vector3d& sides);

// Scales `mesh` to a stated size along the axes of its ground box, and reports "stretched" if that
// changes its proportions by more than 5 %. Throws core::Error if it has no extent along a side.
void ScaleToSize(const StatedSize& size, const std::string& where, core::TriangleMesh* mesh,
                 core::Findings* findings);

// Returns the factor by which the volume of the mesh's ground box becomes that of the sampled size,
// for a mesh of arbitrary scale: the error of a wrong proportion is spread over all sides. Throws
// core::Error if the mesh has no extent along a side.
double ScaleToSampledSize(const physics_params::PhysicalParameters& sampled,
                          const core::TriangleMesh& mesh, const std::string& where);

// Returns the finding "size-drawn": the size (sides, m) was sampled, because a single photo does
// not determine it. A warning if the category is "object".
core::Finding SizeDrawn(const physics_params::Category& category, const Eigen::Vector3d& sides,
                        const std::string& where);

// Throws core::Error for an object whose sides (m) are implausible for its category
// (physics_params::IsAbsurdSize), with its size, the usual size, and the unit that would make it
// usual. `unit`: metres per file unit; `most`: the implausible factor of enlargement or reduction.
void RequirePlausibleSize(const physics_params::Category& category, const Eigen::Vector3d& sides,
                          double unit, const std::string& where,
                          double most = physics_params::kAbsurdFactor);

// The implausible factor for URDFs. URDFs are in metres by specification, and toy models of cars or
// dogs are named like the real ones, so that only a wrong unit counts, of which inches are the
// nearest.
constexpr double kAbsurdUrdf = 20.0;

}  // namespace simwright::asset_build
