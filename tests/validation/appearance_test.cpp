// The judgement of looks: each measure is 1 or 0 for an object that is its own photo, and
// moves by known amounts when the object is damaged.
#include "validation/appearance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "assets/camera_file.h"
#include "core/error.h"
#include "core/files.h"
#include "physics_params/knowledge_base.h"
#include "render/forward.h"
#include "render/scene.h"

namespace simwright::validation {
namespace {

constexpr int kCells = 24;  // along each side of a face of the block

// A block of 0.2 x 0.1 x 0.15 m on z = 0, `bulge` (m) of its faces outward in their middle. Each
// face shows the whole texture.
core::TexturedMesh Block(double bulge, const core::Image& texture) {
  const Eigen::Vector3d half(0.1, 0.05, 0.075);
  core::TexturedMesh block;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double side = face % 2 == 0 ? -1.0 : 1.0;
    const int first = static_cast<int>(block.mesh.vertices.size());
    for (int i = 0; i <= kCells; ++i) {
      for (int j = 0; j <= kCells; ++j) {
        const double a = 2.0 * i / kCells - 1.0, b = 2.0 * j / kCells - 1.0;
        Eigen::Vector3d p;
        p[axis] = side * (half[axis] + bulge * (1 - a * a) * (1 - b * b));
        p[u] = a * half[u];
        p[v] = b * half[v];
        block.mesh.vertices.push_back(p + Eigen::Vector3d(0, 0, half.z()));
      }
    }
    const auto uv = [&](int index) {
      const int k = index - first;
      block.corner_uvs.push_back({static_cast<float>(k / (kCells + 1)) / kCells,
                                  static_cast<float>(k % (kCells + 1)) / kCells});
    };
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        const int a = first + i * (kCells + 1) + j, b = a + kCells + 1;
        for (Eigen::Vector3i t : {Eigen::Vector3i(a, b, a + 1), Eigen::Vector3i(b, b + 1, a + 1)}) {
          if (side < 0.0) std::swap(t[1], t[2]);
          block.mesh.triangles.push_back(t);
          for (int c = 0; c < 3; ++c) uv(t[c]);
        }
      }
    }
  }
  block.triangle_material.assign(block.mesh.triangles.size(), 0);
  block.materials.push_back({"print", {1, 1, 1, 1}, 0});
  block.textures.push_back(texture);
  return block;
}

core::Image Checkers(int cell) {
  core::Image image(96, 96, 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int value = (x / cell + y / cell) % 2 ? 210 : 60;
      std::fill_n(image.At(x, y), 3, static_cast<std::uint8_t>(value));
    }
  }
  return image;
}

AssetPhoto PhotoOf(const core::TexturedMesh& mesh) {
  AssetPhoto photo;
  photo.camera =
      core::OrbitCamera({0, 0, 0.075}, 0.6, 0.4, -0.5 * std::numbers::pi + 0.5, 0.5, 320, 240);
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.lit = false;
  photo.cut_out = render::RenderForward(scene, photo.camera, options).color;
  return photo;
}

assets::Asset BoxAsset(const core::TexturedMesh& visual) {
  assets::Asset asset;
  asset.name = "block";
  for (const auto& category : physics_params::KnowledgeBase::Shipped().categories()) {
    if (category.shape == physics_params::Shape::kBox) asset.parameters.category = category.name;
  }
  asset.visual = visual;
  return asset;
}

double FigureOf(const Appearance& appearance, const std::string& code) {
  for (const core::Finding& row : appearance.measures) {
    if (row.code == code) return row.figure;
  }
  return NAN;
}

