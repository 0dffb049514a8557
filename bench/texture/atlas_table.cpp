// Measures the texture atlas (texture/uv_atlas.h) on a texture of 1024 pixels with margins of 2.
//   bench_atlas_table [--size N] [MESH...]
// MESH: more mesh files. Columns: the faces; the share of the texels that are covered; the distance
// of neighbouring texels on the surface (mm, root mean square: what packing and stretch cost
// together); the L2 stretch; the charts; the length of the seams over that of all edges; the texels
// that two triangles share; the free texels between the two nearest charts (of 4); the time; and
// whether a second call gives the same bytes.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "assets/mesh_import.h"
#include "bench/geometry/decomposition_shapes.h"
#include "core/error.h"
#include "geometry/weld.h"
#include "library/rigid/rigid_kinds.h"
#include "tests/texture/atlas_quality.h"
#include "texture/uv_atlas.h"

namespace simwright::bench {
namespace {

using Uvs = std::vector<Eigen::Vector2f>;

struct Method {
  std::string name;
  std::function<Uvs(const core::TriangleMesh&, const texture::AtlasOptions&)> unwrap;
};

std::vector<Method> Methods() {
  return {{"atlas", texture::UnwrapToAtlas}};
}

// Returns a lumpy closed surface of some 20,000 faces, as a reconstruction from a photo gives.
core::TriangleMesh Lump() {
  const auto distance = [](const Eigen::Vector3d& p) {
    const double wave = std::sin(40.0 * p.x()) * std::sin(50.0 * p.y() + 1.0) +
                        0.4 * std::sin(130.0 * p.z()) * std::cos(110.0 * p.x());
    return p.cwiseQuotient(Eigen::Vector3d(1.0, 0.8, 1.2)).norm() - 0.08 - 0.008 * wave;
  };
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-0.12), Eigen::Vector3d::Constant(0.12));
  geometry::SimplifyOptions options;
  options.face_budget = 12000;  // of a lift
  return geometry::Simplify(shapes::Implicit(box, .0025, distance), options);
}

std::vector<NamedSolid> Meshes(const std::vector<std::string>& files) {
  std::vector<NamedSolid> meshes{{"lump", Lump()}, {"ball", shapes::Icosphere(4)}};
  for (const NamedSolid& solid : AllSolids()) {
    for (const char* name : {"torus", "gear", "table", "pan", "mug"}) {
      if (solid.name == name) meshes.push_back(solid);
    }
  }
  for (const char* name : {"teapot", "bottle", "screwdriver", "toy_train", "pear"}) {
    const library::RigidKind* kind = library::FindRigidKind(name);
    if (kind) meshes.push_back({name, library::MakeRigidObject(*kind, 1).visual.mesh});
  }
  meshes.push_back(
      {"chair.obj", assets::ReadMesh(SIMWRIGHT_SOURCE_DIR "/examples/chair.obj").mesh});
  for (const std::string& file : files) {
    meshes.push_back(
        {std::filesystem::path(file).filename().string(), assets::ReadMesh(file).mesh});
  }
  for (NamedSolid& mesh : meshes) mesh.mesh = geometry::Weld(mesh.mesh, 0.0);
  return meshes;
}

bool SameBytes(const Uvs& one, const Uvs& other) {
  return one.size() == other.size() &&
         std::memcmp(one.data(), other.data(), one.size() * sizeof(one[0])) == 0;
}

void PrintRow(const NamedSolid& solid, const Method& method, int size) {
  texture::AtlasOptions options;
  options.size = size;
  try {
    const auto start = std::chrono::steady_clock::now();
    const Uvs uvs = method.unwrap(solid.mesh, options);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    const atlas_quality::AtlasMeasures m =
        atlas_quality::MeasureAtlas(solid.mesh, uvs, size, options.padding);
    std::printf("%-11s %-8s %6zu %6.1f%% %8.4f %7.4f %6d %6.1f%% %6d %4d %5d %5d %9.1f %s\n",
                solid.name.c_str(), method.name.c_str(), solid.mesh.triangles.size(),
                100.0 * m.covered, 1e3 * m.spacing, m.stretch, m.charts, 100.0 * m.seams,
                m.shared_texels, m.nearest_charts, m.outside, m.reversed, 1e3 * passed.count(),
                SameBytes(uvs, method.unwrap(solid.mesh, options)) ? "same" : "DIFFERENT");
  } catch (const core::Error& error) {
    std::printf("%-11s %-8s %s\n", solid.name.c_str(), method.name.c_str(), error.what());
  }
  std::fflush(stdout);
}

int Main(int argc, char** argv) {
  int size = 1024;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--size" && i + 1 < argc) {
      size = std::max(16, std::atoi(argv[++i]));
    } else {
      files.push_back(argv[i]);
    }
  }
  std::printf("%-11s %-8s %6s %7s %8s %7s %6s %7s %6s %4s %5s %5s %9s %s\n", "mesh", "method",
              "faces", "covered", "mm", "stretch", "charts", "seams", "shared", "free", "out",
              "rev", "ms", "again");
  for (const NamedSolid& solid : Meshes(files)) {
    for (const Method& method : Methods()) PrintRow(solid, method, size);
  }
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    return simwright::bench::Main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
