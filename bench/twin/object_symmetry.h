#pragma once

#include <vector>

#include "core/mesh.h"

namespace simwright::bench {

// Returns the turns about z (rad, in steps of 5 degrees) that leave the shape of a mesh nearly as
// it is: samples of the turned surface are on average within 3.7 % of the diagonal from samples of
// the surface, of which 1.2 % are the distance between samples. The first is 0.
std::vector<double> SymmetricTurns(const core::TriangleMesh& mesh);

// Returns the difference of two yaws (rad) up to the nearest of these turns, not negative.
double YawDifference(double yaw, double truth, const std::vector<double>& turns);

}  // namespace simwright::bench
