#include "geometry/hull_simplify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <Eigen/Geometry>

#include "core/error.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_hull_2d.h"
#include "geometry/hull_fit.h"
#include "geometry/mass_properties.h"
#include "geometry/round_hull.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr int kMinVertices = 16;
constexpr double kThinnest = 1e-4;       // of the diagonal
constexpr double kSameHullPlane = 1e-5;  // of the diagonal: faces of one flat side
constexpr double kFlatShare = 0.04;      // of the surface: smallest flat side that is kept
constexpr double kSideLoss = 0.005;      // of a flat side's area that its corners may cut off
constexpr double kMirrored = 1e-3;       // of the diagonal: largest distance of a vertex from its
                                         // image
constexpr double kMostGrowth = 2.0;      // of the protrusion above a face
constexpr int kGrowthSteps = 20;         // bisection steps for the volume

// Returns how far `points` protrude from each plane. Each point counts for the plane that it is
// highest above, and for all within `tie` of that, so that the order of faces does not matter.
std::vector<double> Protrusions(const std::vector<Eigen::Vector4d>& planes,
                                const std::vector<Vector3d>& points, double tie) {
  std::vector<double> out(planes.size(), 0.0), height(planes.size(), 0.0);
  for (const Vector3d& p : points) {
    double highest = 0.0;
    for (std::size_t f = 0; f < planes.size(); ++f) {
      height[f] = planes[f].head<3>().dot(p) - planes[f][3];
      highest = std::max(highest, height[f]);
    }
    if (highest <= 0.0) continue;
    for (std::size_t f = 0; f < planes.size(); ++f) {
      if (height[f] >= highest - tie) out[f] = std::max(out[f], height[f]);
    }
  }
  return out;
}

// Returns for each vertex its faces, one per plane.
std::vector<std::vector<std::size_t>> PlanesAt(const core::TriangleMesh& hull,
                                               const std::vector<Eigen::Vector4d>& planes) {
  std::vector<std::vector<std::size_t>> at(hull.vertices.size());
  for (std::size_t f = 0; f < planes.size(); ++f) {
    for (const int v : hull.triangles[f]) {
      std::vector<std::size_t>& faces = at[static_cast<std::size_t>(v)];
      const bool known = std::any_of(faces.begin(), faces.end(), [&](std::size_t g) {
        return planes[g].head<3>().dot(planes[f].head<3>()) > 1.0 - 1e-8;
      });
      if (!known) faces.push_back(f);
    }
  }
  return at;
}

// Returns the faces of each flat side: one plane with a sufficient share of the surface.
std::vector<std::vector<int>> FlatSides(const core::TriangleMesh& hull,
                                        const std::vector<Eigen::Vector4d>& planes, double same) {
  const double whole = core::SurfaceArea(hull);
  std::vector<bool> taken(planes.size(), false);
  std::vector<std::vector<int>> sides;
  for (std::size_t f = 0; f < planes.size(); ++f) {
    if (taken[f]) continue;
    std::vector<int> side;
    double area = 0.0;
    for (std::size_t g = 0; g < planes.size(); ++g) {
      const bool together = planes[f].head<3>().dot(planes[g].head<3>()) > 1.0 - 1e-8 &&
                            std::abs(planes[f][3] - planes[g][3]) < same;
      if (!together) continue;
      side.push_back(static_cast<int>(g));
      area += 0.5 * core::TriangleAreaVector(hull, static_cast<int>(g)).norm();
    }
    if (area <= kFlatShare * whole) continue;
    for (const int g : side) taken[static_cast<std::size_t>(g)] = true;
    sides.push_back(std::move(side));
  }
  return sides;
}

// For each mirror plane the image of each vertex, or -1.
using Images = std::vector<std::vector<int>>;

// Returns the images under one reflection; empty if some vertex has none.
std::vector<int> ImagesUnder(const std::vector<Vector3d>& vertices, const Vector3d& center,
                             const Vector3d& normal, double tolerance) {
  std::vector<int> images(vertices.size(), -1);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3d image = vertices[i] - 2.0 * normal.dot(vertices[i] - center) * normal;
    double nearest = tolerance * tolerance;
    for (std::size_t j = 0; j < vertices.size(); ++j) {
      const double distance = (vertices[j] - image).squaredNorm();
      if (distance > nearest) continue;
      nearest = distance;
      images[i] = static_cast<int>(j);
    }
    if (images[i] < 0) return {};
  }
  return images;
}

