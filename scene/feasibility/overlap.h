#pragma once

namespace simwright::scene {

// Two interpenetrating bodies, by index, a < b.
struct Overlap {
  int a = -1, b = -1;
  double depth = 0.0;  // m
};

}  // namespace simwright::scene
