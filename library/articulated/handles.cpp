#include "library/articulated/handles.h"

#include <cmath>

#include <Eigen/Geometry>

#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kHalfBar = 0.006;     // m
constexpr double kPostRadius = 0.005;  // m
constexpr double kKnobRadius = 0.016;  // m
constexpr double kKnobHead = 0.016;    // m, thickness of the head
constexpr int kBendSteps = 3;          // segments of a quarter bend

// Boxes and handles are axis-aligned: `out` and `along` are axes.
std::vector<core::TriangleMesh> Bar(const HandlePlacement& p) {
  const Eigen::Vector3d across = p.out.cross(p.along);
  const Eigen::Vector3d middle = p.mount + p.standoff * p.out;
  const Eigen::Vector3d half = 0.5 * p.length * p.along + kHalfBar * (p.out + across);
  std::vector<core::TriangleMesh> pieces{Box(middle - half, middle + half, 0.002)};
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d foot = p.mount + side * (0.5 * p.length - 0.015) * p.along;
    pieces.push_back(Rod(foot, foot + (p.standoff - kHalfBar) * p.out, kPostRadius, 12));
  }
  return pieces;
}

std::vector<core::TriangleMesh> Bow(const HandlePlacement& p) {
  const double bend = 0.6 * p.standoff, half = 0.5 * p.length;
  const auto at = [&](double along, double out) -> Eigen::Vector3d {
    return p.mount + along * p.along + out * p.out;
  };
  std::vector<Eigen::Vector3d> path{at(-half, 0.0)};
  const Eigen::Vector3d axis = p.out.cross(p.along);
  for (const Eigen::Vector3d& point :
       Arc(at(-half + bend, p.standoff - bend), at(-half, p.standoff - bend), axis, M_PI / 2,
           kBendSteps)) {
    path.push_back(point);
  }
  for (const Eigen::Vector3d& point :
       Arc(at(half - bend, p.standoff - bend), at(half - bend, p.standoff), axis, M_PI / 2,
           kBendSteps)) {
    path.push_back(point);
  }
  path.push_back(at(half, 0.0));
  return Pipe(path, kHalfBar);
}

std::vector<core::TriangleMesh> Knob(const HandlePlacement& p) {
  const double neck = p.standoff - 0.5 * kKnobHead;
  const Eigen::Vector3d shoulder = p.mount + neck * p.out;
  const Eigen::Vector3d top = shoulder + kKnobHead * p.out;
  return {Frustum(p.mount, shoulder, 0.010, 0.007, 14),
          Frustum(shoulder, shoulder + 0.6 * kKnobHead * p.out, 0.7 * kKnobRadius, kKnobRadius),
          Frustum(shoulder + 0.6 * kKnobHead * p.out, top, kKnobRadius, 0.75 * kKnobRadius)};
}

}  // namespace

const char* HandleName(HandleKind kind) {
  constexpr const char* kNames[] = {"bar", "bow", "knob"};
  return kNames[static_cast<int>(kind)];
}

HandleKind SampleHandleKind(Draws& draws, const std::vector<HandleKind>& kinds) {
  return kinds[static_cast<size_t>(UniformIndex(draws, static_cast<std::int64_t>(kinds.size())))];
}

std::vector<core::TriangleMesh> HandleMeshes(HandleKind kind, const HandlePlacement& place) {
  switch (kind) {
    case HandleKind::kBar:
      return Bar(place);
    case HandleKind::kBow:
      return Bow(place);
    default:
      return Knob(place);
  }
}

Eigen::Vector3d GripPoint(const HandlePlacement& place) {
  return place.mount + place.standoff * place.out;
}

}  // namespace simwright::library
