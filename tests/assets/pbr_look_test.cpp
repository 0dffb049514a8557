// Metallic, roughness and normal maps of a glTF, in an asset folder and back.
#include "assets/pbr_look.h"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <tinyxml2.h>
#include <assimp/Importer.hpp>
#include <sdf/Link.hh>
#include <sdf/Material.hh>
#include <sdf/Model.hh>
#include <sdf/Pbr.hh>
#include <sdf/Root.hh>
#include <sdf/Visual.hh>

#include "assets/asset_folder.h"
#include "core/files.h"
#include "core/image.h"
#include "gltf_builder.h"
#include "mesh_files.h"
#include "sample_asset.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

core::Image Plain(int side, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  core::Image image(side, side, 3);
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    image.pixels[i] = r;
    image.pixels[i + 1] = g;
    image.pixels[i + 2] = b;
  }
  return image;
}

class PbrLookTest : public MeshFolder {
 protected:
  // A triangle with a base colour, metallic and roughness (0.25 and 0.5 by their map) and normals.
  static GltfBuilder Triangle() {
    GltfBuilder gltf;
    const int corners = gltf.AddFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    const int uvs = gltf.AddFloats({0, 1, 1, 1, 0, 0}, "VEC2", 2);
    gltf.root["meshes"] = {{{"primitives",
                             {{{"attributes", {{"POSITION", corners}, {"TEXCOORD_0", uvs}}},
                               {"indices", gltf.AddIndices({0, 1, 2})},
                               {"material", 0}}}}}};
    gltf.root["materials"][0]["name"] = "steel";
    gltf.AddTexture(core::EncodePng(Plain(4, 200, 100, 50)));
    auto& material = gltf.root["materials"][0];
    material["pbrMetallicRoughness"]["metallicFactor"] = 0.5;
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.8;
    const auto add = [&](const core::Image& image) {
      const int view = gltf.AddBytes(core::EncodePng(image));
      gltf.root["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
      gltf.root["textures"].push_back({{"source", gltf.root["images"].size() - 1}});
      return gltf.root["textures"].size() - 1;
    };
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] =
        add(Plain(4, 7, 128, 64));
    material["normalTexture"] = {{"index", add(Plain(8, 128, 128, 255))}, {"scale", 0.5}};
    return gltf;
  }
  MeshFile Read(GltfBuilder gltf) { return ReadMeshFile(Write("a.glb", gltf.Glb())); }
};

TEST_F(PbrLookTest, GltfStatesFactorsAndMaps) {
  const MeshFile file = Read(Triangle());
  ASSERT_EQ(file.look.materials.size(), 1u);
  const PbrMaterial& pbr = file.look.materials[0];
  EXPECT_FLOAT_EQ(pbr.metallic, 0.5f);
  EXPECT_FLOAT_EQ(pbr.roughness, 0.8f);
  EXPECT_FLOAT_EQ(pbr.normal_scale, 0.5f);
  ASSERT_EQ(file.look.images.size(), 3u);
  EXPECT_EQ(file.look.images.at(pbr.roughness_map).channels, 1);
  EXPECT_EQ(file.look.images.at(pbr.roughness_map).pixels[0], 128);
  EXPECT_EQ(file.look.images.at(pbr.metallic_map).pixels[5], 64);
  EXPECT_EQ(file.look.images.at(pbr.normal_map).width, 8);
  const MeanReflection mean = MeanReflectionOf(file.look, 0);
  EXPECT_NEAR(mean.roughness, 0.8 * 128 / 255, 1e-6);
  EXPECT_NEAR(mean.metallic, 0.5 * 64 / 255, 1e-6);
  EXPECT_TRUE(file.findings.empty());
}

