// GLB files of assets: read back by our reader and by Assimp, and the rules of the specification.
#include "assets/glb_asset.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <cmath>

#include "assets/articulated_asset.h"
#include "assets/glb_mesh.h"
#include "assets/gltf_document.h"
#include "mesh_files.h"
#include "sample_articulated.h"
#include "sample_asset.h"

namespace simwright::assets {
namespace {

core::Image GradientImage(int side, int channels) {
  core::Image image(side, side, channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<std::uint8_t>(29 * i % 251);
  }
  return image;
}

// A box whose faces all show the whole texture, with maps of roughness, metal and normals.
struct LookedBox {
  Asset asset = SampleAsset();
  PbrLook look;

  LookedBox() {
    asset.visual.textures = {GradientImage(16, 3)};
    asset.visual.materials[0].texture = 0;
    for (std::size_t t = 0; t < asset.visual.mesh.triangles.size(); ++t) {
      asset.visual.corner_uvs.insert(asset.visual.corner_uvs.end(),
                                     {{0.1f, 0.2f}, {0.9f, 0.2f}, {0.9f, 0.7f}});
    }
    look.images = {GradientImage(8, 1), GradientImage(4, 1), GradientImage(8, 3)};
    PbrMaterial material;
    material.metallic = 0.7f;
    material.roughness = 0.4f;
    material.normal_scale = 0.5f;
    material.roughness_map = 0;
    material.metallic_map = 1;
    material.normal_map = 2;
    look.materials = {material};
  }
};

class GlbAsset : public MeshFolder {};

TEST_F(GlbAsset, OurReaderFindsTheSameMeshAndMaterials) {
  const LookedBox box;
  const MeshFile file = ReadMeshFile(Write("box.glb", GlbText(box.asset, box.look)));
  EXPECT_EQ(file.up, 'y');
  EXPECT_TRUE(file.findings.empty());
  core::TriangleMesh mesh = file.mesh.mesh;
  core::Transform(Eigen::Affine3d(ZUpRotation(file.up)), &mesh);
  ASSERT_EQ(mesh.triangles.size(), box.asset.visual.mesh.triangles.size());
  const Eigen::AlignedBox3d found = core::Bounds(mesh);
  const Eigen::AlignedBox3d made = core::Bounds(box.asset.visual.mesh);
  EXPECT_LT((found.min() - made.min()).norm() + (found.max() - made.max()).norm(), 1e-7);
  // Corner by corner, because one material keeps the order of the faces.
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::size_t corner = 3 * t + static_cast<std::size_t>(k);
      const Eigen::Vector3d& original =
          box.asset.visual.mesh.vertices[box.asset.visual.mesh.triangles[t][k]];
      EXPECT_LT((mesh.vertices[mesh.triangles[t][k]] - original).norm(), 1e-7);
      EXPECT_LT((file.mesh.corner_uvs[corner] - box.asset.visual.corner_uvs[corner]).norm(), 1e-6f);
    }
  }
  ASSERT_EQ(file.mesh.textures.size(), 1u);
  EXPECT_EQ(file.mesh.textures[0].pixels, box.asset.visual.textures[0].pixels);
  EXPECT_TRUE(file.mesh.materials.at(0).base_color.isApprox(
      box.asset.visual.materials[0].base_color, 1e-5f));
  ASSERT_EQ(file.look.materials.size(), 1u);
  const PbrMaterial& pbr = file.look.materials[0];
  EXPECT_FLOAT_EQ(pbr.metallic, 0.7f);
  EXPECT_FLOAT_EQ(pbr.roughness, 0.4f);
  EXPECT_FLOAT_EQ(pbr.normal_scale, 0.5f);
  const auto image = [&](int map) { return file.look.images.at(static_cast<std::size_t>(map)); };
  EXPECT_EQ(image(pbr.roughness_map).pixels, box.look.images[0].pixels);
  EXPECT_EQ(image(pbr.normal_map).pixels, box.look.images[2].pixels);
  EXPECT_EQ(image(pbr.metallic_map).width, 8);  // resized to the roughness map's size
}

TEST_F(GlbAsset, AssimpReadsTheMaterialNormalsAndTangents) {
  const LookedBox box;
  const std::string glb = GlbText(box.asset, box.look);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(glb.data(), glb.size(), 0, "glb");
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1u);
  const aiMesh& mesh = *scene->mMeshes[0];
  ASSERT_TRUE(mesh.HasNormals());
  ASSERT_TRUE(mesh.HasTangentsAndBitangents());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    EXPECT_NEAR(mesh.mNormals[i].Length(), 1.0, 1e-5);
    EXPECT_NEAR(mesh.mTangents[i].Length(), 1.0, 1e-5);
    EXPECT_NEAR(mesh.mNormals[i] * mesh.mTangents[i], 0.0, 1e-5);
  }
  float metallic = 0.0f, roughness = 0.0f;
  const aiMaterial& material = *scene->mMaterials[mesh.mMaterialIndex];
  EXPECT_EQ(material.Get(AI_MATKEY_METALLIC_FACTOR, metallic), AI_SUCCESS);
  EXPECT_EQ(material.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness), AI_SUCCESS);
  EXPECT_FLOAT_EQ(metallic, 0.7f);
  EXPECT_FLOAT_EQ(roughness, 0.4f);
  EXPECT_EQ(material.GetTextureCount(aiTextureType_NORMALS), 1u);
}

