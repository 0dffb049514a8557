// Makes the solids of a whole furniture catalogue: the method, the time, the validity, and the
// distance from the visual mesh (50,000 chords, other than those of MakeSolid's own check).
//   bench_solid_table [CATALOGUE.sh3f] [--only WORD] [--every N]
// The default is Debian's BlendSwap-CC-0 (sweethome3d-furniture, 175 models).
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "assets/furniture_catalogue.h"
#include "assets/mesh_import.h"
#include "core/error.h"
#include "geometry/mesh_validity.h"
#include "geometry/solid.h"
#include "geometry/surface_distance.h"

namespace simwright::bench {
namespace {

namespace fs = std::filesystem;

struct Tally {
  int models = 0;
  int good = 0;
  int valid = 0;
  int refused = 0;
  std::vector<double> seconds;
};

void Measure(const core::TriangleMesh& visual, const std::string& name, Tally* tally) {
  ++tally->models;
  try {
    const auto start = std::chrono::steady_clock::now();
    const geometry::Solid solid = geometry::MakeSolid(visual);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const geometry::MeshValidity state = geometry::Examine(solid.mesh);
    const geometry::SurfaceDistance d = geometry::OuterSurfaceDistance(visual, solid.mesh);
    const bool good = state.IsSolid() && d.MaxRatio() <= 0.005;
    tally->seconds.push_back(seconds);
    tally->valid += state.IsSolid();
    tally->good += good;
    std::printf(
        "%-3s %-32s %-9s faces %7zu -> %6zu  %6.2f s  visual to solid %.3f%% (99%%: %.3f%%)"
        "  solid to mesh %.3f%% (99%%: %.3f%%)%s\n",
        good ? "ok" : "OFF", name.c_str(), geometry::Name(solid.method), visual.triangles.size(),
        solid.mesh.triangles.size(), seconds, 100.0 * d.visual_to_solid_max / d.diagonal,
        100.0 * d.visual_to_solid_p99 / d.diagonal, 100.0 * d.solid_to_visual_max / d.diagonal,
        100.0 * d.solid_to_visual_p99 / d.diagonal,
        state.IsSolid() ? "" : ("  " + geometry::Describe(state)).c_str());
  } catch (const core::Error& error) {
    ++tally->refused;
    std::printf("--- %-32s refused: %s\n", name.c_str(), error.what());
  }
  std::fflush(stdout);
}

int Run(int argc, char** argv) {
  std::string catalogue_path = "/usr/share/sweethome3d/furniture/BlendSwap-CC-0.sh3f";
  std::string only;
  int every = 1;
  for (int a = 1; a < argc; ++a) {
    const std::string word = argv[a];
    if (word == "--only" && a + 1 < argc) {
      only = argv[++a];
    } else if (word == "--every" && a + 1 < argc) {
      every = std::max(1, std::atoi(argv[++a]));
    } else {
      catalogue_path = word;
    }
  }
  const assets::FurnitureCatalogue catalogue(catalogue_path);
  const fs::path folder =
      fs::temp_directory_path() / ("simwright_solid_table_" + std::to_string(::getpid()));
  Tally tally;
  for (std::size_t p = 0; p < catalogue.pieces().size(); p += every) {
    const assets::CataloguePiece& piece = catalogue.pieces()[p];
    if (!only.empty() && piece.model.find(only) == std::string::npos) continue;
    fs::create_directories(folder);
    const core::TexturedMesh mesh = assets::ReadMesh(catalogue.Extract(piece, folder));
    Measure(mesh.mesh, fs::path(piece.model).filename().string(), &tally);
    fs::remove_all(folder);
  }
  std::sort(tally.seconds.begin(), tally.seconds.end());
  if (!tally.seconds.empty()) {
    std::printf(
        "%d models: %d valid, %d valid and within 0.5%% in both directions, %d refused; "
        "median %.2f s, 90%% under %.2f s, slowest %.2f s\n",
        tally.models, tally.valid, tally.good, tally.refused,
        tally.seconds[tally.seconds.size() / 2], tally.seconds[tally.seconds.size() * 9 / 10],
        tally.seconds.back());
  }
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    return simwright::bench::Run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
