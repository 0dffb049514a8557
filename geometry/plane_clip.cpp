#include "geometry/plane_clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <Eigen/Geometry>

#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
struct VertexNumber {
  int index = -1;
};
struct FaceMark {
  int nesting = -1;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexNumber, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceMark, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_predicates_tag>;

using Borders = std::vector<std::array<int, 2>>;  // undirected edges of vertices

// The rim edges in the plane that remain after opposite ones cancel.
class Rim {
 public:
  void Add(int from, int to) {
    if (from == to) return;
    uses_.push_back({{std::min(from, to), std::max(from, to)}, from < to ? 1 : -1});
  }

  // Returns the undirected edges that the cap's border crosses an odd number of times, ascending.
  // If a crack from rounding breaks a loop open, joins its two ends.
  Borders TakeBorders() {
    std::sort(uses_.begin(), uses_.end());
    Borders borders;
    std::vector<int> ends;
    for (std::size_t i = 0, next = 0; i < uses_.size(); i = next) {
      int net = 0;
      for (next = i; next < uses_.size() && uses_[next].first == uses_[i].first; ++next) {
        net += uses_[next].second;
      }
      if (net % 2 == 0) continue;
      borders.push_back(uses_[i].first);
      ends.insert(ends.end(), uses_[i].first.begin(), uses_[i].first.end());
    }
    std::sort(ends.begin(), ends.end());
    std::vector<int> loose;
    for (std::size_t i = 0, next = 0; i < ends.size(); i = next) {
      while (next < ends.size() && ends[next] == ends[i]) ++next;
      if ((next - i) % 2 == 1) loose.push_back(ends[i]);
    }
    for (std::size_t i = 0; i + 1 < loose.size(); i += 2) {
      borders.push_back({loose[i], loose[i + 1]});
    }
    return borders;
  }

 private:
  std::vector<std::pair<std::array<int, 2>, int>> uses_;  // from the lower vertex: +1; else -1
};

// Marks faces with the parity of borders crossed from the outside.
void MarkNesting(Cdt* cdt) {
  for (auto face = cdt->all_faces_begin(); face != cdt->all_faces_end(); ++face) {
    face->info().nesting = -1;
  }
  std::vector<Cdt::Face_handle> level{cdt->infinite_face()}, next;
  for (int nesting = 0; !level.empty(); ++nesting) {
    next.clear();
    while (!level.empty()) {
      const Cdt::Face_handle face = level.back();
      level.pop_back();
      if (face->info().nesting >= 0) continue;
      face->info().nesting = nesting;
      for (int k = 0; k < 3; ++k) {
        const Cdt::Face_handle other = face->neighbor(k);
        if (other->info().nesting >= 0) continue;
        (cdt->is_constrained({face, k}) ? next : level).push_back(other);
      }
    }
    level.swap(next);
  }
}

// One side of the current cut. `sign` +1 keeps the side of the normal.
struct Side {
  int sign;
  core::TriangleMesh mesh;  // indexes the vertices of the whole cut
  Rim rim;

  void AddPolygon(const int* corner, const bool* on_plane, int count) {
    for (int k = 2; k < count; ++k) {
      mesh.triangles.emplace_back(corner[0], corner[k - 1], corner[k]);
    }
    for (int k = 0; k < count; ++k) {
      const int next = (k + 1) % count;
      if (on_plane[k] && on_plane[next]) rim.Add(corner[k], corner[next]);
    }
  }
};

class Cut {
 public:
  Cut(const core::TriangleMesh& mesh, const CutPlane& plane, double tolerance)
      : plane_(plane), vertices_(mesh.vertices) {
    u_ = plane.normal.unitOrthogonal();
    v_ = plane.normal.cross(u_);
    heights_.resize(vertices_.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const double h = plane.normal.dot(vertices_[i]) - plane.offset;
      heights_[i] = std::abs(h) <= tolerance ? 0.0 : h;
    }
    for (const Vector3i& t : mesh.triangles) AddTriangle(t);
  }

  bool BothSides() const { return !above_.mesh.empty() && !below_.mesh.empty(); }

