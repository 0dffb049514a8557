#pragma once

#include <vector>

#include "core/camera.h"
#include "render/differentiable_surface.h"

namespace simwright::render {

// The part of a mesh edge in front of the near plane and within the image.
struct ScreenEdge {
  int object = 0;
  int edge = 0;               // of the object's EdgeTopology
  double t0 = 0.0, t1 = 1.0;  // start and end of that part, along the edge in space
  double z0 = 1.0, z1 = 1.0;  // depths there, m
  double end = 0.0;           // cumulative length of all edges up to this one, pixels
};

// A point of a screen edge, sampled by screen length.
struct EdgePoint {
  int edge = 0;    // index into SilhouetteEdges::edges
  double t = 0.0;  // along the edge in space, from `a` to `b`
};

// The edges at which the image may be discontinuous: border edges, edges between a front-facing and
// a back-facing face, and creases.
class SilhouetteEdges {
 public:
  // Finds the edges of objects that are prepared for the camera. Reuses its memory between calls.
  void Find(const std::vector<PreparedObject>& objects, const core::Camera& camera, double near);

  // Returns the total length of all edges, pixels.
  double length() const { return edges_.empty() ? 0.0 : edges_.back().end; }
  const std::vector<ScreenEdge>& edges() const { return edges_; }

  // Returns the point `at` in [0, length()) pixels along all edges. `hint` is an edge at or before
  // it from which to search; -1: from anywhere.
  EdgePoint Locate(double at, int hint) const;

 private:
  std::vector<ScreenEdge> edges_;
};

}  // namespace simwright::render
