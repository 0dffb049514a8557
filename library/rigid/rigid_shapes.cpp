#include "library/rigid/rigid_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kPi = std::numbers::pi;

bool IsPoint(const Ring& ring) {
  return ring.x <= 0.0 && ring.y <= 0.0;
}

// Adds the triangle if its corners differ.
void AddTriangle(int a, int b, int c, int look, core::TexturedMesh* mesh) {
  if (a == b || b == c || c == a) return;
  mesh->mesh.triangles.push_back({a, b, c});
  mesh->triangle_material.push_back(look);
}

void AddBand(const std::vector<int>& low, const std::vector<int>& high, int look,
             core::TexturedMesh* mesh) {
  const size_t count = low.size();
  for (size_t k = 0; k < count; ++k) {
    const size_t next = (k + 1) % count;
    AddTriangle(low[k], low[next], high[next], look, mesh);
    AddTriangle(low[k], high[next], high[k], look, mesh);
  }
}

}  // namespace

std::vector<Eigen::Vector2d> CircleOutline(int points) {
  std::vector<Eigen::Vector2d> outline;
  for (int k = 0; k < points; ++k) {
    const double angle = 2.0 * kPi * k / points;
    outline.emplace_back(std::cos(angle), std::sin(angle));
  }
  return outline;
}

std::vector<Eigen::Vector2d> RoundedSquareOutline(double corner, int points_a_corner) {
  std::vector<Eigen::Vector2d> outline;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double turn = 0.5 * kPi * quarter;
    const Eigen::Vector2d center =
        (1.0 - corner) *
        Eigen::Vector2d(quarter == 0 || quarter == 3 ? 1 : -1, quarter < 2 ? 1 : -1);
    for (int k = 0; k < points_a_corner; ++k) {
      const double angle = turn + 0.5 * kPi * k / (points_a_corner - 1);
      outline.push_back(center + corner * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
  }
  return outline;
}

core::TexturedMesh Loft(const std::vector<Ring>& rings, const std::vector<Eigen::Vector2d>& outline,
                        const std::vector<core::Material>& looks) {
  core::TexturedMesh mesh;
  mesh.materials = looks;
  std::vector<std::vector<int>> indices;
  for (const Ring& ring : rings) {
    std::vector<int>& of_ring = indices.emplace_back();
    for (const Eigen::Vector2d& p : outline) {
      if (of_ring.empty() || !IsPoint(ring)) {
        mesh.mesh.vertices.push_back({ring.x * p.x(), ring.y * p.y(), ring.z});
      }
      of_ring.push_back(static_cast<int>(mesh.mesh.vertices.size()) - 1);
    }
  }
  for (size_t i = 0; i + 1 < rings.size(); ++i) {
    AddBand(indices[i], indices[i + 1], rings[i + 1].look, &mesh);
  }
  if (!IsPoint(rings.front())) AddBand(indices.back(), indices.front(), rings.front().look, &mesh);
  return mesh;
}

core::TexturedMesh Revolved(const std::vector<ProfilePoint>& profile,
                            const std::vector<core::Material>& looks) {
  std::vector<Ring> rings;
  for (const ProfilePoint& p : profile) rings.push_back({p.r, p.r, p.z, p.look});
  return Loft(rings, CircleOutline(), looks);
}

std::vector<ProfilePoint> Smooth(const std::vector<ProfilePoint>& points, int steps) {
  std::vector<ProfilePoint> curve{points.front()};
  const auto at = [&](long i) {
    return points[static_cast<size_t>(
        std::clamp<long>(i, 0, static_cast<long>(points.size()) - 1))];
  };
  for (long i = 0; i + 1 < static_cast<long>(points.size()); ++i) {
    const ProfilePoint a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    for (int k = 1; k <= steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      const auto mix = [t](double p0, double p1, double p2, double p3) {
        return 0.5 * (2.0 * p1 + t * (p2 - p0) + t * t * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) +
                      t * t * t * (3.0 * p1 - p0 - 3.0 * p2 + p3));
      };
      curve.push_back({std::max(0.0, mix(a.r, b.r, c.r, d.r)), mix(a.z, b.z, c.z, d.z), c.look});
    }
  }
  curve.back() = points.back();
  return curve;
}

