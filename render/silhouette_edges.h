#pragma once

#include <vector>

#include "core/camera.h"
#include "render/differentiable_surface.h"

namespace simwright::render {

// The part of a mesh edge in front of the near plane and within the image.
struct ScreenEdge {
  int object = 0;             // index into the objects of Find
  int edge = 0;               // index into the object's EdgeTopology::edges
  double t0 = 0.0, t1 = 1.0;  // start and end of the part: fractions of the edge from `a` to `b`
  double z0 = 1.0, z1 = 1.0;  // depths at start and end, m
  double end = 0.0;           // total length in the image of the edges up to this one, pixels
};

// A point on a screen edge, found by its distance along the edges in the image.
struct EdgePoint {
  int edge = 0;    // index into SilhouetteEdges::edges
  double t = 0.0;  // fraction of the edge in space, 0 at MeshEdge::a and 1 at MeshEdge::b
};

// The edges at which the image may be discontinuous: border edges, edges between a front-facing and
// a back-facing face, and creases.
class SilhouetteEdges {
 public:
  // Finds the edges of `objects`, which must be prepared for `camera`, beyond the near plane at
  // depth `near` (m). Reuses its memory between calls.
  void Find(const std::vector<PreparedObject>& objects, const core::Camera& camera, double near);

  // Returns the total length of all edges in the image, pixels.
  double length() const { return edges_.empty() ? 0.0 : edges_.back().end; }
  const std::vector<ScreenEdge>& edges() const { return edges_; }

  // Returns the point at the distance `at` (pixels, in [0, length())) along the edges in order.
  // `hint` is the index of an edge at or before the point, from which the search starts; -1: no
  // hint. There must be at least one edge.
  EdgePoint Locate(double at, int hint) const;

 private:
  std::vector<ScreenEdge> edges_;
};

}  // namespace simwright::render
