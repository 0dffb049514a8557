#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "assets/primitive_meshes.h"
#include "tests/importers/damaged/column_volume.h"
#include "tests/importers/damaged/mesh_damage.h"

namespace simwright::damaged {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;

constexpr int kTruthColumns = 600;

double DiagonalOf(const TriangleMesh& mesh) {
  return core::Bounds(mesh).diagonal().norm();
}

// Returns the sphere of a subdivided octahedron.
TriangleMesh BallMesh(const Vector3d& center, double radius, int splits) {
  TriangleMesh ball;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) ball.vertices.push_back(sign * Vector3d::Unit(axis));
  }
  for (int octant = 0; octant < 8; ++octant) {
    const int x = octant & 1, y = (octant >> 1) & 1, z = (octant >> 2) & 1;
    if ((x + y + z) % 2 == 0) {
      ball.triangles.emplace_back(x, 2 + y, 4 + z);
    } else {
      ball.triangles.emplace_back(x, 4 + z, 2 + y);
    }
  }
  for (int i = 0; i < splits; ++i) {
    ball = Subdivided(ball, 0.75 * std::sqrt(2.0) / std::pow(1.6, i));
    for (Vector3d& v : ball.vertices) v.normalize();
  }
  for (Vector3d& v : ball.vertices) v = center + radius * v;
  return ball;
}

// Returns the distance from `origin` to the mesh along `direction`, or infinity.
double DistanceAlong(const TriangleMesh& mesh, const Vector3d& origin, const Vector3d& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d& a = mesh.vertices[t[0]];
    const Vector3d e1 = mesh.vertices[t[1]] - a, e2 = mesh.vertices[t[2]] - a;
    const Vector3d p = direction.cross(e2);
    const double det = e1.dot(p);
    if (std::abs(det) < 1e-300) continue;
    const Vector3d s = origin - a;
    const double u = s.dot(p) / det;
    const Vector3d q = s.cross(e1);
    const double v = direction.dot(q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
    const double along = e2.dot(q) / det;
    if (along > 0.0) nearest = std::min(nearest, along);
  }
  return nearest;
}

struct Chord {
  Vector3d middle{0, 0, 0};
  Vector3d inward{0, 0, 0};  // unit, from the face where it begins
  double length = 0.0;
};

// Returns chords into the material from the middles of random faces.
std::vector<Chord> SampleChords(const TriangleMesh& mesh, int count, core::Rng* rng) {
  std::vector<Chord> chords;
  const double skip = 1e-6 * DiagonalOf(mesh);
  for (int i = 0; i < count; ++i) {
    const int t = static_cast<int>(core::UniformIndex(*rng, std::ssize(mesh.triangles)));
    const Eigen::Vector3i& f = mesh.triangles[t];
    const Vector3d middle = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3.0;
    const Vector3d inward = -core::TriangleAreaVector(mesh, t).normalized();
    const double length = DistanceAlong(mesh, middle + skip * inward, inward);
    if (std::isfinite(length)) chords.push_back({middle + 0.5 * length * inward, inward, length});
  }
  return chords;
}

void UseTruthOf(const TriangleMesh& sound, Specimen* specimen) {
  specimen->volume = ColumnVolume(sound, kTruthColumns).Volume();
  specimen->sides = core::Bounds(sound).sizes();
  specimen->true_height = specimen->sides.z();
  std::sort(specimen->sides.data(), specimen->sides.data() + 3);
}

}  // namespace

TriangleMesh Subdivided(const TriangleMesh& mesh, double edge) {
  TriangleMesh result = mesh;
  for (int pass = 0; pass < 12; ++pass) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle_of = [&](int a, int b) {
      if ((result.vertices[a] - result.vertices[b]).norm() <= edge) return -1;
      const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b), result.vertices.size());
      if (fresh) {
        result.vertices.push_back(
            (0.5 * (result.vertices[entry->first.first] + result.vertices[entry->first.second]))
                .eval());
      }
      return entry->second;
    };
    std::vector<Eigen::Vector3i> triangles;
    for (const Eigen::Vector3i& t : result.triangles) {
      int m[3];
      int cut = 0;
      for (int k = 0; k < 3; ++k) cut += (m[k] = middle_of(t[k], t[(k + 1) % 3])) >= 0;
      if (cut == 0) {
        triangles.push_back(t);
      } else if (cut == 3) {
        triangles.emplace_back(m[0], m[1], m[2]);
        for (int k = 0; k < 3; ++k) triangles.emplace_back(t[k], m[k], m[(k + 2) % 3]);
      } else {
        // A fan around the middle of one cut edge.
        std::vector<int> ring;
        for (int k = 0; k < 3; ++k) {
          ring.push_back(t[k]);
          if (m[k] >= 0) ring.push_back(m[k]);
        }
        const int hub = static_cast<int>(
            std::find_if(ring.begin(), ring.end(),
                         [&](int v) { return v == m[0] || v == m[1] || v == m[2]; }) -
            ring.begin());
        const int n = static_cast<int>(ring.size());
        for (int k = 1; k + 1 < n; ++k) {
          triangles.emplace_back(ring[hub], ring[(hub + k) % n], ring[(hub + k + 1) % n]);
        }
      }
    }
    result.triangles.swap(triangles);
    if (middles.empty()) break;
  }
  return result;
}

