#pragma once

#include "core/finding.h"

namespace simwright::pipeline {

// The libraries and data that the program works with: MuJoCo and Bullet by a dropped ball, urdfdom
// by a URDF that it reads, WordNet, and the shipped weights. Each that is missing or broken says
// what to install.
core::Findings ExamineSoftware();

}  // namespace simwright::pipeline
