#pragma once

#include <filesystem>

#include <Eigen/Core>

#include "core/finding.h"
#include "core/mesh.h"
#include "physics_params/knowledge_base.h"

namespace simwright::importers {

// Returns the conventional up axis of a format: y for OBJ, glTF and DAE, z for STL and PLY.
char UsualUpAxis(const std::filesystem::path& mesh);

// Returns true if the format does not specify the up axis, as OBJ, STL and PLY.
bool LeavesUpOpen(const std::filesystem::path& mesh);

// Guesses which axis of the file points up: the conventional one of its format, unless the format
// does not specify it and the other of y and z fits the object clearly better by the proportions of
// its category and by its stability on the lowest points (3 degrees of tilt). Reports the guess as
// "up-axis": a note, or a warning if it is not the conventional axis.
char GuessUpAxis(const std::filesystem::path& path, const core::TriangleMesh& mesh,
                 const physics_params::Category& category, core::Findings* findings);

}  // namespace simwright::importers
