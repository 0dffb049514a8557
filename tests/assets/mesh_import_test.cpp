#include "assets/mesh_import.h"

#include <gtest/gtest.h>
#include <zip.h>

#include <fstream>

#include "assets/furniture_catalogue.h"
#include "assets/obj_file.h"
#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "geometry/mesh_validity.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

class MeshFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("simwright_mesh_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  fs::path Zip(const std::vector<std::pair<std::string, std::string>>& entries) {
    const fs::path path = folder_ / "catalogue.sh3f";
    int code = 0;
    zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    for (const auto& [name, text] : entries) {
      zip_file_add(archive, name.c_str(), zip_source_buffer(archive, text.data(), text.size(), 0),
                   0);
    }
    EXPECT_EQ(zip_close(archive), 0);
    return path;
  }
  fs::path folder_;
};

TEST_F(MeshFiles, KeepsPartsMaterialsAndSharedVertices) {
  Write("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  core::TriangleMesh box = BoxMesh({1, 1, 1});
  std::string text = "mtllib two.mtl\n";
  std::string faces = ObjText(box);
  text += faces.substr(0, faces.find("f "));
  text += "o first\nusemtl red\n";
  const std::string rest = faces.substr(faces.find("f "));
  size_t half = 0;
  for (int i = 0; i < 6; ++i) half = rest.find('\n', half) + 1;
  text += rest.substr(0, half) + "o second\nusemtl blue\n" + rest.substr(half);
  const core::TexturedMesh mesh = ReadMesh(Write("two.obj", text));
  EXPECT_EQ(mesh.mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.part_names.size(), 2u);
  EXPECT_TRUE(geometry::Examine(mesh.mesh).closed);
  const auto& first = mesh.materials[static_cast<size_t>(mesh.triangle_material[0])];
  EXPECT_NEAR(first.base_color.x(), 1.0, 1e-6);
  EXPECT_EQ(first.name, "red");
}

TEST_F(MeshFiles, ReadsItsOwnObjBitForBit) {
  core::TriangleMesh box = BoxMesh({0.1, 0.2, 1.0 / 3.0});
  const core::TriangleMesh back =
      ReadBareObj(Write("box.obj", ObjText(box, true) + "f 1 2\nf 3\n"));  // an edge and a point
  for (size_t i = 0; i < box.vertices.size(); ++i) EXPECT_EQ(back.vertices[i], box.vertices[i]);
  EXPECT_EQ(back.triangles, box.triangles);
}

TEST_F(MeshFiles, BareObjTakesConcavePolygonsWhole) {
  const core::TriangleMesh mesh = ReadBareObj(Write(
      "l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 4//1 5//1 6//1 1 2 3\n"));
  double area = 0.0;
  for (int t = 0; t < 4; ++t) area += 0.5 * core::TriangleAreaVector(mesh, t).norm();
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(area, 3.0, 1e-12);
}

// Assimp's own validation refuses a file whose faces and lines share a group.
TEST_F(MeshFiles, LinesAndPointsOfAnObjAreLeftOut) {
  const std::string box = ObjText(BoxMesh({1, 1, 1}));
  const size_t faces = box.find("f ");
  const std::string lines = "l 1 2\nl 1 2 3 \\\n 4 5\np 1 2\n\tl 3 4\r\nf 1 2\nf 5 \\\n6\n\nl 7 8";
  for (const std::string& text :
       {box.substr(0, faces) + lines + "\n" + box.substr(faces), box + lines}) {
    const core::TexturedMesh mesh = ReadMesh(Write("lines.obj", text));
    EXPECT_EQ(mesh.mesh.triangles.size(), 12u);
    EXPECT_EQ(mesh.mesh.vertices.size(), 8u);
  }
  EXPECT_THROW(ReadMesh(Write("only.obj", box.substr(0, faces) + lines)), core::Error);
}

TEST_F(MeshFiles, BadMeshesAreOneErrorEach) {
  EXPECT_THROW(ReadMesh(folder_ / "none.obj"), core::Error);
  EXPECT_THROW(ReadMesh(Write("empty.obj", "")), core::Error);
  EXPECT_THROW(ReadMesh(Write("words.obj", "these are words\n")), core::Error);
  EXPECT_THROW(ReadMesh(Write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), core::Error);
  EXPECT_THROW(ReadMesh(Write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")), core::Error);
  EXPECT_THROW(ReadMesh(Write("text.glb", "glTF is not this")), core::Error);
  EXPECT_THROW(ReadMesh(Write("short.stl", std::string(90, '\0'))), core::Error);
  EXPECT_THROW(ReadMesh(Write("mesh.doc", "v 0 0 0")), core::Error);
  EXPECT_THROW(ReadBareObj(Write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")),
               core::Error);
}

TEST_F(MeshFiles, CatalogueGivesTrueSizes) {
  const FurnitureCatalogue catalogue(
      Zip({{"PluginFurnitureCatalog.properties",
            "id#1=x#crate\nname#1=Crate\nmodel#1=/crate/crate.obj\nwidth#1=60\ndepth#1=40\n"
            "height#1=30.5\n"},
           {"crate/crate.obj", ObjText(BoxMesh({1, 1, 1}))}}));
  ASSERT_EQ(catalogue.pieces().size(), 1u);
  EXPECT_NEAR((catalogue.pieces()[0].size_m - Eigen::Vector3d(0.6, 0.4, 0.305)).norm(), 0.0, 1e-12);
  const core::TexturedMesh mesh = ReadMesh(catalogue.Extract(catalogue.pieces()[0], folder_));
  EXPECT_EQ(mesh.mesh.triangles.size(), 12u);
}

TEST_F(MeshFiles, BadCataloguesAreOneErrorEach) {
  EXPECT_THROW(FurnitureCatalogue(Write("text.sh3f", "no zip")), core::Error);
  EXPECT_THROW(FurnitureCatalogue(Zip({{"other.txt", "x"}})), core::Error);
  try {
    FurnitureCatalogue(Write("lfs.sh3f", "version https://git-lfs.github.com/spec/v1\n"));
    ADD_FAILURE() << "a pointer was read";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("git lfs pull"), std::string::npos);
  }
  EXPECT_THROW(FurnitureCatalogue(Zip({{"PluginFurnitureCatalog.properties", "id#1=a\n"},
                                       {"../climbs/out.obj", "x"}})),
               core::Error);
  const FurnitureCatalogue missing(
      Zip({{"PluginFurnitureCatalog.properties", "id#1=a\nname#1=A\nmodel#1=/none.obj\n"}}));
  EXPECT_THROW(missing.Extract(missing.pieces()[0], folder_), core::Error);
}

}  // namespace
}  // namespace simwright::assets