std::vector<ProfilePoint> VesselProfile(const std::vector<ProfilePoint>& outer, double thickness,
                                        double floor) {
  std::vector<ProfilePoint> profile{{0.0, outer.front().z, outer.front().look}};
  profile.insert(profile.end(), outer.begin(), outer.end());
  const double bottom = outer.front().z + floor;
  for (auto p = outer.rbegin(); p != outer.rend() && p->z > bottom + 1e-9; ++p) {
    profile.push_back({std::max(p->r - thickness, 0.2 * p->r), p->z, p->look});
  }
  // Finds the outer point above the floor's height.
  size_t above = 1;
  while (above + 1 < outer.size() && outer[above].z <= bottom) ++above;
  const ProfilePoint &low = outer[above - 1], &high = outer[above];
  const double share = std::clamp((bottom - low.z) / (high.z - low.z), 0.0, 1.0);
  const double outside = low.r + share * (high.r - low.r);
  profile.push_back({std::max(outside - thickness, 0.2 * outside), bottom, low.look});
  profile.push_back({0.0, bottom, profile.back().look});
  return profile;
}

core::TexturedMesh AlongX(core::TexturedMesh mesh) {
  for (Eigen::Vector3d& v : mesh.mesh.vertices) v = Eigen::Vector3d(v.z(), v.x(), v.y());
  return mesh;
}

core::TexturedMesh AlongY(core::TexturedMesh mesh) {
  for (Eigen::Vector3d& v : mesh.mesh.vertices) v = Eigen::Vector3d(v.x(), -v.z(), v.y());
  return mesh;
}

core::TexturedMesh Sheet(const std::vector<Station>& stations, double thickness,
                         const std::vector<core::Material>& looks) {
  constexpr int kAcross = 8;
  core::TexturedMesh mesh;
  mesh.materials = looks;
  std::vector<std::vector<int>> loops;  // around each station: below from -y to y, then back above
  for (const Station& s : stations) {
    std::vector<int>& loop = loops.emplace_back();
    for (int k = 0; k < 2 * (kAcross + 1); ++k) {
      const bool above = k > kAcross;
      const double share = 2.0 * (above ? 2 * kAcross + 1 - k : k) / kAcross - 1.0;
      mesh.mesh.vertices.push_back(
          {s.x, share * s.half_width, s.z + s.dish * share * share + (above ? thickness : 0.0)});
      loop.push_back(static_cast<int>(mesh.mesh.vertices.size()) - 1);
    }
  }
  for (size_t i = 0; i + 1 < loops.size(); ++i) {
    AddBand(loops[i], loops[i + 1], stations[i + 1].look, &mesh);
  }
  for (int k = 0; k < kAcross; ++k) {  // the ends, one quad between below and above
    const auto cap = [&](const std::vector<int>& loop, bool front, int look) {
      const int a = loop[static_cast<size_t>(k)], b = loop[static_cast<size_t>(k + 1)];
      const int c = loop[static_cast<size_t>(2 * kAcross - k)];
      const int d = loop[static_cast<size_t>(2 * kAcross + 1 - k)];
      AddTriangle(a, front ? c : b, front ? b : c, look, &mesh);
      AddTriangle(a, front ? d : c, front ? c : d, look, &mesh);
    };
    cap(loops.front(), true, stations.front().look);
    cap(loops.back(), false, stations.back().look);
  }
  return mesh;
}

core::TexturedMesh TaperedTube(const std::vector<TubeSection>& path, const core::Material& look) {
  constexpr int kRound = 16;
  core::TexturedMesh mesh;
  mesh.materials = {look};
  std::vector<std::vector<int>> rings;
  const auto point = [&](size_t i) { return Eigen::Vector2d(path[i].x, path[i].z); };
  for (size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector2d before = point(i == 0 ? 0 : i - 1);
    const Eigen::Vector2d after = point(std::min(i + 1, path.size() - 1));
    const Eigen::Vector2d along = (after - before).normalized();
    const Eigen::Vector2d normal(-along.y(), along.x());
    std::vector<int>& ring = rings.emplace_back();
    for (int k = 0; k < kRound; ++k) {
      const double angle = 2.0 * kPi * k / kRound;
      const Eigen::Vector2d at = point(i) + path[i].half_thick * std::cos(angle) * normal;
      mesh.mesh.vertices.push_back({at.x(), -path[i].half_across * std::sin(angle), at.y()});
      ring.push_back(static_cast<int>(mesh.mesh.vertices.size()) - 1);
    }
  }
  const auto middle = [&](const Eigen::Vector2d& at) {
    mesh.mesh.vertices.push_back({at.x(), 0.0, at.y()});
    return std::vector<int>(kRound, static_cast<int>(mesh.mesh.vertices.size()) - 1);
  };
  AddBand(middle(point(0)), rings.front(), 0, &mesh);
  for (size_t i = 0; i + 1 < rings.size(); ++i) AddBand(rings[i], rings[i + 1], 0, &mesh);
  AddBand(rings.back(), middle(point(path.size() - 1)), 0, &mesh);
  return mesh;
}