TEST(Appearance, OfAnObjectThatIsItsPhotoIsA) {
  const core::TexturedMesh block = Block(0.0, Checkers(12));
  const Appearance appearance = JudgeAppearance(BoxAsset(block), PhotoOf(block));
  EXPECT_NEAR(FigureOf(appearance, "outline"), 1.0, 1e-9);
  EXPECT_NEAR(FigureOf(appearance, "texture"), 1.0, 1e-9);
  EXPECT_NEAR(FigureOf(appearance, "hidden-texture"), 1.0, 0.25);
  EXPECT_LT(FigureOf(appearance, "flat-faces"), 1e-6);
  EXPECT_LT(FigureOf(appearance, "fairness"), 0.1);
  EXPECT_LT(FigureOf(appearance, "symmetry"), 0.3);  // the middle is that of samples
  EXPECT_EQ(appearance.look, Look::kA);
  EXPECT_EQ(appearance.reasons + appearance.remedy, "");
}

TEST(Appearance, NamesWhatIsWrongAndWhatWouldHelp) {
  const core::TexturedMesh truth = Block(0.0, Checkers(12));
  const AssetPhoto photo = PhotoOf(truth);
  // A bulge of 12 mm on a diagonal of 269 mm.
  const Appearance bulging = JudgeAppearance(BoxAsset(Block(0.012, Checkers(12))), photo);
  EXPECT_GE(bulging.look, Look::kC);
  EXPECT_GT(FigureOf(bulging, "flat-faces"), 100 * 0.10 * 0.012 / 0.269);
  EXPECT_LT(FigureOf(bulging, "flat-faces"), 100 * 0.29 * 0.012 / 0.269);
  EXPECT_NE(bulging.reasons.find("bulge"), std::string::npos) << bulging.reasons;
  EXPECT_NE(bulging.remedy.find("mat"), std::string::npos) << bulging.remedy;
  // A fifth higher.
  core::TexturedMesh high = truth;
  core::Transform(Eigen::Affine3d(Eigen::Scaling(1.0, 1.0, 1.2)), &high.mesh);
  const Appearance stretched = JudgeAppearance(BoxAsset(high), photo);
  EXPECT_LT(FigureOf(stretched, "outline"), 0.9);
  EXPECT_NE(stretched.reasons.find("outline differs"), std::string::npos) << stretched.reasons;
  EXPECT_NE(stretched.remedy.find("--mask"), std::string::npos) << stretched.remedy;
  // A plain texture has none of the photo's contrast.
  const Appearance plain = JudgeAppearance(BoxAsset(Block(0.0, core::Image(8, 8, 3, 130))), photo);
  EXPECT_EQ(plain.look, Look::kD);
  EXPECT_LT(FigureOf(plain, "texture"), 0.01);
  EXPECT_NE(plain.reasons.find("blurred"), std::string::npos) << plain.reasons;
}

TEST(Appearance, LeavesOutTheTextureOfAPlainObject) {
  const core::TexturedMesh block = Block(0.0, core::Image(8, 8, 3, 130));
  const Appearance appearance = JudgeAppearance(BoxAsset(block), PhotoOf(block));
  EXPECT_TRUE(std::isnan(FigureOf(appearance, "texture")));
  EXPECT_EQ(appearance.look, Look::kA);
}

TEST(AssetPhoto, IsReadAsItIsWritten) {
  const core::TemporaryFolder folder;
  EXPECT_FALSE(ReadAssetPhoto(folder.path()));
  const AssetPhoto photo = PhotoOf(Block(0.0, Checkers(12)));
  core::WritePng(folder.path() / kCutOutFile, photo.cut_out);
  assets::WriteCameraFile({{kCutOutFile, photo.camera}}, folder.path() / kPhotoCameraFile);
  const auto read = ReadAssetPhoto(folder.path());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->cut_out.pixels, photo.cut_out.pixels);
  EXPECT_LT((read->camera.world_from_camera.matrix() - photo.camera.world_from_camera.matrix())
                .cwiseAbs()
                .maxCoeff(),
            1e-12);
  core::WritePng(folder.path() / kCutOutFile, core::Image(4, 4, 4));
  EXPECT_THROW(ReadAssetPhoto(folder.path()), core::Error);
}

}  // namespace
}  // namespace simwright::validation
