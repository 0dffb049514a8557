#pragma once

#include "core/mesh.h"

namespace simwright::asset_lift {

// Smooths a closed mesh where it crosses itself, and only there: vertices of crossing faces and of
// their neighbours move to the mean of theirs, wider round each time, at most `rounds` times.
// Returns whether no faces cross or are degenerate any more. Faces stay as they are.
bool SmoothCrossings(core::TriangleMesh* mesh, int rounds);

}  // namespace simwright::asset_lift
