// Metallic, roughness and normal statements of OBJ libraries, and textures without coordinates.
#include <gtest/gtest.h>

#include "assets/mesh_import.h"
#include "core/image.h"
#include "gltf_builder.h"
#include "mesh_files.h"

namespace simwright::assets {
namespace {

class ObjLook : public MeshFolder {
 protected:
  static core::Image Filled(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    core::Image image(4, 4, 3);
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
      image.pixels[i] = r;
      image.pixels[i + 1] = g;
      image.pixels[i + 2] = b;
    }
    return image;
  }
  // A triangle of the material "steel", with texture coordinates.
  MeshFile ReadTriangle(const std::string& library, bool uvs = true) {
    Write("a.mtl", "newmtl steel\n" + library);
    const std::string corners = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl steel\n";
    const std::string faces = uvs ? "vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n" : "f 1 2 3\n";
    return ReadMeshFile(Write("a.obj", corners + faces));
  }
  // Returns the look of the faces' material.
  static const PbrMaterial& LookOf(const MeshFile& file) {
    return file.look.materials.at(static_cast<std::size_t>(file.mesh.triangle_material.at(0)));
  }
  static const core::Material& MaterialOf(const MeshFile& file) {
    return file.mesh.materials.at(static_cast<std::size_t>(file.mesh.triangle_material.at(0)));
  }
};

TEST_F(ObjLook, FactorsAndMapsAreRead) {
  core::WritePng(folder_ / "kd.png", Filled(200, 100, 50));
  core::WritePng(folder_ / "orm.png", Filled(9, 128, 64));
  core::WritePng(folder_ / "n.png", Filled(128, 128, 255));
  const MeshFile file = ReadTriangle(
      "Kd 1 1 1\nmap_Kd kd.png\nPm 0.5\nPr 0.8\nmap_Pm -imfchan b orm.png\n"
      "map_Pr -imfchan g orm.png\nnorm -bm 0.5 n.png\n");
  EXPECT_TRUE(file.findings.empty());
  const PbrMaterial& look = LookOf(file);
  EXPECT_FLOAT_EQ(look.metallic, 0.5f);
  EXPECT_FLOAT_EQ(look.roughness, 0.8f);
  EXPECT_FLOAT_EQ(look.normal_scale, 0.5f);
  EXPECT_EQ(file.look.images.at(look.metallic_map).pixels.at(0), 64);
  EXPECT_EQ(file.look.images.at(look.roughness_map).pixels.at(0), 128);
  EXPECT_EQ(file.look.images.at(look.normal_map).pixels.at(2), 255);
}

TEST_F(ObjLook, PlainColoursStateNoLook) {
  EXPECT_TRUE(ReadTriangle("Kd 1 0 0\nNs 10\n").look.empty());
  EXPECT_FLOAT_EQ(LookOf(ReadTriangle("Kd 1 0 0\nPm 1\n")).metallic, 1.0f);
  EXPECT_FLOAT_EQ(LookOf(ReadTriangle("Kd 1 0 0\nPm 1\n")).roughness, 1.0f);
  EXPECT_FLOAT_EQ(LookOf(ReadTriangle("Pr 7\n")).roughness, 1.0f);
}

// Blender states "Pm 0" beside the map that replaces it.
TEST_F(ObjLook, AMapIsNotMultipliedByZero) {
  core::WritePng(folder_ / "m.png", Filled(255, 255, 255));
  const MeshFile file = ReadTriangle("Pm 0\nmap_Pm m.png\n");
  EXPECT_FLOAT_EQ(LookOf(file).metallic, 1.0f);
  EXPECT_NEAR(MeanReflectionOf(file.look, file.mesh.triangle_material[0]).metallic, 1.0, 1e-6);
}

TEST_F(ObjLook, MapsThatLieOtherwiseOrAreMissingAreSaid) {
  WriteRedBlue("kd.png");
  WriteRedBlue("r.png");
  MeshFile file = ReadTriangle("map_Kd kd.png\nmap_Pr -s 2 2 1 r.png\n");
  EXPECT_EQ(CountOf(file, "mtl-not-read"), 1);
  EXPECT_TRUE(file.look.empty());
  file = ReadTriangle("Pr 0.5\nmap_Pr gone.png\n");
  EXPECT_EQ(CountOf(file, "texture-missing"), 1);
  EXPECT_EQ(LookOf(file).roughness_map, -1);
  EXPECT_FLOAT_EQ(LookOf(file).roughness, 0.5f);
}

TEST_F(ObjLook, ATextureWithoutCoordinatesIsSaidAndGivesItsMeanColour) {
  WriteRedBlue("kd.png");
  MeshFile file = ReadTriangle("Kd 1 1 1\nmap_Kd kd.png\nPm 0.5\nmap_Pm kd.png\n", false);
  EXPECT_EQ(CountOf(file, "texture-without-uvs"), 1);
  EXPECT_TRUE(file.mesh.textures.empty());
  EXPECT_EQ(MaterialOf(file).texture, -1);
  EXPECT_TRUE(MaterialOf(file).base_color.isApprox(Eigen::Vector4f(0.5f, 0.0f, 0.5f, 1.0f), 1e-5f));
  EXPECT_EQ(LookOf(file).metallic_map, -1);
  EXPECT_EQ(CountOf(ReadTriangle("Kd 1 1 1\nmap_Kd kd.png\n"), "texture-without-uvs"), 0);
}

// One of two faces has coordinates: the texture stays.
TEST_F(ObjLook, FacesWithoutCoordinatesAreCounted) {
  WriteRedBlue("kd.png");
  Write("a.mtl", "newmtl steel\nKd 1 1 1\nmap_Kd kd.png\n");
  const MeshFile file = ReadMeshFile(
      Write("a.obj",
            "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
            "o with\nusemtl steel\nf 1/1 2/2 3/3\no without\nusemtl steel\nf 1 3 4\n"));
  ASSERT_EQ(CountOf(file, "texture-without-uvs"), 1);
  EXPECT_EQ(file.findings[0].figure, 1.0);
  EXPECT_EQ(file.mesh.textures.size(), 1u);
}

TEST_F(ObjLook, GltfAndPlyWithoutCoordinatesAreSaid) {
  GltfBuilder gltf;
  const int corners = gltf.AddFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  gltf.root["meshes"] = {{{"primitives",
                           {{{"attributes", {{"POSITION", corners}}},
                             {"indices", gltf.AddIndices({0, 1, 2})},
                             {"material", 0}}}}}};
  gltf.root["materials"][0]["name"] = "steel";
  gltf.AddTexture(core::EncodePng(RedBlue()));
  const MeshFile glb = ReadMeshFile(Write("a.glb", gltf.Glb()));
  EXPECT_EQ(CountOf(glb, "texture-without-uvs"), 1);
  EXPECT_NEAR(MaterialOf(glb).base_color.x(), 0.5f, 1e-5f);
  WriteRedBlue("t.png");
  const MeshFile ply = ReadMeshFile(
      Write("a.ply",
            "ply\nformat ascii 1.0\ncomment TextureFile t.png\nelement vertex 3\n"
            "property float x\nproperty float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_EQ(CountOf(ply, "texture-without-uvs"), 1);
}

}  // namespace
}  // namespace simwright::assets