core::TexturedMesh Tube(const std::vector<Eigen::Vector2d>& path_xz, double half_across,
                        double half_thick, const core::Material& look) {
  std::vector<TubeSection> path;
  for (const Eigen::Vector2d& at : path_xz) {
    path.push_back({at.x(), at.y(), half_across, half_thick});
  }
  return TaperedTube(path, look);
}

core::TexturedMesh Bar(const std::vector<BarSection>& sections,
                       const std::vector<Eigen::Vector2d>& outline,
                       const std::vector<core::Material>& looks) {
  std::vector<Ring> rings{{0, 0, sections.front().x, sections.front().look}};
  for (const BarSection& s : sections) {
    rings.push_back({0.5 * (s.y_high - s.y_low), 0.5 * (s.z_high - s.z_low), s.x, s.look});
  }
  rings.push_back({0, 0, sections.back().x, sections.back().look});
  core::TexturedMesh mesh = AlongX(Loft(rings, outline, looks));
  // A loft's rings are about its axis; the first and the last vertex are the ends' centres.
  for (size_t i = 0; i < mesh.mesh.vertices.size(); ++i) {
    const size_t section = i == 0 ? 0 : std::min((i - 1) / outline.size(), sections.size() - 1);
    const BarSection& s = sections[section];
    mesh.mesh.vertices[i] +=
        Eigen::Vector3d(0.0, 0.5 * (s.y_low + s.y_high), 0.5 * (s.z_low + s.z_high));
  }
  return mesh;
}

core::TexturedMesh PaintedBox(const Eigen::Vector3d& size, double bevel,
                              const std::vector<core::Material>& looks,
                              const std::function<int(const Eigen::Vector3d&)>& look_of) {
  core::TexturedMesh mesh;
  mesh.mesh = Box(-0.5 * size, 0.5 * size, bevel);
  mesh.materials = looks;
  for (size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    const Eigen::Vector3d normal = core::TriangleAreaVector(mesh.mesh, static_cast<int>(t));
    mesh.triangle_material.push_back(look_of(normal.normalized()));
  }
  return mesh;
}

void Join(const core::TexturedMesh& addition, core::TexturedMesh* mesh) {
  core::Append(addition.mesh, &mesh->mesh);
  const int first = static_cast<int>(mesh->materials.size());
  for (const int look : addition.triangle_material) mesh->triangle_material.push_back(first + look);
  mesh->materials.insert(mesh->materials.end(), addition.materials.begin(),
                         addition.materials.end());
}

void Move(const Eigen::Vector3d& by, core::TexturedMesh* mesh) {
  for (Eigen::Vector3d& v : mesh->mesh.vertices) v += by;
}

void Flatten(double share, core::TexturedMesh* mesh) {
  const Eigen::AlignedBox3d box = core::Bounds(mesh->mesh);
  const double foot = box.min().z() + share * box.sizes().z();
  for (Eigen::Vector3d& v : mesh->mesh.vertices) v.z() = std::max(v.z(), foot);
}

Eigen::Affine3d FitOf(const Eigen::Vector3d& size, const Eigen::AlignedBox3d& bounds) {
  const Eigen::Vector3d base(bounds.center().x(), bounds.center().y(), bounds.min().z());
  return Eigen::Scaling(Eigen::Vector3d(size.cwiseQuotient(bounds.sizes()))) *
         Eigen::Translation3d(-base);
}

}  // namespace simwright::library