// Returns the images under the mirror planes through the centre and perpendicular to the frame's
// axes, or to the principal axes if more of these are symmetry planes.
Images MirrorImages(const core::TriangleMesh& hull, double diagonal) {
  const MassProperties mass = SolidMassProperties(hull, 1.0);
  const Eigen::Matrix3d principal = PrincipalInertiaOf(mass.inertia).axes.toRotationMatrix();
  Images best;
  for (const Eigen::Matrix3d& axes : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), principal}) {
    Images images;
    for (int k = 0; k < 3; ++k) {
      std::vector<int> of =
          ImagesUnder(hull.vertices, mass.center_of_mass, axes.col(k), kMirrored * diagonal);
      if (!of.empty()) images.push_back(std::move(of));
    }
    if (images.size() > best.size()) best = std::move(images);
  }
  return best;
}

// The selected vertices of a hull, each with its mirror images.
class Selection {
 public:
  Selection(const core::TriangleMesh& hull, const Images& images, int most)
      : hull_(hull), images_(images), most_(most) {}

  // Returns false if the vertex and its images exceed the limit.
  bool Add(int vertex) {
    std::set<int> orbit{vertex};
    for (std::size_t size = 0; size != orbit.size();) {
      size = orbit.size();
      for (const int v : std::vector<int>(orbit.begin(), orbit.end())) {
        for (const std::vector<int>& of : images_) orbit.insert(of[static_cast<std::size_t>(v)]);
      }
    }
    std::set<int> joined = picked_;
    joined.insert(orbit.begin(), orbit.end());
    if (static_cast<int>(joined.size()) > most_) return false;
    picked_ = std::move(joined);
    return true;
  }

  bool Full() const { return static_cast<int>(picked_.size()) >= most_; }
  bool Has(int vertex) const { return picked_.contains(vertex); }

  std::vector<Vector3d> Points() const {
    std::vector<Vector3d> points;
    for (const int v : picked_) points.push_back(hull_.vertices[static_cast<std::size_t>(v)]);
    return points;
  }

 private:
  const core::TriangleMesh& hull_;
  const Images& images_;
  const int most_;
  std::set<int> picked_;
};

// Returns at most `most` corners of a flat side that preserve its area.
std::vector<int> CornersOfSide(const core::TriangleMesh& hull, const std::vector<int>& side,
                               const Vector3d& normal, int most) {
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Eigen::Vector2d> flat;
  std::vector<int> of;
  for (const int f : side) {
    for (const int i : hull.triangles[static_cast<std::size_t>(f)]) {
      const Vector3d& p = hull.vertices[static_cast<std::size_t>(i)];
      flat.emplace_back(u.dot(p), v.dot(p));
      of.push_back(i);
    }
  }
  std::vector<int> corners;
  for (const Eigen::Vector2d& corner : SimplifyConvexPolygon(ConvexHull2d(flat), most, kSideLoss)) {
    const auto at = std::find(flat.begin(), flat.end(), corner);
    corners.push_back(of[static_cast<std::size_t>(at - flat.begin())]);
  }
  return corners;
}

// Adds the vertex that protrudes farthest, repeatedly, while there is room.
void AddFarthest(const core::TriangleMesh& hull, double diagonal, Selection* selection) {
  const std::size_t count = hull.vertices.size();
  std::vector<bool> too_many(count, false);
  std::vector<double> height(count, 0.0);
  for (bool grown = true; !selection->Full();) {
    if (grown) {
      const auto planes =
          FacePlanes(ThickenedConvexHull(selection->Points(), kThinnest * diagonal));
      for (std::size_t i = 0; i < count; ++i)
        height[i] = MaxPlaneDistance(planes, hull.vertices[i]);
    }
    int next = -1;
    double highest = 0.5 * kThinnest * diagonal;
    for (std::size_t i = 0; i < count; ++i) {
      if (too_many[i] || height[i] <= highest || selection->Has(static_cast<int>(i))) continue;
      highest = height[i];
      next = static_cast<int>(i);
    }
    if (next < 0) return;
    grown = selection->Add(next);
    if (!grown) too_many[static_cast<std::size_t>(next)] = true;
  }
}

