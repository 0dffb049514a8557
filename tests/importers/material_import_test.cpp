// The materials of an imported mesh, in the asset and as MuJoCo's own loader reads them.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "assets/pbr_look.h"
#include "core/files.h"
#include "core/image.h"
#include "tests/workflows/program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

constexpr int kOrange[3] = {220, 120, 30};

core::Image OneColor(int r, int g, int b) {
  core::Image image(8, 8, 3);
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    image.pixels[i] = static_cast<std::uint8_t>(r);
    image.pixels[i + 1] = static_cast<std::uint8_t>(g);
    image.pixels[i + 2] = static_cast<std::uint8_t>(b);
  }
  return image;
}

// A cube of 0.1 m, each side of which shows the whole texture.
std::string CubeObj() {
  std::string text = "mtllib cube.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  for (int i = 0; i < 8; ++i) {
    text += "v " + std::to_string(0.1 * (i & 1)) + " " + std::to_string(0.1 * (i >> 1 & 1)) + " " +
            std::to_string(0.1 * (i >> 2)) + "\n";
  }
  text += "usemtl lacquer\n";
  constexpr int kSides[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
  for (const auto& side : kSides) {
    text += "f";
    for (int k = 0; k < 4; ++k) {
      text += " " + std::to_string(side[k]) + "/" + std::to_string(k + 1);
    }
    text += "\n";
  }
  return text;
}

class ImportedMaterial : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path folder = folder_.path();
    core::WriteFile(folder / "cube.obj", CubeObj());
    core::WriteFile(folder / "cube.mtl",
                    "newmtl lacquer\nKd 1 1 1\nmap_Kd colour.png\nPm 0.25\nPr 0.5\n"
                    "map_Pr rough.png\nnorm normal.png\n");
    core::WritePng(folder / "colour.png", OneColor(kOrange[0], kOrange[1], kOrange[2]));
    core::WritePng(folder / "rough.png", OneColor(128, 128, 128));
    core::WritePng(folder / "normal.png", OneColor(128, 128, 255));
    const Outcome outcome = RunProgram("import " + (folder / "cube.obj").string() +
                                       " --category box --up z -o " + (folder / "out").string());
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(outcome.text.find("mtl-not-read"), std::string::npos) << outcome.text;
  }
  fs::path Asset() const { return folder_.path() / "out" / "cube"; }
  const core::TemporaryFolder folder_;
};

TEST_F(ImportedMaterial, IsStatedByTheFolder) {
  const assets::PbrLook look = assets::ReadPbrLook(Asset());
  ASSERT_FALSE(look.empty());
  const auto lacquer =
      std::find_if(look.materials.begin(), look.materials.end(),
                   [](const assets::PbrMaterial& one) { return one.normal_map >= 0; });
  ASSERT_NE(lacquer, look.materials.end());
  EXPECT_FLOAT_EQ(lacquer->metallic, 0.25f);
  EXPECT_FLOAT_EQ(lacquer->roughness, 0.5f);
  EXPECT_EQ(look.images.at(lacquer->roughness_map).pixels.at(0), 128);
}

TEST_F(ImportedMaterial, IsReadByMujoco) {
  char error[500] = "";
  mjModel* model = mj_loadXML((Asset() / "cube.xml").c_str(), nullptr, error, sizeof error);
  ASSERT_NE(model, nullptr) << error;
  ASSERT_EQ(model->nmat, 1);
  const double gloss = 1.0 - 0.5 * 128 / 255;
  EXPECT_NEAR(model->mat_shininess[0], gloss, 1e-5);
  EXPECT_NEAR(model->mat_specular[0], gloss * (0.5 + 0.5 * 0.25), 1e-5);
  ASSERT_EQ(model->ntex, 1);
  EXPECT_EQ(model->mat_texid[0], 0);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(model->tex_rgb[k], kOrange[k]);
  int shown = 0;
  for (int g = 0; g < model->ngeom; ++g) shown += model->geom_matid[g] == 0;
  EXPECT_EQ(shown, 1);
  mj_deleteModel(model);
}

// A lit side of the preview has the hue of the texture under the lacquer's reflections of white
// light, not the grey of a missing one.
TEST_F(ImportedMaterial, IsSeenInThePreview) {
  const core::Image preview = core::ReadImage(Asset() / "preview.png");
  int orange = 0;
  for (int y = 0; y < preview.height / 2; ++y) {  // collision parts are below
    for (int x = 0; x < preview.width; ++x) {
      const std::uint8_t* p = preview.At(x, y);
      const double r = p[0], g = p[1], b = p[2];
      orange += r > 60 && std::abs(g / r - kOrange[1] / 220.0) < 0.3 &&
                std::abs(b / r - kOrange[2] / 220.0) < 0.3 && r > 1.15 * g && g > 1.15 * b;
    }
  }
  EXPECT_GT(orange, preview.width * preview.height / 40);
}

}  // namespace
}  // namespace simwright
