// A few files of the corpus of damaged meshes; bench_damaged_corpus_table imports all.
#include "tests/importers/damaged/damaged_corpus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "assets/primitive_meshes.h"
#include "core/files.h"
#include "tests/importers/damaged/column_volume.h"

namespace simwright::damaged {
namespace {

TEST(DamagedCorpus, CoversKindsAndDamages) {
  std::map<std::string, int> damages;
  std::set<std::string> kinds;
  std::size_t most = 0;
  const std::vector<Recipe> recipes = CorpusRecipes();
  for (const Recipe& recipe : recipes) {
    kinds.insert(recipe.kind);
    most = std::max(most, recipe.damages.size());
    for (const std::string& damage : recipe.damages) ++damages[damage];
  }
  EXPECT_GE(recipes.size(), 100u);
  EXPECT_EQ(kinds.size(), 30u);
  EXPECT_GE(damages.size(), 24u);
  EXPECT_EQ(most, 4u);
  for (const auto& [damage, count] : damages) EXPECT_GE(count, 5) << damage;
}

// The measure of the truth itself, against closed formulas.
TEST(DamagedCorpus, TheTruthIsExactEnough) {
  const ColumnVolume box(assets::BoxMesh({0.3, 0.2, 0.1}), 600);
  EXPECT_NEAR(box.Volume() / 0.006, 1.0, 1e-9);
  Specimen ball = SoundSpecimen("ball", 1);
  const double radius = 0.5 * ball.sides.x();
  EXPECT_NEAR(ball.volume / (4.0 / 3.0 * M_PI * std::pow(radius, 3)), 1.0, 0.02);
  // Two balls that overlap by half a radius.
  core::TriangleMesh two = ball.mesh;
  for (Eigen::Vector3d& v : two.vertices) v.x() += 1.5 * radius;
  core::Append(ball.mesh, &two);
  const double cap = M_PI * 0.25 * 0.25 * (3.0 - 0.25) / 3.0 * std::pow(radius, 3);
  EXPECT_NEAR(ColumnVolume(two, 600).Volume() / (2.0 * ball.volume - 2.0 * cap), 1.0, 0.01);
}

class DamagedMesh : public ::testing::TestWithParam<std::vector<std::string>> {};

TEST_P(DamagedMesh, BecomesAnAssetOfTheTrueSizeAndVolume) {
  const core::TemporaryFolder folder;
  Recipe recipe;
  recipe.kind = GetParam()[0];
  recipe.format = GetParam()[1];
  recipe.damages.assign(GetParam().begin() + 2, GetParam().end());
  const Trial trial = ImportSpecimen(DamagedSpecimen(recipe), recipe.kind, folder.path());
  EXPECT_EQ(trial.verdict, Verdict::kRight)
      << Name(trial.verdict) << " " << trial.reason << " sides " << trial.side_error << " volume "
      << trial.volume_error;
  EXPECT_LE(trial.side_error, 0.02);
  EXPECT_LE(std::abs(trial.volume_error), 0.05);
}

INSTANTIATE_TEST_SUITE_P(
    Corpus, DamagedMesh,
    ::testing::Values(std::vector<std::string>{"brick", "obj", "holes", "flipped-faces", "specks"},
                      std::vector<std::string>{"soap", "stl", "no-bottom", "unwelded"},
                      std::vector<std::string>{"egg", "glb", "inner-wall", "inside-out"},
                      std::vector<std::string>{"can", "ply", "inner-body", "double-faces"},
                      std::vector<std::string>{"cereal_box", "glb", "fins", "pbr-textures"},
                      std::vector<std::string>{"die", "ply", "coplanar-faces", "centimetres"},
                      std::vector<std::string>{"bowl", "ply", "lost-vertices", "vertex-colors"},
                      std::vector<std::string>{"lemon", "glb", "mirrored-node", "unit-box"},
                      std::vector<std::string>{"candle", "obj", "degenerate-faces", "y-up"},
                      std::vector<std::string>{"pear", "stl", "t-junctions", "inches"},
                      std::vector<std::string>{"cutting_board", "glb", "overlapping-part",
                                               "staircase"},
                      std::vector<std::string>{"die", "ply", "inner-wall", "lost-vertices"}));

}  // namespace
}  // namespace simwright::damaged