// Selects vertices of `hull`: first the corners of its flat sides, then the farthest protruding
// ones.
std::vector<Vector3d> PickVertices(const core::TriangleMesh& hull, double diagonal,
                                   int max_vertices) {
  const std::vector<Eigen::Vector4d> planes = FacePlanes(hull);
  const auto sides = FlatSides(hull, planes, kSameHullPlane * diagonal);
  const Images images = MirrorImages(hull, diagonal);
  Selection selection(hull, images, max_vertices);
  const Vector3d middle = core::Bounds(hull).center();
  const auto farthest = std::max_element(
      hull.vertices.begin(), hull.vertices.end(), [&](const Vector3d& a, const Vector3d& b) {
        return (a - middle).squaredNorm() < (b - middle).squaredNorm();
      });
  selection.Add(static_cast<int>(farthest - hull.vertices.begin()));
  const int share = std::max(4, 3 * max_vertices / 4 / std::max<int>(1, sides.size()));
  for (const std::vector<int>& side : sides) {
    const Vector3d normal = planes[static_cast<std::size_t>(side[0])].head<3>();
    for (const int v : CornersOfSide(hull, side, normal, share)) selection.Add(v);
  }
  AddFarthest(hull, diagonal, &selection);
  return selection.Points();
}

// Restores the volume lost with the removed vertices: each vertex moves outward along its faces'
// normals by their protrusion, projected onto the planes of the flat sides, scaled to reach
// `volume`.
core::TriangleMesh GrownToVolume(const core::TriangleMesh& picked,
                                 const std::vector<Vector3d>& points, double volume,
                                 double diagonal) {
  const std::vector<Eigen::Vector4d> planes = FacePlanes(picked);
  const std::vector<double> out = Protrusions(planes, points, kThinnest * 1e-3 * diagonal);
  std::vector<Vector3d> push(picked.vertices.size(), Vector3d::Zero());
  std::vector<double> farthest(picked.vertices.size(), 0.0);
  const auto planes_at = PlanesAt(picked, planes);
  for (std::size_t v = 0; v < push.size(); ++v) {
    for (const std::size_t f : planes_at[v]) {
      push[v] += out[f] * planes[f].head<3>();
      farthest[v] = std::max(farthest[v], out[f]);
    }
  }
  const auto sides = FlatSides(picked, planes, kSameHullPlane * diagonal);
  for (int round = 0; round < 3; ++round) {
    for (const std::vector<int>& side : sides) {
      const Vector3d normal = planes[static_cast<std::size_t>(side[0])].head<3>();
      for (const int f : side) {
        for (const int v : picked.triangles[static_cast<std::size_t>(f)]) {
          push[v] -= normal.dot(push[v]) * normal;
        }
      }
    }
  }
  for (std::size_t v = 0; v < push.size(); ++v) {
    // The projection onto the planes may vanish.
    push[v] = push[v].norm() <= 0.1 * farthest[v] ? Vector3d(Vector3d::Zero())
                                                  : Vector3d(farthest[v] * push[v].normalized());
  }
  const auto grown = [&](double share) {
    std::vector<Vector3d> moved = picked.vertices;
    for (std::size_t v = 0; v < moved.size(); ++v) {
      moved[v] += share * push[v];
      // Stay within the flat sides: move at most half of the distance to each.
      for (const std::vector<int>& side : sides) {
        const Eigen::Vector4d& plane = planes[static_cast<std::size_t>(side[0])];
        const Vector3d normal = plane.head<3>();
        const double most = 0.5 * (plane[3] + normal.dot(picked.vertices[v]));
        moved[v] -= std::max(0.0, normal.dot(moved[v]) - most) * normal;
      }
    }
    return ThickenedConvexHull(moved, kThinnest * diagonal);
  };
  double low = 0.0, high = kMostGrowth;
  if (SignedVolume(grown(high)) <= volume) return grown(high);
  for (int step = 0; step < kGrowthSteps; ++step) {
    const double middle = 0.5 * (low + high);
    (SignedVolume(grown(middle)) < volume ? low : high) = middle;
  }
  return grown(low);
}

}  // namespace

core::TriangleMesh SimplifyHull(const core::TriangleMesh& hull, int max_vertices) {
  if (max_vertices < kMinVertices) {
    throw core::Error("a simplified hull needs at least 16 vertices", "convex hull");
  }
  if (static_cast<int>(hull.vertices.size()) <= max_vertices) return hull;
  if (auto round = SimplifyRoundHull(hull, max_vertices)) return *std::move(round);
  const double diagonal = core::Bounds(hull).diagonal().norm();
  const core::TriangleMesh picked =
      ThickenedConvexHull(PickVertices(hull, diagonal, max_vertices), kThinnest * diagonal);
  return GrownToVolume(picked, hull.vertices, SignedVolume(hull), diagonal);
}

}  // namespace simwright::geometry
