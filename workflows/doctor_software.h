#pragma once

#include "core/finding.h"

namespace simwright::workflows {

// Examines the libraries and data that the program needs: MuJoCo and Bullet by dropping a ball,
// urdfdom by reading a URDF, WordNet, and the shipped weights. Each finding about a missing or
// broken one says what to install.
core::Findings ExamineSoftware();

}  // namespace simwright::workflows