// The specification's defaults hold where a factor is left out, and a plain colour states no look.
TEST_F(PbrLookTest, DefaultsAreThoseOfTheSpecification) {
  GltfBuilder gltf = Triangle();
  gltf.root["materials"][0]["pbrMetallicRoughness"].erase("metallicFactor");
  EXPECT_FLOAT_EQ(Read(gltf).look.materials.at(0).metallic, 1.0f);
  gltf.root["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}};
  EXPECT_TRUE(Read(gltf).look.empty());
}

// A map on other coordinates than the base colour's would be placed wrongly: it is left out.
TEST_F(PbrLookTest, MapsOnOtherCoordinatesAreSaid) {
  GltfBuilder gltf = Triangle();
  gltf.root["materials"][0]["normalTexture"]["texCoord"] = 1;
  const MeshFile file = Read(gltf);
  EXPECT_EQ(file.look.materials.at(0).normal_map, -1);
  EXPECT_GE(file.look.materials.at(0).roughness_map, 0);
  ASSERT_EQ(file.findings.size(), 1u);
  EXPECT_EQ(file.findings[0].code, "gltf-maps-not-read");
  EXPECT_NE(file.findings[0].sentence.find("normals"), std::string::npos);
  EXPECT_EQ(file.findings[0].sentence.find("roughness"), std::string::npos);
}

class PbrFolder : public PbrLookTest {
 protected:
  void SetUp() override {
    PbrLookTest::SetUp();
    asset_ = SampleAsset();
    look_ = Read(Triangle()).look;
    WriteAsset(asset_, folder_);
    AddPbrLook(asset_.visual, look_, asset_.name, folder_);
  }
  Asset asset_;
  PbrLook look_;
};

TEST_F(PbrFolder, TheFolderStatesTheLook) {
  const PbrLook read = ReadPbrLook(folder_);
  ASSERT_EQ(read.materials.size(), 1u);
  EXPECT_FLOAT_EQ(read.materials[0].metallic, 0.5f);
  EXPECT_FLOAT_EQ(read.materials[0].roughness, 0.8f);
  EXPECT_FLOAT_EQ(read.materials[0].normal_scale, 0.5f);
  const auto same = [&](int map, int original) {
    return read.images.at(map).pixels == look_.images.at(original).pixels;
  };
  EXPECT_TRUE(same(read.materials[0].metallic_map, look_.materials[0].metallic_map));
  EXPECT_TRUE(same(read.materials[0].roughness_map, look_.materials[0].roughness_map));
  EXPECT_TRUE(same(read.materials[0].normal_map, look_.materials[0].normal_map));
  // The rest of the asset is read as before.
  const core::TexturedMesh visual = ReadAsset(folder_).visual;
  const core::Material& seen = visual.materials.at(visual.triangle_material.at(0));
  EXPECT_TRUE(seen.base_color.isApprox(asset_.visual.materials[0].base_color, 1e-5f));
}

TEST_F(PbrFolder, AssimpReadsTheMaterial) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile((folder_ / "visual.obj").string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  const aiMaterial* steel = nullptr;
  for (unsigned m = 0; m < scene->mNumMaterials; ++m) {
    float found = 0.0f;
    if (scene->mMaterials[m]->Get(AI_MATKEY_METALLIC_FACTOR, found) == AI_SUCCESS) {
      steel = scene->mMaterials[m];
    }
  }
  ASSERT_NE(steel, nullptr);
  float metallic = 0.0f, roughness = 0.0f;
  EXPECT_EQ(steel->Get(AI_MATKEY_METALLIC_FACTOR, metallic), AI_SUCCESS);
  EXPECT_EQ(steel->Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness), AI_SUCCESS);
  EXPECT_FLOAT_EQ(metallic, 0.5f);
  EXPECT_FLOAT_EQ(roughness, 0.8f);
}

TEST_F(PbrFolder, TheMjcfHasTheHighlights) {
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.LoadFile((folder_ / "sample_box.xml").c_str()), tinyxml2::XML_SUCCESS);
  const auto* root = document.FirstChildElement("mujoco");
  const auto* material = root->FirstChildElement("asset")->FirstChildElement("material");
  ASSERT_NE(material, nullptr);
  const double gloss = 1.0 - 0.8 * 128 / 255;
  EXPECT_NEAR(material->DoubleAttribute("shininess"), gloss, 1e-6);
  EXPECT_NEAR(material->DoubleAttribute("specular"), gloss * (0.5 + 0.25 * 64 / 255), 1e-6);
  const auto* geom =
      root->FirstChildElement("worldbody")->FirstChildElement("body")->FirstChildElement("geom");
  EXPECT_STREQ(geom->Attribute("material"), material->Attribute("name"));
  EXPECT_EQ(geom->Attribute("rgba"), nullptr);
}

