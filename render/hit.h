#pragma once

namespace simwright::render {

// The first hit of a ray.
struct Hit {
  float depth = 0.0f;        // ray parameter: a multiple of the direction's length
  int instance = -1;         // index of the geometry in the order of adding; -1: no hit
  int triangle = -1;         // of that instance's mesh
  float u = 0.0f, v = 0.0f;  // barycentric weights of the triangle's corners 1 and 2
};

}  // namespace simwright::render
