#include "render/silhouette_edges.h"

#include <algorithm>

namespace simwright::render {
namespace {

// Returns true if the image may be discontinuous at the edge. Seen along the edge from `a` to `b`,
// a face lies on one side if it is front-facing and runs forward, or back-facing and runs backward.
// (Meshes that are not oriented are therefore no special case.)
bool MayBeDiscontinuous(const PreparedObject& of, const MeshEdge& edge) {
  const EdgeFace* faces = &of.topology.faces[edge.first];
  if (edge.count != 2) return true;
  const bool front0 = of.front[faces[0].triangle] != 0, front1 = of.front[faces[1].triangle] != 0;
  if ((front0 == faces[0].forward) == (front1 == faces[1].forward)) return true;
  // The inner side of a closed mesh is not visible.
  return edge.crease && (front0 || front1 || !of.topology.closed);
}

// Clips [lo, hi] to where start + s * change >= 0; returns false if nothing is left.
bool ClipInterval(double start, double change, double* lo, double* hi) {
  if (change == 0.0) return start >= 0.0;
  const double s = -start / change;
  if (change > 0.0) {
    *lo = std::max(*lo, s);
  } else {
    *hi = std::min(*hi, s);
  }
  return *lo < *hi;
}

Eigen::Vector2d Projected(const core::Camera& camera, const Eigen::Vector3d& p) {
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

// Clips the edge from `a` to `b` (camera frame); returns its length in the image.
double Clip(const core::Camera& camera, double near, const Eigen::Vector3d& a,
            const Eigen::Vector3d& b, ScreenEdge* edge) {
  edge->t0 = 0.0;
  edge->t1 = 1.0;
  if (!ClipInterval(a.z() - near, b.z() - a.z(), &edge->t0, &edge->t1)) return 0.0;
  const Eigen::Vector3d from = a + edge->t0 * (b - a), to = a + edge->t1 * (b - a);
  const Eigen::Vector2d p = Projected(camera, from), d = Projected(camera, to) - p;
  double lo = 0.0, hi = 1.0;  // along the image segment
  if (!ClipInterval(p.x(), d.x(), &lo, &hi) ||
      !ClipInterval(camera.width - p.x(), -d.x(), &lo, &hi) ||
      !ClipInterval(p.y(), d.y(), &lo, &hi) ||
      !ClipInterval(camera.height - p.y(), -d.y(), &lo, &hi)) {
    return 0.0;
  }
  // Equal steps in the image are equal steps of 1/z.
  const auto in_space = [&](double s) {
    return s * from.z() / ((1.0 - s) * to.z() + s * from.z());
  };
  const double span = edge->t1 - edge->t0, start = edge->t0;
  edge->t0 = start + span * in_space(lo);
  edge->t1 = start + span * in_space(hi);
  edge->z0 = a.z() + edge->t0 * (b.z() - a.z());
  edge->z1 = a.z() + edge->t1 * (b.z() - a.z());
  return (hi - lo) * d.norm();
}

}  // namespace

void SilhouetteEdges::Find(const std::vector<PreparedObject>& objects, const core::Camera& camera,
                           double near) {
  edges_.clear();
  double length = 0.0;
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const PreparedObject& of = objects[o];
    for (std::size_t e = 0; e < of.topology.edges.size(); ++e) {
      const MeshEdge& edge = of.topology.edges[e];
      if (!MayBeDiscontinuous(of, edge)) continue;
      ScreenEdge on_screen;
      const double pixels = Clip(camera, near, of.camera[edge.a].cast<double>(),
                                 of.camera[edge.b].cast<double>(), &on_screen);
      if (!(pixels > 0.0)) continue;
      length += pixels;
      on_screen.object = static_cast<int>(o);
      on_screen.edge = static_cast<int>(e);
      on_screen.end = length;
      edges_.push_back(on_screen);
    }
  }
}

EdgePoint SilhouetteEdges::Locate(double at, int hint) const {
  int index = hint;
  if (index < 0) {
    const auto found =
        std::upper_bound(edges_.begin(), edges_.end(), at,
                         [](double value, const ScreenEdge& edge) { return value < edge.end; });
    index = static_cast<int>(found - edges_.begin());
  }
  const int last = static_cast<int>(edges_.size()) - 1;
  index = std::min(index, last);
  while (index < last && edges_[index].end <= at) ++index;
  const ScreenEdge& edge = edges_[index];
  const double begin = index > 0 ? edges_[index - 1].end : 0.0;
  const double s = std::clamp((at - begin) / (edge.end - begin), 0.0, 1.0);
  const double along = s * edge.z0 / ((1.0 - s) * edge.z1 + s * edge.z0);
  return {index, edge.t0 + (edge.t1 - edge.t0) * along};
}

}  // namespace simwright::render
