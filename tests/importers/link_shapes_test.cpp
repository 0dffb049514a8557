// The colours of links of a foreign URDF whose files use a texture or vertex colours.
#include "importers/link_shapes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/image.h"
#include "geometry/surface_distance.h"
#include "geometry/weld.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::importers {
namespace {
namespace fs = std::filesystem;

class LinkColors : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / "simwright_link_colors";
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Eight triangles in a fan of unit legs; the two halves have different materials.
  core::TexturedMesh Seen(const std::string& vertex_colors, const std::string& uvs) {
    std::ofstream obj(folder_ / "m.obj");
    obj << "mtllib m.mtl\nusemtl m\n" << vertex_colors << uvs;
    for (int i = 0; i < 8; ++i) {
      const int base = 3 * i + 1;
      obj << "f";
      for (int k = 0; k < 3; ++k) {
        obj << " " << base + k;
        if (!uvs.empty()) obj << "/" << i + 1;
      }
      obj << "\n";
    }
    obj.close();
    assets::UrdfLink link;
    assets::UrdfShape shape;
    shape.file = (folder_ / "m.obj").string();
    link.visuals.push_back(shape);
    return ColoredVisual(link);
  }
  static std::string Corners(const char* first, const char* second) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
      for (const char* corner : {"0 0 ", "1 0 ", "0 1 "}) {
        text += "v " + std::string(corner) + std::to_string(i) + (i < 4 ? first : second) + "\n";
      }
    }
    return text;
  }
  static int Triangles(const core::TexturedMesh& mesh, const Eigen::Vector3f& color) {
    int count = 0;
    for (const int material : mesh.triangle_material) {
      const Eigen::Vector4f& base = mesh.materials[static_cast<size_t>(material)].base_color;
      count += (base.head<3>() - color).norm() < 0.02f;
    }
    return count;
  }
  fs::path folder_;
};

TEST_F(LinkColors, ColoursAtVerticesStay) {
  const core::TexturedMesh mesh = Seen(Corners(" 1 0 0", " 0 1 0"), "");
  EXPECT_EQ(Triangles(mesh, {1, 0, 0}), 4);
  EXPECT_EQ(Triangles(mesh, {0, 1, 0}), 4);
}

TEST_F(LinkColors, PalettesStayAndPicturesBecomeTheirMean) {
  std::ofstream(folder_ / "m.mtl") << "newmtl m\nKd 1 1 1\nmap_Kd t.png\n";
  std::string uvs;
  for (int i = 0; i < 8; ++i) uvs += "vt " + std::to_string((i + 0.5) / 8.0) + " 0.5\n";
  core::Image asset_set(8, 1, 3);
  for (int x = 0; x < 8; ++x) asset_set.At(x, 0)[x < 4 ? 0 : 2] = 255;
  core::WritePng(folder_ / "t.png", asset_set);
  core::TexturedMesh mesh = Seen(Corners("", ""), uvs);
  EXPECT_EQ(Triangles(mesh, {1, 0, 0}), 4);
  EXPECT_EQ(Triangles(mesh, {0, 0, 1}), 4);
}

TEST_F(LinkColors, ManyColoursBecomeTheirMean) {
  std::ofstream(folder_ / "m.mtl") << "newmtl m\nKd 1 1 1\nmap_Kd t.png\n";
  core::Image ramp(64, 1, 3);
  for (int x = 0; x < 64; ++x) {
    ramp.At(x, 0)[0] = static_cast<std::uint8_t>(x % 8 * 36);
    ramp.At(x, 0)[1] = static_cast<std::uint8_t>(x / 8 * 36);
  }
  core::WritePng(folder_ / "t.png", ramp);
  std::ofstream obj(folder_ / "m.obj");
  obj << "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 64; ++i) obj << "vt " << (i + 0.5) / 64.0 << " 0.5\n";
  for (int i = 1; i <= 64; ++i) obj << "f 1/" << i << " 2/" << i << " 3/" << i << "\n";
  obj.close();
  assets::UrdfLink link;
  assets::UrdfShape shape;
  shape.file = (folder_ / "m.obj").string();
  link.visuals.push_back(shape);
  // The mean of 0, 36 ... 252 is 126.
  EXPECT_EQ(Triangles(ColoredVisual(link), {126 / 255.0f, 126 / 255.0f, 0}), 64);
}

