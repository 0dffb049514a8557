// Measures delighting (texture/delighting.h) on photos of known albedo
// (tests/texture/lit_photos.h).
//   bench_delighting_table [--tuned] [--seeds N] [--pictures FOLDER]
// One row per photo: the error of the photo taken as albedo, of the delit photo, and of the photo
// delit with a lumpy mesh (lumps of 3 % of the diagonal), each the RMSE of linear RGB after its own
// best gain; the two ratios to the first; the light's contrast; the share of replaced highlights;
// and the seconds. The kinds are held out; --tuned takes those that the settings were chosen on.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/error.h"
#include "tests/texture/lit_photos.h"
#include "texture/delighting.h"

namespace simwright::bench {
namespace {

struct Row {
  double photo = 0.0, delit = 0.0, lumpy = 0.0;
};

Row MeasureDelighting(const std::string& kind, std::uint64_t seed,
                      const std::filesystem::path& folder) {
  const texture::LitPhoto lit = texture::TakeLitPhoto(kind, seed);
  const auto start = std::chrono::steady_clock::now();
  const texture::DelitPhoto delit = texture::DelightPhoto(lit.mesh, lit.view);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const texture::DelitPhoto lumpy = texture::DelightPhoto(texture::LumpyMesh(lit.mesh), lit.view);
  const Row row{texture::AlbedoError(lit, lit.view.photo), texture::AlbedoError(lit, delit.albedo),
                texture::AlbedoError(lit, lumpy.albedo)};
  std::printf("%-10s %4llu  %.4f  %.4f  %.4f  %5.2f %5.2f  %5.2f  %.3f  %.2f\n", kind.c_str(),
              static_cast<unsigned long long>(seed), row.photo, row.delit, row.lumpy,
              row.delit / row.photo, row.lumpy / row.photo, delit.contrast, delit.highlights,
              seconds);
  if (!folder.empty()) {
    core::Image truth(lit.view.photo.width, lit.view.photo.height, 3, 250);
    for (std::size_t i = 0; i < lit.albedo.size(); ++i) {
      for (std::size_t c = 0; c < 3 && lit.view.alpha.pixels[i] != 0; ++c) {
        truth.pixels[3 * i + c] = static_cast<std::uint8_t>(std::lround(
            255.0f * render::SrgbFromLinear(lit.albedo[i][static_cast<Eigen::Index>(c)])));
      }
    }
    core::WritePng(folder / (kind + "_" + std::to_string(seed) + ".png"),
                   core::ContactSheet({lit.view.photo, delit.albedo, truth}, 3));
  }
  return row;
}

int Run(int argc, char** argv) {
  bool tuned = false;
  int seeds = 3;
  std::filesystem::path folder;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--tuned") == 0) tuned = true;
    if (std::strcmp(argv[i], "--seeds") == 0 && i + 1 < argc) seeds = std::atoi(argv[++i]);
    if (std::strcmp(argv[i], "--pictures") == 0 && i + 1 < argc) folder = argv[++i];
  }
  if (!folder.empty()) std::filesystem::create_directories(folder);
  std::printf("kind       seed   photo   delit   lumpy  ratio lumpy  contr  highl  s\n");
  Row sum;
  double ratio = 0.0, lumpy_ratio = 0.0;
  int count = 0, worse = 0;
  for (const std::string& kind : tuned ? texture::kTunedKinds : texture::kHeldOutKinds) {
    for (int seed = 1; seed <= seeds; ++seed) {
      const Row row =
          MeasureDelighting(kind, static_cast<std::uint64_t>(seed + (tuned ? 100 : 10)), folder);
      sum.photo += row.photo;
      sum.delit += row.delit;
      sum.lumpy += row.lumpy;
      ratio += row.delit / row.photo;
      lumpy_ratio += row.lumpy / row.photo;
      worse += row.delit > row.photo ? 1 : 0;
      ++count;
    }
  }
  std::printf(
      "%d photos: mean error %.4f -> %.4f (%.2f), lumpy %.4f (%.2f); mean ratio %.2f, lumpy "
      "%.2f; worse: %d\n",
      count, sum.photo / count, sum.delit / count, sum.delit / sum.photo, sum.lumpy / count,
      sum.lumpy / sum.photo, ratio / count, lumpy_ratio / count, worse);
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
