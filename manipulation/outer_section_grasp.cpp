#include "manipulation/outer_section_grasp.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kLeastHeld = 0.008;  // m of the part between the pads
constexpr double kAsWide = 0.002;     // m: widths that count as equal
constexpr double kThinner = 1e-4;     // m: a smaller gain is not worth a rotation
constexpr double kDepthStep = 0.001;  // m
constexpr int kMostDegrees = 30;
constexpr double kDegree = std::numbers::pi / 180.0;

// The extent of a section along the closing axis; empty while low > high.
struct Section {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Extend(double y) {
    low = std::min(low, y);
    high = std::max(high, y);
  }
  double width() const { return std::max(0.0, high - low); }
};

// Returns the width (m) along y of the parts between two depths along z; both in the tool frame.
double WidthBetween(const std::vector<core::TriangleMesh>& parts, double from, double to) {
  Section section;
  for (const core::TriangleMesh& part : parts) {
    for (const Eigen::Vector3i& triangle : part.triangles) {
      for (int e = 0; e < 3; ++e) {
        const Vector3d& a = part.vertices[static_cast<size_t>(triangle[e])];
        const Vector3d& b = part.vertices[static_cast<size_t>(triangle[(e + 1) % 3])];
        if (a.z() >= from && a.z() <= to) section.Extend(a.y());
        for (const double depth : {from, to}) {
          if ((a.z() - depth) * (b.z() - depth) >= 0.0) continue;
          section.Extend(a.y() + (b.y() - a.y()) * (depth - a.z()) / (b.z() - a.z()));
        }
      }
    }
  }
  return section.width();
}

// Returns the parts in the tool frame.
std::vector<core::TriangleMesh> SeenFrom(const Isometry3d& link_from_tool,
                                         const std::vector<core::TriangleMesh>& parts) {
  const Isometry3d tool_from_link = link_from_tool.inverse();
  std::vector<core::TriangleMesh> seen = parts;
  for (core::TriangleMesh& part : seen) {
    for (Vector3d& vertex : part.vertices) vertex = tool_from_link * vertex;
  }
  return seen;
}

// Returns the depth (m, tool frame) of the parts' outermost point.
double OutermostDepth(const std::vector<core::TriangleMesh>& seen) {
  double outermost = std::numeric_limits<double>::infinity();
  for (const core::TriangleMesh& part : seen) {
    for (const Vector3d& vertex : part.vertices) outermost = std::min(outermost, vertex.z());
  }
  return outermost;
}

// Rotates the tool about its approach to where the outer section is thinnest. Where a smaller
// rotation is as good, as on round parts, it takes that.
Isometry3d Aligned(const std::vector<core::TriangleMesh>& parts, const Isometry3d& link_from_tool) {
  Isometry3d best = link_from_tool;
  double thinnest = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= 2 * kMostDegrees; ++step) {
    const double angle = (step % 2 == 0 ? 1 : -1) * ((step + 1) / 2) * kDegree;
    const Isometry3d tool = link_from_tool * Eigen::AngleAxisd(angle, Vector3d::UnitZ());
    const std::vector<core::TriangleMesh> seen = SeenFrom(tool, parts);
    const double outermost = OutermostDepth(seen);
    const double width = WidthBetween(seen, outermost, outermost + kLeastHeld);
    if (width >= thinnest - kThinner) continue;
    thinnest = width;
    best = tool;
  }
  return best;
}

}  // namespace

Isometry3d GraspOfOuterSection(const std::vector<core::TriangleMesh>& parts,
                               const Isometry3d& link_from_tool, double tip) {
  const Isometry3d aligned = Aligned(parts, link_from_tool);
  const std::vector<core::TriangleMesh> seen = SeenFrom(aligned, parts);
  const double outermost = OutermostDepth(seen);
  const double wanted = WidthBetween(seen, outermost, outermost + kLeastHeld) + kAsWide;
  for (double back = 0.0; tip - back >= outermost + kLeastHeld; back += kDepthStep) {
    if (WidthBetween(seen, -tip - back, tip - back) > wanted) continue;
    return aligned * Eigen::Translation3d(0.0, 0.0, -back);
  }
  return aligned;
}

}  // namespace simwright::manipulation