// A ball across the wall: two closed surfaces that intersect.
void AddOverlappingPart(Specimen* specimen, core::Rng* rng) {
  const std::vector<Chord> chords = SampleChords(specimen->mesh, 200, rng);
  const Chord& place =
      *std::max_element(chords.begin(), chords.end(),
                        [](const auto& a, const auto& b) { return a.length < b.length; });
  const double radius =
      std::min(0.56 * place.length, 0.2 * core::Bounds(specimen->mesh).sizes().minCoeff());
  core::Append(
      BallMesh(place.middle - (0.5 * place.length - 0.3 * radius) * place.inward, radius, 3),
      &specimen->mesh);
  UseTruthOf(specimen->mesh, specimen);
}

// A second surface inside the first, a share of the wall away, that faces into the void.
void AddInnerWall(Specimen* specimen, core::Rng* rng) {
  std::vector<double> lengths;
  for (const Chord& chord : SampleChords(specimen->mesh, 300, rng)) {
    lengths.push_back(chord.length);
  }
  std::sort(lengths.begin(), lengths.end());
  const double depth = 0.15 * lengths[lengths.size() / 20];
  TriangleMesh inner = Subdivided(specimen->mesh, 0.05 * DiagonalOf(specimen->mesh));
  const std::vector<Vector3d> normals = core::VertexNormals(inner);
  for (std::size_t v = 0; v < normals.size(); ++v) inner.vertices[v] -= depth * normals[v];
  for (Eigen::Vector3i& t : inner.triangles) std::swap(t[1], t[2]);
  core::Append(inner, &specimen->mesh);
}

// A closed body wholly inside the material, facing outward.
void AddInnerBody(Specimen* specimen, core::Rng* rng) {
  const std::vector<Chord> chords = SampleChords(specimen->mesh, 200, rng);
  const Chord& place =
      *std::max_element(chords.begin(), chords.end(),
                        [](const auto& a, const auto& b) { return a.length < b.length; });
  double free = 0.5 * place.length;
  for (int i = 0; i < 40; ++i) {
    free =
        std::min(free, DistanceAlong(specimen->mesh, place.middle, core::UniformDirection(*rng)));
  }
  core::Append(BallMesh(place.middle, 0.5 * free, 2), &specimen->mesh);
}

// The surface of the cubic cells that are inside.
void MakeStaircase(Specimen* specimen, core::Rng*) {
  const Eigen::AlignedBox3d box = core::Bounds(specimen->mesh);
  const double cell =
      std::max(box.sizes().maxCoeff() / 256.0,
               std::min(box.sizes().maxCoeff() / 128.0, box.sizes().minCoeff() / 64.0));
  const ColumnVolume inside(specimen->mesh,
                            static_cast<int>(box.sizes().head<2>().maxCoeff() / cell));
  const double side = inside.cell();
  const int nx = inside.nx(), ny = inside.ny();
  const int nz = static_cast<int>(std::ceil(box.sizes().z() / side));
  const auto filled = [&](int x, int y, int z) {
    return z >= 0 && z < nz && inside.Inside(x, y, box.min().z() + side * (z + 0.5));
  };
  TriangleMesh steps;
  std::map<std::array<int, 3>, int> index;
  const auto corner = [&](const Eigen::Vector3i& at) {
    const auto [entry, fresh] =
        index.try_emplace({at.x(), at.y(), at.z()}, static_cast<int>(steps.vertices.size()));
    if (fresh) {
      steps.vertices.push_back(Vector3d(inside.origin().x(), inside.origin().y(), box.min().z()) +
                               side * at.cast<double>());
    }
    return entry->second;
  };
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        if (!filled(x, y, z)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          for (const int way : {0, 1}) {
            const Eigen::Vector3i here(x, y, z);
            const Eigen::Vector3i next = here + (2 * way - 1) * Eigen::Vector3i::Unit(axis);
            if (filled(next.x(), next.y(), next.z())) continue;
            const Eigen::Vector3i a = Eigen::Vector3i::Unit((axis + 1) % 3);
            const Eigen::Vector3i b = Eigen::Vector3i::Unit((axis + 2) % 3);
            const Eigen::Vector3i base = here + way * Eigen::Vector3i::Unit(axis);
            const int q[4] = {corner(base), corner(base + a), corner(base + a + b),
                              corner(base + b)};
            const int second = way == 1 ? 1 : 3, last = way == 1 ? 3 : 1;
            steps.triangles.emplace_back(q[0], q[second], q[2]);
            steps.triangles.emplace_back(q[0], q[2], q[last]);
          }
        }
      }
    }
  }
  specimen->mesh = std::move(steps);
  // Thin sides are whole cells now, which no import can undo.
  specimen->sides = core::Bounds(specimen->mesh).sizes();
  specimen->true_height = specimen->sides.z();
  std::sort(specimen->sides.data(), specimen->sides.data() + 3);
}