// The tangent points along growing u and the bitangent along growing v, which a quad shows, also
// one whose texture is mirrored.
TEST_F(GlbAsset, TangentsFollowTheTexture) {
  for (const float side : {1.0f, -1.0f}) {
    core::TexturedMesh quad;
    quad.mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}};
    quad.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto uv = [&](float x, float y) { return Eigen::Vector2f(side * x, y); };
    quad.corner_uvs = {uv(0, 0), uv(1, 0), uv(1, 1), uv(0, 0), uv(1, 1), uv(0, 1)};
    const std::vector<Eigen::Vector3d> normals(6, Eigen::Vector3d::UnitZ());
    for (const Eigen::Vector4f& tangent : CornerTangents(quad, normals)) {
      EXPECT_LT((tangent - Eigen::Vector4f(side, 0, 0, side)).norm(), 1e-6f) << tangent;
    }
  }
}

TEST_F(GlbAsset, LinksAreATreeWithTheirJoints) {
  const ArticulatedAsset chest = TexturedArticulated();
  const std::filesystem::path path = Write("chest.glb", GlbText(chest));
  const GltfDocument document(path);
  const core::Json& nodes = document.root()["nodes"];
  ASSERT_EQ(nodes.size(), 4u);
  EXPECT_EQ(nodes[0]["name"], "sample_chest");
  EXPECT_EQ(nodes[0]["children"], core::Json::array({1}));
  EXPECT_EQ(nodes[1]["children"], core::Json::array({2}));
  EXPECT_EQ(nodes[2]["children"], core::Json::array({3}));
  const core::Json& joint = nodes[2]["extras"]["joint"];
  EXPECT_EQ(joint["name"], "door_joint");
  EXPECT_EQ(joint["type"], "revolute");
  EXPECT_EQ(joint["axis"], core::Json::array({0.0, 0.0, -1.0}));
  EXPECT_EQ(joint["upper"], 1.7);
  EXPECT_EQ(nodes[3]["extras"]["joint"]["type"], "fixed");
  // Equal textures are embedded once.
  EXPECT_EQ(document.root()["images"].size(), 1u);
  EXPECT_EQ(document.root()["textures"].size(), 1u);
  // The whole as our reader places it is the asset at position zero.
  const MeshFile file = ReadMeshFile(path);
  core::TriangleMesh mesh = file.mesh.mesh;
  core::Transform(Eigen::Affine3d(ZUpRotation('y')), &mesh);
  const core::TexturedMesh original = VisualAtPositions(chest);
  EXPECT_EQ(mesh.triangles.size(), original.mesh.triangles.size());
  const Eigen::AlignedBox3d found = core::Bounds(mesh), made = core::Bounds(original.mesh);
  EXPECT_LT((found.min() - made.min()).norm() + (found.max() - made.max()).norm(), 1e-6);
  EXPECT_NEAR(core::SurfaceArea(mesh), core::SurfaceArea(original.mesh), 1e-6);
}

// Rules of glTF 2.0 that the file must obey: alignment, bounds of positions, lengths of normals,
// indices in range, no material without use.
TEST_F(GlbAsset, ObeysTheSpecification) {
  const LookedBox box;
  const std::string glb = GlbText(box.asset, box.look);
  EXPECT_EQ(glb.size() % 4, 0u);
  std::uint32_t stated = 0;
  std::memcpy(&stated, glb.data() + 8, 4);
  EXPECT_EQ(stated, glb.size());
  const GltfDocument document(Write("box.glb", glb));
  const core::Json& root = document.root();
  for (const core::Json& view : root["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"].get<int>() % 4, 0);
  }
  const core::Json& primitive = root["meshes"][0]["primitives"][0];
  const core::Json& attributes = primitive["attributes"];
  const std::size_t positions = attributes["POSITION"].get<std::size_t>();
  const std::vector<float> values = document.Floats(positions, 3);
  for (std::size_t c = 0; c < 3; ++c) {
    float low = values[c], high = values[c];
    for (std::size_t i = c; i < values.size(); i += 3) {
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
    EXPECT_EQ(root["accessors"][positions]["min"][c].get<float>(), low);
    EXPECT_EQ(root["accessors"][positions]["max"][c].get<float>(), high);
  }
  const std::size_t count = document.CountOf(positions);
  for (const auto& [name, accessor] : attributes.items()) {
    EXPECT_EQ(document.CountOf(accessor.get<std::size_t>()), count) << name;
  }
  for (const std::uint32_t index : document.Integers(primitive["indices"].get<std::size_t>(), 1)) {
    EXPECT_LT(index, count);
  }
  const std::vector<float> tangents = document.Floats(attributes["TANGENT"].get<std::size_t>(), 4);
  for (std::size_t i = 3; i < tangents.size(); i += 4) EXPECT_EQ(std::abs(tangents[i]), 1.0f);
  EXPECT_EQ(root["materials"].size(), 1u);
  EXPECT_EQ(root["textures"].size(), 3u);
  // Transparent colours blend, opaque ones do not.
  EXPECT_FALSE(root["materials"][0].contains("alphaMode"));
  LookedBox glass;
  glass.asset.visual.materials[0].base_color.w() = 0.4f;
  const GltfDocument other(Write("glass.glb", GlbText(glass.asset, {})));
  EXPECT_EQ(other.root()["materials"][0]["alphaMode"], "BLEND");
  EXPECT_EQ(other.root()["materials"][0]["pbrMetallicRoughness"]["metallicFactor"], 0.0);
}

}  // namespace
}  // namespace simwright::assets
