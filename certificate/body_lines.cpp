#include "certificate/body_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace simwright::certificate {
namespace {

using Eigen::Vector3d;

constexpr double kParallel = 1e-12;  // of a direction along a face's normal
constexpr double kInside = 1e-5;     // m below the surface of another part

// Returns the part of a line inside one convex part.
std::optional<Chord> ChordOfPart(const manipulation::ConvexPart& part, const Vector3d& origin,
                                 const Vector3d& direction) {
  Chord chord;
  chord.enter = -std::numeric_limits<double>::infinity();
  chord.leave = std::numeric_limits<double>::infinity();
  for (const Eigen::Hyperplane<double, 3>& face : part.faces) {
    const double slope = face.normal().dot(direction), height = face.signedDistance(origin);
    if (std::abs(slope) < kParallel) {
      if (height > 0.0) return std::nullopt;
      continue;
    }
    const double at = -height / slope;
    if (slope < 0.0 && at > chord.enter) {
      chord.enter = at;
      chord.enter_normal = face.normal();
    } else if (slope > 0.0 && at < chord.leave) {
      chord.leave = at;
      chord.leave_normal = face.normal();
    }
    if (chord.enter >= chord.leave) return std::nullopt;
  }
  return chord;
}

double DistanceFromZero(const Chord& chord) {
  return std::max({0.0, chord.enter, -chord.leave});
}

}  // namespace

BodyLines::BodyLines(const BodyModel& body) : body_(body) {
  double sum = 0.0;
  for (size_t p = 0; p < body.meshes.size(); ++p) {
    const core::TriangleMesh& mesh = body.meshes[p];
    parts_.emplace_back(mesh);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Eigen::Vector3i& corners = mesh.triangles[t];
      const Vector3d& a = mesh.vertices[static_cast<size_t>(corners[0])];
      const Vector3d& b = mesh.vertices[static_cast<size_t>(corners[1])];
      const Vector3d& c = mesh.vertices[static_cast<size_t>(corners[2])];
      sum += 0.5 * (b - a).cross(c - a).norm();
      areas_.push_back(sum);
      triangles_.emplace_back(static_cast<int>(p), static_cast<int>(t));
    }
  }
}

std::optional<Chord> BodyLines::ChordAt(const Vector3d& origin, const Vector3d& direction) const {
  std::vector<Chord> chords;
  for (const manipulation::ConvexPart& part : parts_) {
    if (const auto chord = ChordOfPart(part, origin, direction)) chords.push_back(*chord);
  }
  std::sort(chords.begin(), chords.end(),
            [](const Chord& a, const Chord& b) { return a.enter < b.enter; });
  std::optional<Chord> best;
  for (size_t i = 0; i < chords.size();) {
    Chord merged = chords[i];
    for (++i; i < chords.size() && chords[i].enter <= merged.leave + kInside; ++i) {
      if (chords[i].leave <= merged.leave) continue;
      merged.leave = chords[i].leave;
      merged.leave_normal = chords[i].leave_normal;
    }
    if (!best || DistanceFromZero(merged) < DistanceFromZero(*best)) best = merged;
  }
  return best;
}

std::optional<SurfaceSample> BodyLines::SampleSurface(core::Rng& rng) const {
  const double at = core::Uniform(rng) * areas_.back();
  double u = core::Uniform(rng), v = core::Uniform(rng);
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  const auto found = std::upper_bound(areas_.begin(), areas_.end(), at) - areas_.begin();
  const auto index = std::min(static_cast<size_t>(found), triangles_.size() - 1);
  const auto [part, triangle] = triangles_[index];
  const core::TriangleMesh& mesh = body_.meshes[static_cast<size_t>(part)];
  const Eigen::Vector3i& corners = mesh.triangles[static_cast<size_t>(triangle)];
  const Vector3d& a = mesh.vertices[static_cast<size_t>(corners[0])];
  const Vector3d ab = mesh.vertices[static_cast<size_t>(corners[1])] - a;
  const Vector3d ac = mesh.vertices[static_cast<size_t>(corners[2])] - a;
  const Vector3d normal = ab.cross(ac);
  if (!(normal.norm() > 0.0)) return std::nullopt;
  SurfaceSample sample{a + u * ab + v * ac, normal.normalized()};
  for (size_t p = 0; p < parts_.size(); ++p) {
    if (static_cast<int>(p) == part) continue;
    if (parts_[p].DepthOf(sample.point) > kInside) return std::nullopt;
  }
  return sample;
}

}  // namespace simwright::certificate
