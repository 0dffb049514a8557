// Pieces of the CC0 catalogue become assets of the catalogue's size that pass their check: three,
// at one and three and five sixths of the list, or as many as SIMWRIGHT_CATALOGUE_PIECES says,
// evenly spaced. For all 175: `simwright import` on the catalogue, see docs/figures.md.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "assets/asset_folder.h"
#include "assets/furniture_catalogue.h"
#include "workflows/import/import.h"

namespace simwright::importers {
namespace {

namespace fs = std::filesystem;

TEST(Catalogue, PiecesBecomeAssetsOfTheirTrueSize) {
  const fs::path path = "/usr/share/sweethome3d/furniture/BlendSwap-CC-0.sh3f";
  if (!fs::exists(path)) GTEST_SKIP() << "run ./setup.sh --catalogue";
  const fs::path folder =
      fs::temp_directory_path() / ("simwright_catalogue_" + std::to_string(::getpid()));
  const std::vector<workflows::ImportItem> all = workflows::ListImports({path}, {});
  std::vector<workflows::ImportItem> some;
  const char* const told = std::getenv("SIMWRIGHT_CATALOGUE_PIECES");
  const size_t count = std::clamp<size_t>(told != nullptr ? std::stoul(told) : 3, 1, all.size());
  for (size_t i = 0; i < count; ++i) some.push_back(all[(2 * i + 1) * all.size() / (2 * count)]);
  core::Progress progress;
  const std::vector<workflows::ImportOutcome> outcomes =
      workflows::ImportAll(some, folder, {}, &progress);
  const assets::FurnitureCatalogue catalogue(path);
  int refused = 0;
  for (size_t i = 0; i < outcomes.size(); ++i) {
    if (!outcomes[i].refusal.empty()) {
      ++refused;
      std::printf("refused: %s\n", outcomes[i].refusal.c_str());
      EXPECT_FALSE(fs::exists(folder / outcomes[i].name));
      continue;
    }
    EXPECT_TRUE(outcomes[i].check && outcomes[i].check->passed());
    const assets::Asset asset = assets::ReadAsset(outcomes[i].folder);
    core::TriangleMesh as_given = asset.visual.mesh;
    core::Transform(Eigen::Affine3d(asset.link_from_input.inverse()), &as_given);
    const Eigen::Vector3d size = core::Bounds(as_given).sizes();
    const Eigen::Vector3d wanted = catalogue.pieces()[static_cast<size_t>(some[i].piece)].size_m;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(size[k], wanted[k], 0.01 * wanted[k]) << outcomes[i].name << " axis " << k;
    }
  }
  EXPECT_LE(refused, static_cast<int>(outcomes.size() / 20));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace simwright::importers