  core::TriangleMesh Close(bool above) {
    Side& side = above ? above_ : below_;
    AddCap(&side);
    core::TriangleMesh closed;
    std::vector<int> index(vertices_.size(), -1);
    for (Vector3i t : side.mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        if (index[t[k]] < 0) {
          index[t[k]] = static_cast<int>(closed.vertices.size());
          closed.vertices.push_back(vertices_[t[k]]);
        }
        t[k] = index[t[k]];
      }
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) closed.triangles.push_back(t);
    }
    return closed;
  }

 private:
  void AddTriangle(const Vector3i& t) {
    int above = 0, below = 0;
    for (int k = 0; k < 3; ++k) {
      above += heights_[t[k]] > 0.0;
      below += heights_[t[k]] < 0.0;
    }
    if (above + below == 0) return;  // rebuilt with the cap
    if (above == 3 || below == 3) {
      (above == 3 ? above_ : below_).mesh.triangles.push_back(t);
      return;
    }
    for (Side* side : {&above_, &below_}) {
      if ((side->sign > 0 ? above : below) == 0) continue;
      int corner[4];
      bool on_plane[4];
      int count = 0;
      for (int k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        const double ha = side->sign * heights_[a], hb = side->sign * heights_[b];
        if (ha >= 0.0) {
          corner[count] = a;
          on_plane[count++] = ha == 0.0;
        }
        if (ha * hb < 0.0) {
          corner[count] = Crossing(a, b);
          on_plane[count++] = true;
        }
      }
      side->AddPolygon(corner, on_plane, count);
    }
  }

  int Crossing(int a, int b) {
    const int low = std::min(a, b), high = std::max(a, b);
    const std::uint64_t key =
        static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
    const auto [entry, added] = crossings_.try_emplace(key, static_cast<int>(vertices_.size()));
    if (added) {
      const double t = heights_[low] / (heights_[low] - heights_[high]);
      vertices_.push_back(vertices_[low] + t * (vertices_[high] - vertices_[low]));
    }
    return entry->second;
  }

  // The triangles that close a side, seen from above, and the vertices that they replace by others
  // at the same place.
  struct Cap {
    Borders borders;
    std::vector<Vector3i> triangles;
    std::unordered_map<int, int> same;
  };

  void AddCap(Side* side) {
    Borders borders = side->rim.TakeBorders();
    // Both sides have the same borders, unless faces lie in the plane.
    if (borders.empty()) return;
    if (borders != cap_.borders) cap_ = MakeCap(std::move(borders));
    for (Vector3i& t : side->mesh.triangles) {
      for (int k = 0; k < 3 && !cap_.same.empty(); ++k) {
        const auto twin = cap_.same.find(t[k]);
        if (twin != cap_.same.end()) t[k] = twin->second;
      }
    }
    for (Vector3i t : cap_.triangles) {
      if (side->sign > 0) std::swap(t[1], t[2]);
      side->mesh.triangles.push_back(t);
    }
  }

  Cap MakeCap(Borders borders) {
    Cap cap;
    cap.borders = std::move(borders);
    Cdt cdt;
    std::unordered_map<int, Cdt::Vertex_handle> handles;
    const auto handle = [&](int i) {
      const auto [entry, added] = handles.try_emplace(i);
      if (added) {
        const Vector3d& p = vertices_[i];
        entry->second = cdt.insert(Kernel::Point_2(u_.dot(p), v_.dot(p)));
        int& index = entry->second->info().index;
        if (index < 0) {
          index = i;
        } else {
          cap.same[i] = index;
        }
      }
      return entry->second;
    };
    Borders constraints;
    for (const auto& [from, to] : cap.borders) {
      const int a = handle(from)->info().index, b = handle(to)->info().index;
      if (a != b) constraints.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(constraints.begin(), constraints.end());
    for (std::size_t i = 0, next = 0; i < constraints.size(); i = next) {
      while (next < constraints.size() && constraints[next] == constraints[i]) ++next;
      if ((next - i) % 2 == 0) continue;
      cdt.insert_constraint(handles.at(constraints[i][0]), handles.at(constraints[i][1]));
    }
    if (cdt.dimension() < 2) {
      cap.same.clear();
      return cap;
    }
    MarkNesting(&cdt);
    for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
      if (face->info().nesting % 2 == 0) continue;
      Vector3i t;
      for (int k = 0; k < 3; ++k) t[k] = IndexOf(face->vertex(k));
      cap.triangles.push_back(t);
    }
    return cap;
  }

  int IndexOf(Cdt::Vertex_handle vertex) {
    int& index = vertex->info().index;
    if (index < 0) {  // intersection of two borders
      index = static_cast<int>(vertices_.size());
      vertices_.push_back(plane_.normal * plane_.offset + u_ * vertex->point().x() +
                          v_ * vertex->point().y());
    }
    return index;
  }

  CutPlane plane_;
  Vector3d u_, v_;  // u x v = normal
  std::vector<Vector3d> vertices_;
  std::vector<double> heights_;
  std::unordered_map<std::uint64_t, int> crossings_;
  Side above_{1, {}, {}};
  Side below_{-1, {}, {}};
  Cap cap_;  // the last one
};