// Three separate boxes of one link: with two parts, the two that are nearest share a hull.
TEST(LinkParts, AreMergedToTheBudgetAndReported) {
  assets::UrdfLink link;
  link.name = "shelf";
  for (const double x : {0.0, 0.12, 0.5}) {
    assets::UrdfShape shape;
    shape.mesh = shapes::Box(Eigen::Vector3d(x, 0, 0), Eigen::Vector3d(x + 0.1, 0.1, 0.1));
    link.collisions.push_back(shape);
  }
  core::Findings findings;
  EXPECT_EQ(ConvexPartsOf({link}, 0.7, false, {}, &findings)[0].size(), 3u);
  EXPECT_TRUE(findings.empty());
  asset_build::PartBudget budget;
  budget.max_parts = 2;
  const auto parts = ConvexPartsOf({link}, 0.7, false, budget, &findings)[0];
  ASSERT_EQ(parts.size(), 2u);
  const double volumes[] = {geometry::SignedVolume(parts[0]), geometry::SignedVolume(parts[1])};
  EXPECT_NEAR(std::max(volumes[0], volumes[1]), 0.22 * 0.1 * 0.1, 1e-9);
  EXPECT_NEAR(std::min(volumes[0], volumes[1]), 0.1 * 0.1 * 0.1, 1e-9);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "part-budget");
  EXPECT_EQ(findings[0].place, "shelf");
}

// Returns an L of two arms, `size` long and a fifth as wide, `thickness` thick; 0: a flat sheet.
core::TriangleMesh Bracket(double size, double thickness) {
  const double width = 0.2 * size;
  std::vector<Eigen::Vector2d> corners = {{0, 0},         {size, 0},     {size, width},
                                          {width, width}, {width, size}, {0, size}};
  core::TriangleMesh mesh;
  for (const double z : {0.0, thickness}) {
    for (const Eigen::Vector2d& corner : corners)
      mesh.vertices.emplace_back(corner[0], corner[1], z);
    if (thickness == 0.0) break;
  }
  const std::vector<Eigen::Vector3i> faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  for (const Eigen::Vector3i& face : faces) {
    mesh.triangles.push_back(face);
    if (thickness > 0.0) mesh.triangles.emplace_back(face[0] + 6, face[2] + 6, face[1] + 6);
  }
  for (int i = 0; thickness > 0.0 && i < 6; ++i) {
    const int j = (i + 1) % 6;
    mesh.triangles.emplace_back(i, i + 6, j);
    mesh.triangles.emplace_back(j, i + 6, j + 6);
  }
  return mesh;
}

// Flat and small pieces keep one hull, unless a tolerance is stated that it does not meet.
TEST(LinkParts, OfFlatAndSmallPiecesMeetAStatedTolerance) {
  constexpr double kTolerance = 0.002, kSheet = 0.002;  // m
  for (const double thickness : {0.0, 0.01}) {
    assets::UrdfLink link;
    link.name = "bracket";
    assets::UrdfShape shape;
    shape.mesh = Bracket(0.1, thickness);
    link.collisions.push_back(shape);
    core::Findings findings;
    const double whole = 10.0;  // m: the bracket is small
    EXPECT_EQ(ConvexPartsOf({link}, whole, false, {}, &findings)[0].size(), 1u) << thickness;
    asset_build::PartBudget budget;
    budget.tolerance = kTolerance;
    const auto parts = ConvexPartsOf({link}, whole, false, budget, &findings)[0];
    EXPECT_GE(parts.size(), 2u) << thickness;
    double farthest = 0.0, volume = 0.0;
    for (const core::TriangleMesh& part : parts) {
      volume += geometry::SignedVolume(part);
      for (const double distance :
           geometry::DistancesToSurface(geometry::SampleSurface(part, 1000, 3), shape.mesh)) {
        farthest = std::max(farthest, distance);
      }
    }
    EXPECT_LT(farthest, kTolerance + kSheet + 0.5 * thickness) << thickness;
    EXPECT_GT(volume, 0.0);
  }
}

}  // namespace
}  // namespace simwright::importers
