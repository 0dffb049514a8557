#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/importers/damaged/mesh_damage.h"

namespace simwright::damaged {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;

constexpr double kFineEdge = 0.03;  // share of the diagonal

// Makes faces small enough for local damage.
void MakeFine(TriangleMesh* mesh) {
  if (mesh->triangles.size() > 50000) return;
  *mesh = Subdivided(*mesh, kFineEdge * core::Bounds(*mesh).diagonal().norm());
}

Vector3d MiddleOf(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
}

template <typename Gone>
void RemoveFacesWhere(const Gone& gone, TriangleMesh* mesh) {
  std::vector<Eigen::Vector3i> kept;
  for (int t = 0; t < static_cast<int>(mesh->triangles.size()); ++t) {
    if (!gone(t)) kept.push_back(mesh->triangles[t]);
  }
  mesh->triangles.swap(kept);
}

std::vector<int> RandomFaces(const TriangleMesh& mesh, double share, core::Rng* rng) {
  std::vector<int> faces;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    if (core::Uniform(*rng) < share) faces.push_back(t);
  }
  return faces;
}

}  // namespace

// Round holes, 3 to 7 % of the diagonal across.
void OpenHoles(Specimen* specimen, core::Rng* rng) {
  MakeFine(&specimen->mesh);
  TriangleMesh& mesh = specimen->mesh;
  const double diagonal = core::Bounds(mesh).diagonal().norm();
  const int count = 2 + static_cast<int>(core::UniformIndex(*rng, 3));
  for (int i = 0; i < count; ++i) {
    const int seed = static_cast<int>(core::UniformIndex(*rng, std::ssize(mesh.triangles)));
    const Vector3d at = MiddleOf(mesh, mesh.triangles[seed]);
    const Vector3d normal = core::TriangleAreaVector(mesh, seed).normalized();
    const double radius = diagonal * core::Uniform(*rng, 0.015, 0.035);
    RemoveFacesWhere(
        [&](int t) {
          return (MiddleOf(mesh, mesh.triangles[t]) - at).norm() < radius &&
                 core::TriangleAreaVector(mesh, t).normalized().dot(normal) > 0.5;
        },
        &mesh);
  }
}

// The photo of an object does not show what it stands on.
void RemoveBottom(Specimen* specimen, core::Rng*) {
  MakeFine(&specimen->mesh);
  TriangleMesh& mesh = specimen->mesh;
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  const double below = box.min().z() + 0.01 * box.sizes().z();
  RemoveFacesWhere(
      [&](int t) {
        return MiddleOf(mesh, mesh.triangles[t]).z() < below &&
               core::TriangleAreaVector(mesh, t).normalized().z() < -0.5;
      },
      &mesh);
}

void DoubleFaces(Specimen* specimen, core::Rng* rng) {
  for (const int t : RandomFaces(specimen->mesh, 0.1, rng)) {
    Eigen::Vector3i face = specimen->mesh.triangles[t];
    if (core::Uniform(*rng) < 0.5) std::swap(face[0], face[1]);
    specimen->mesh.triangles.push_back(face);
  }
}

// Faces that lie a hundred-thousandth of the object in front of others and flicker with them.
void DoubleFacesApart(Specimen* specimen, core::Rng* rng) {
  TriangleMesh& mesh = specimen->mesh;
  const double apart = 1e-5 * core::Bounds(mesh).diagonal().norm();
  for (const int t : RandomFaces(mesh, 0.1, rng)) {
    const Vector3d normal = core::TriangleAreaVector(mesh, t).normalized();
    const Eigen::Vector3i face = mesh.triangles[t];
    const int first = static_cast<int>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(mesh.vertices[face[k]] + apart * normal);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
}

void AddDegenerateFaces(Specimen* specimen, core::Rng* rng) {
  TriangleMesh& mesh = specimen->mesh;
  for (const int t : RandomFaces(mesh, 0.05, rng)) {
    const Eigen::Vector3i face = mesh.triangles[t];
    mesh.triangles.emplace_back(face[0], face[0], face[1]);
    mesh.vertices.push_back((0.5 * (mesh.vertices[face[0]] + mesh.vertices[face[1]])).eval());
    mesh.triangles.emplace_back(face[0], face[1], static_cast<int>(mesh.vertices.size()) - 1);
  }
}

// An edge's middle that only one of its two faces has (a T-junction).
void SplitOneSide(Specimen* specimen, core::Rng* rng) {
  TriangleMesh& mesh = specimen->mesh;
  for (const int t : RandomFaces(mesh, 0.08, rng)) {
    const Eigen::Vector3i face = mesh.triangles[t];
    const int middle = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back((0.5 * (mesh.vertices[face[0]] + mesh.vertices[face[1]])).eval());
    mesh.triangles[t] = {face[0], middle, face[2]};
    mesh.triangles.emplace_back(middle, face[1], face[2]);
  }
}

void FlipSomeFaces(Specimen* specimen, core::Rng* rng) {
  for (const int t : RandomFaces(specimen->mesh, 0.3, rng)) {
    std::swap(specimen->mesh.triangles[t][1], specimen->mesh.triangles[t][2]);
  }
}

void FlipAllFaces(Specimen* specimen, core::Rng*) {
  for (Eigen::Vector3i& t : specimen->mesh.triangles) std::swap(t[1], t[2]);
}

// Each face has its own corners, equal to its neighbours' up to rounding.
void SplitVertices(Specimen* specimen, core::Rng* rng) {
  TriangleMesh soup;
  const double apart = 1e-7 * core::Bounds(specimen->mesh).diagonal().norm();
  for (const Eigen::Vector3i& t : specimen->mesh.triangles) {
    const int first = static_cast<int>(soup.vertices.size());
    for (int k = 0; k < 3; ++k) {
      soup.vertices.push_back(specimen->mesh.vertices[t[k]] + apart * core::UniformDirection(*rng));
    }
    soup.triangles.emplace_back(first, first + 1, first + 2);
  }
  specimen->mesh = std::move(soup);
}

// A few vertices that are not numbers.
void LoseVertices(Specimen* specimen, core::Rng* rng) {
  MakeFine(&specimen->mesh);
  for (int i = 0; i < 3; ++i) {
    const std::int64_t v = core::UniformIndex(*rng, std::ssize(specimen->mesh.vertices));
    specimen->mesh.vertices[static_cast<std::size_t>(v)][i] =
        std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace simwright::damaged
