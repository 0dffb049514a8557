#pragma once

#include <vector>

#include "core/camera.h"
#include "render/differentiable_surface.h"

namespace simwright::render {

// The part of a mesh's edge that lies in front of the near plane and within the picture.
struct ScreenEdge {
  int object = 0;
  int edge = 0;               // of the object's EdgeTopology
  double t0 = 0.0, t1 = 1.0;  // where it begins and ends, along the edge in space
  double z0 = 1.0, z1 = 1.0;  // depths there, m
  double end = 0.0;           // pixels of this edge and all before it
};

// A point of one, by its screen length.
struct EdgePoint {
  int edge = 0;    // index into SilhouetteEdges::edges
  double t = 0.0;  // along the edge in space, from `a` to `b`
};

// Where the picture may step: edges at which a mesh ends or turns its other side to the camera, and
// creases.
class SilhouetteEdges {
 public:
  // Finds them; objects are prepared for the camera. Keeps its memory from call to call.
  void Find(const std::vector<PreparedObject>& objects, const core::Camera& camera, double near);

  // Pixels of all edges.
  double length() const { return edges_.empty() ? 0.0 : edges_.back().end; }
  const std::vector<ScreenEdge>& edges() const { return edges_; }

  // The point `at` in [0, length()) pixels along all edges. `hint`: an edge at or before it, from
  // which the search goes on; -1: from anywhere.
  EdgePoint Locate(double at, int hint) const;

 private:
  std::vector<ScreenEdge> edges_;
};

}  // namespace simwright::render
