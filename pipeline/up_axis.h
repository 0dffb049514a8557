#pragma once

#include <filesystem>

#include <Eigen/Core>

#include "core/finding.h"
#include "core/mesh.h"
#include "physics_params/knowledge_base.h"

namespace simwright::pipeline {

// The axis that a format is written with: y for OBJ, glTF and DAE, z for STL and PLY.
char UsualUpAxis(const std::filesystem::path& mesh);

// Whether a format leaves it open all the same, as OBJ, STL and PLY do.
bool LeavesUpOpen(const std::filesystem::path& mesh);

// Which axis of the file points up: the usual one of its format, unless the format leaves it open
// and the other of y and z suits the thing clearly better: the proportions of its category, and
// that it stands on what is lowest then (3 degrees of tilt). Reports what was guessed: "up-axis", a
// note, or a warning where it is not the usual one.
char GuessUpAxis(const std::filesystem::path& path, const core::TriangleMesh& mesh,
                 const physics_params::Category& category, core::Findings* findings);

}  // namespace simwright::pipeline