TEST_F(PbrFolder, TheSdfHasTheMaterial) {
  sdf::Root root;
  const sdf::Errors errors = root.Load((folder_ / "sample_box.sdf").string());
  EXPECT_TRUE(errors.empty()) << errors.front().Message();
  const sdf::Model* model = root.Model();
  ASSERT_NE(model, nullptr);
  const sdf::Material* material = model->LinkByIndex(0)->VisualByIndex(0)->Material();
  ASSERT_NE(material, nullptr);
  const Eigen::Vector4f& color = asset_.visual.materials[0].base_color;
  EXPECT_NEAR(material->Diffuse().R(), color.x(), 1e-6);
  const sdf::PbrWorkflow* metal = material->PbrMaterial()->Workflow(sdf::PbrWorkflowType::METAL);
  ASSERT_NE(metal, nullptr);
  EXPECT_EQ(metal->RoughnessMap(), "roughness_000.png");
  EXPECT_EQ(metal->MetalnessMap(), "metallic_000.png");
  EXPECT_EQ(metal->NormalMap(), "normal_000.png");
  EXPECT_EQ(metal->AlbedoMap(), "");
  // Without maps the factors are stated.
  PbrLook plain = look_;
  plain.materials[0].metallic_map = plain.materials[0].roughness_map = -1;
  WriteAsset(asset_, folder_);
  AddPbrLook(asset_.visual, plain, asset_.name, folder_);
  sdf::Root again;
  EXPECT_TRUE(again.Load((folder_ / "sample_box.sdf").string()).empty());
  metal = again.Model()->LinkByIndex(0)->VisualByIndex(0)->Material()->PbrMaterial()->Workflow(
      sdf::PbrWorkflowType::METAL);
  EXPECT_NEAR(metal->Metalness(), 0.5, 1e-6);
  EXPECT_NEAR(metal->Roughness(), 0.8, 1e-6);
}

// Folders of earlier versions have no "materials"; a wrong value is an error.
TEST_F(PbrFolder, OldAndDamagedFolders) {
  const fs::path file = folder_ / "asset.json";
  nlohmann::json json = nlohmann::json::parse(core::ReadFile(file, 1 << 20));
  json["materials"][0]["roughness"] = 3.0;
  core::WriteFile(file, json.dump());
  EXPECT_THROW(ReadPbrLook(folder_), core::Error);
  json["materials"][0]["roughness"] = 0.3;
  json["materials"][0]["normal_map"] = "../normal.png";
  core::WriteFile(file, json.dump());
  EXPECT_THROW(ReadPbrLook(folder_), core::Error);
  json.erase("materials");
  core::WriteFile(file, json.dump());
  EXPECT_TRUE(ReadPbrLook(folder_).empty());
}

// Files of generators have single vertices that are not numbers.
TEST_F(PbrLookTest, FewLostVerticesAreLeftOutAndManyRefused) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 120\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face 40\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  const auto mesh = [&](int lost) {
    std::string body = ply;
    for (int i = 0; i < 40; ++i) {
      const std::string x = i < lost ? "nan" : std::to_string(i);
      body += x + " 0 0\n" + x + " 1 0\n" + x + " 0 1\n";
    }
    for (int i = 0; i < 40; ++i) {
      body += "3 " + std::to_string(3 * i) + " " + std::to_string(3 * i + 1) + " " +
              std::to_string(3 * i + 2) + "\n";
    }
    return body;
  };
  const MeshFile file = ReadMeshFile(Write("few.ply", mesh(2)));
  EXPECT_EQ(file.mesh.mesh.triangles.size(), 38u);
  EXPECT_EQ(file.mesh.mesh.vertices.size(), 114u);
  ASSERT_EQ(file.findings.size(), 1u);
  EXPECT_EQ(file.findings[0].code, "mesh-lost-vertices");
  EXPECT_EQ(file.findings[0].figure, 2.0);
  EXPECT_THROW(ReadMeshFile(Write("many.ply", mesh(3))), core::Error);
}

}  // namespace
}  // namespace simwright::assets