// A tessellation as fine as that of marching cubes: 120k to 300k faces.
void Tessellate(Specimen* specimen, core::Rng*) {
  double edge = 0.02 * DiagonalOf(specimen->mesh);
  while (specimen->mesh.triangles.size() < 120000) {
    specimen->mesh = Subdivided(specimen->mesh, edge);
    edge *= 0.7;
  }
}

void AddNoise(Specimen* specimen, core::Rng* rng) {
  const double diagonal = DiagonalOf(specimen->mesh);
  if (specimen->mesh.triangles.size() < 20000) {
    specimen->mesh = Subdivided(specimen->mesh, 0.02 * diagonal);
  }
  double edges = 0.0;
  for (const Eigen::Vector3i& t : specimen->mesh.triangles) {
    edges += (specimen->mesh.vertices[t[0]] - specimen->mesh.vertices[t[1]]).norm();
  }
  const double sigma = std::min(0.08 * edges / static_cast<double>(specimen->mesh.triangles.size()),
                                std::min(0.001 * diagonal, 0.003 * specimen->sides.minCoeff()));
  for (Vector3d& v : specimen->mesh.vertices) {
    for (int k = 0; k < 3; ++k) v[k] += sigma * core::Normal(*rng);
  }
}

// Tetrahedra in the air, up to 1 % of the object in size.
void AddSpecks(Specimen* specimen, core::Rng* rng) {
  const Eigen::AlignedBox3d box = core::Bounds(specimen->mesh);
  const double diagonal = box.diagonal().norm();
  const TriangleMesh object = specimen->mesh;
  const int count = 8 + static_cast<int>(core::UniformIndex(*rng, 30));
  for (int i = 0; i < count; ++i) {
    const double size = diagonal * core::Uniform(*rng, 0.002, 0.01);
    const Vector3d direction = core::UniformDirection(*rng);
    const Vector3d at =
        box.center() +
        (0.5 * diagonal + size + diagonal * core::Uniform(*rng, 0.02, 0.3)) * direction;
    core::Append(BallMesh(at, 0.5 * size, 0), &specimen->mesh);
  }
}

// Triangles that hang on an edge of the surface.
void AddFins(Specimen* specimen, core::Rng* rng) {
  TriangleMesh& mesh = specimen->mesh;
  const double diagonal = DiagonalOf(mesh);
  mesh = Subdivided(mesh, 0.05 * diagonal);
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  const std::int64_t faces = std::ssize(mesh.triangles);
  for (int made = 0, tries = 0; made < 6 && tries < 2000; ++tries) {
    const int t = static_cast<int>(core::UniformIndex(*rng, faces));
    const Eigen::Vector3i face = mesh.triangles[t];
    const Vector3d middle = 0.5 * (mesh.vertices[face[0]] + mesh.vertices[face[1]]);
    const Vector3d tip = middle + 0.015 * diagonal * core::TriangleAreaVector(mesh, t).normalized();
    if (!box.contains(tip)) continue;
    mesh.vertices.push_back(tip);
    mesh.triangles.emplace_back(face[0], face[1], static_cast<int>(mesh.vertices.size()) - 1);
    ++made;
  }
}

}  // namespace simwright::damaged