int ClipRoot(std::vector<int>* parent, int i) {
  while ((*parent)[i] != i) i = (*parent)[i] = (*parent)[(*parent)[i]];
  return i;
}

}  // namespace

std::vector<core::TriangleMesh> ConnectedBodies(core::TriangleMesh mesh) {
  const int n = static_cast<int>(mesh.vertices.size());
  std::vector<int> parent(n);
  std::iota(parent.begin(), parent.end(), 0);
  int components = n, numbered = 0;  // vertices in the order of the triangles, so far
  for (const Vector3i& t : mesh.triangles) {
    const int a = ClipRoot(&parent, t[0]);
    for (const int v : {t[1], t[2]}) {
      const int root = ClipRoot(&parent, v);
      components -= root != a;
      parent[root] = a;
    }
    for (int k = 0; k < 3 && numbered >= 0; ++k) {
      if (t[k] == numbered) ++numbered;
      if (t[k] > numbered) numbered = -1;
    }
  }
  std::vector<core::TriangleMesh> bodies;
  if (components == 1 && numbered == n) {
    bodies.push_back(std::move(mesh));
    return bodies;
  }
  std::vector<int> body_of(n, -1), index(n, -1);
  for (Vector3i t : mesh.triangles) {
    int& body = body_of[ClipRoot(&parent, t[0])];
    if (body < 0) {
      body = static_cast<int>(bodies.size());
      bodies.emplace_back();
    }
    for (int k = 0; k < 3; ++k) {
      if (index[t[k]] < 0) {
        index[t[k]] = static_cast<int>(bodies[body].vertices.size());
        bodies[body].vertices.push_back(mesh.vertices[t[k]]);
      }
      t[k] = index[t[k]];
    }
    bodies[body].triangles.push_back(t);
  }
  if (bodies.size() < 2) return bodies;
  std::vector<core::TriangleMesh> outer, voids;
  for (core::TriangleMesh& body : bodies) {
    (SignedVolume(body) > 0.0 ? outer : voids).push_back(std::move(body));
  }
  for (const core::TriangleMesh& hollow : voids) {
    const Eigen::AlignedBox3d box = core::Bounds(hollow);
    int home = -1;
    double smallest = 0.0;
    for (int i = 0; i < static_cast<int>(outer.size()); ++i) {
      const Eigen::AlignedBox3d around = core::Bounds(outer[i]);
      if (!around.contains(box) || (home >= 0 && around.volume() >= smallest)) continue;
      home = i;
      smallest = around.volume();
    }
    if (home >= 0) core::Append(hollow, &outer[home]);
  }
  return outer;
}

std::vector<core::TriangleMesh> SplitByPlane(const core::TriangleMesh& mesh, const CutPlane& plane,
                                             double tolerance) {
  Cut cut(mesh, plane, tolerance);
  if (!cut.BothSides()) return {};
  std::vector<core::TriangleMesh> pieces;
  double sum = 0.0;
  for (const bool above : {true, false}) {
    for (core::TriangleMesh& piece : ConnectedBodies(cut.Close(above))) {
      sum += SignedVolume(piece);
      pieces.push_back(std::move(piece));
    }
  }
  const double whole = SignedVolume(mesh);
  const double error = std::abs(sum - whole);
  if (error <= 1e-6 * whole) return pieces;
  if (!(error <= 1e-6 * whole + 4.0 * tolerance * core::SurfaceArea(mesh))) return {};
  return pieces;
}

}  // namespace simwright::geometry
