// glTF 2.0 as its core and its ratified extensions allow it. The truth is the specification's:
// volumes, corners and colours worked out by hand.
#include "gltf_builder.h"
#include "mesh_files.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

const std::vector<float> kCorners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
const std::vector<std::uint16_t> kFaces{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
// A unit square; coordinates of its texture with the origin at the upper left.
const std::vector<float> kSquare{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<float> kSquareUvs{0, 1, 1, 1, 1, 0, 0, 0};
const std::vector<std::uint16_t> kSquareFaces{0, 1, 2, 0, 2, 3};

class GltfImport : public MeshFolder {
 protected:
  static GltfBuilder Tetrahedron() {
    GltfBuilder builder;
    const int corners = builder.AddFloats(kCorners, "VEC3", 3);
    const int faces = builder.AddIndices(kFaces);
    builder.root["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", corners}}}, {"indices", faces}}}}}};
    return builder;
  }
  static GltfBuilder Square() {
    GltfBuilder builder;
    const int corners = builder.AddFloats(kSquare, "VEC3", 3);
    const int uvs = builder.AddFloats(kSquareUvs, "VEC2", 2);
    const int faces = builder.AddIndices(kSquareFaces);
    builder.root["meshes"] = {{{"primitives",
                                {{{"attributes", {{"POSITION", corners}, {"TEXCOORD_0", uvs}}},
                                  {"indices", faces},
                                  {"material", 0}}}}}};
    builder.root["materials"] = json::array({json::object()});
    return builder;
  }
  static json& Primitive(GltfBuilder* builder) {
    return builder->root["meshes"][0]["primitives"][0];
  }
  MeshFile Read(GltfBuilder builder) { return ReadMeshFile(Write("a.glb", builder.Glb())); }
  std::string Refused(GltfBuilder builder) { return Refusal(Write("a.glb", builder.Glb())); }
  static Eigen::AlignedBox3d Box(const MeshFile& file) { return core::Bounds(file.mesh.mesh); }
};

TEST_F(GltfImport, BuffersBesideInsideAndInDataUrisAreOne) {
  GltfBuilder builder = Tetrahedron();
  Write("my buffer.bin", builder.buffer());
  const fs::path files[] = {Write("glb.glb", builder.Glb()), Write("data.gltf", builder.Gltf()),
                            Write("file.gltf", builder.GltfWithBuffer("my%20buffer.bin")),
                            Write("plain.gltf", builder.GltfWithBuffer("my buffer.bin"))};
  for (const fs::path& path : files) {
    const MeshFile file = ReadMeshFile(path);
    EXPECT_NEAR(Volume(file.mesh.mesh), 1.0 / 6.0, 1e-12) << path;
    EXPECT_EQ(file.up, 'y') << path;
    EXPECT_TRUE(file.findings.empty()) << path;
  }
  const std::string missing = Refusal(Write("missing.gltf", builder.GltfWithBuffer("gone.bin")));
  EXPECT_NE(missing.find("gone.bin"), std::string::npos) << missing;
  Write("lfs.bin", "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n");
  EXPECT_NE(Refusal(Write("lfs.gltf", builder.GltfWithBuffer("lfs.bin"))).find("LFS"),
            std::string::npos);
  Write("short.bin", builder.buffer().substr(0, 20));
  EXPECT_NE(Refusal(Write("short.gltf", builder.GltfWithBuffer("short.bin"))), "");
}

TEST_F(GltfImport, PrimitivesOfEveryModeMakeTheSameSquare) {
  const auto area = [&](int mode, const std::vector<std::uint16_t>& order, bool indexed) {
    GltfBuilder builder;
    std::vector<float> corners;
    if (indexed) {
      corners = kSquare;
    } else {
      for (const std::uint16_t i : order) {
        corners.insert(corners.end(), kSquare.begin() + 3 * i, kSquare.begin() + 3 * i + 3);
      }
    }
    json primitive = {{"attributes", {{"POSITION", builder.AddFloats(corners, "VEC3", 3)}}},
                      {"mode", mode}};
    if (indexed) primitive["indices"] = builder.AddIndices(order);
    builder.root["meshes"] = {{{"primitives", {primitive}}}};
    const MeshFile file = Read(builder);
    double sum = 0.0;
    for (size_t t = 0; t < file.mesh.mesh.triangles.size(); ++t) {
      sum += 0.5 * core::TriangleAreaVector(file.mesh.mesh, static_cast<int>(t)).z();
    }
    return sum;
  };
  for (const bool indexed : {true, false}) {
    EXPECT_NEAR(area(4, {0, 1, 2, 0, 2, 3}, indexed), 1.0, 1e-12);
    EXPECT_NEAR(area(5, {0, 1, 3, 2}, indexed), 1.0, 1e-12);  // strip: the second one turns round
    EXPECT_NEAR(area(6, {0, 1, 2, 3}, indexed), 1.0, 1e-12);  // fan
  }
}

// KHR_mesh_quantization: bytes and shorts, normalised or not, put right by the node.
TEST_F(GltfImport, QuantisedPositionsAreDecoded) {
  GltfBuilder builder = Tetrahedron();
  const std::vector<std::uint16_t> shorts{0, 0,     0, 0, 65535, 0, 0,     0,
                                          0, 65535, 0, 0, 0,     0, 65535, 0};
  const int corners = builder.Add(shorts, 5123, "VEC3", 4, true);
  builder.root["accessors"][corners]["count"] = 4;
  builder.root["bufferViews"][builder.root["accessors"][corners]["bufferView"].get<int>()]
              ["byteStride"] = 8;
  Primitive(&builder)["attributes"]["POSITION"] = corners;
  builder.root["extensionsRequired"] = builder.root["extensionsUsed"] = {"KHR_mesh_quantization"};
  MeshFile file = Read(builder);
  EXPECT_NEAR(Volume(file.mesh.mesh), 1.0 / 6.0, 1e-9);
  EXPECT_TRUE(file.findings.empty());

  const std::vector<std::int8_t> bytes{0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0};
  const int plain = builder.Add(bytes, 5120, "VEC3", 4, false);
  builder.root["accessors"][plain]["count"] = 4;
  builder.root["bufferViews"][builder.root["accessors"][plain]["bufferView"].get<int>()]
              ["byteStride"] = 4;
  Primitive(&builder)["attributes"]["POSITION"] = plain;
  builder.root["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
  file = Read(builder);
  EXPECT_NEAR(Volume(file.mesh.mesh), 1.0 / 6.0, 1e-6);
}

TEST_F(GltfImport, SparseAccessorsMoveTheirElements) {
  GltfBuilder builder = Tetrahedron();
  const int indices = builder.AddBytes(std::string("\3\0", 2));
  const float top[3] = {0, 0, 2};
  const int values = builder.AddBytes({reinterpret_cast<const char*>(top), sizeof(top)});
  const json sparse = {{"count", 1},
                       {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}};
  builder.root["accessors"][0]["sparse"] = sparse;
  EXPECT_NEAR(Volume(Read(builder).mesh.mesh), 2.0 / 6.0, 1e-12);
  // Without a buffer below it: zeros, and one element.
  builder.root["accessors"].push_back(
      {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}, {"sparse", sparse}});
  builder.root["nodes"][0]["weights"] = {0.5};
  Primitive(&builder)["targets"] = {{{"POSITION", builder.root["accessors"].size() - 1}}};
  EXPECT_NEAR(Volume(Read(builder).mesh.mesh), 3.0 / 6.0, 1e-12);  // 2 + 0.5 * 2 high
  builder.root["accessors"][0]["sparse"]["indices"]["componentType"] = 5126;
  builder.root["accessors"][0]["sparse"]["count"] = 99;
  EXPECT_NE(Refused(builder).find("sparse"), std::string::npos);
}

TEST_F(GltfImport, NodesPlaceMeshesOutwardSideOut) {
  GltfBuilder builder = Tetrahedron();
  // Column-major: x -> 2 y, y -> -3 x, z -> 4 z, moved by (5, 6, 7).
  builder.root["nodes"][0]["matrix"] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1};
  MeshFile file = Read(builder);
  EXPECT_NEAR(Volume(file.mesh.mesh), 24.0 / 6.0, 1e-6);
  EXPECT_NEAR((Box(file).min() - Eigen::Vector3d(2, 6, 7)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((Box(file).max() - Eigen::Vector3d(5, 8, 11)).norm(), 0.0, 1e-6);
  // A mirrored node turns the triangles round; a parent scales its child.
  builder.root["nodes"] = {{{"children", {1, 2}}, {"scale", {2, 2, 2}}},
                           {{"mesh", 0}, {"scale", {-1, 1, 1}}},
                           {{"mesh", 0}, {"translation", {1, 0, 0}}}};
  file = Read(builder);
  EXPECT_NEAR(Volume(file.mesh.mesh), 2.0 * 8.0 / 6.0, 1e-6);
  EXPECT_NEAR((Box(file).min() - Eigen::Vector3d(-2, 0, 0)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((Box(file).max() - Eigen::Vector3d(4, 2, 2)).norm(), 0.0, 1e-6);
  EXPECT_EQ(file.mesh.part_names.size(), 2u);
  builder.root["nodes"][1]["children"] = {0};
  EXPECT_NE(Refused(builder).find("two parents"), std::string::npos);
}

TEST_F(GltfImport, SkinsStandInThePoseOfTheirJoints) {
  GltfBuilder builder = Tetrahedron();
  // Vertices 0 to 2 hang on joint 0, the tip on joint 1, which stands 3 higher than when bound.
  Primitive(&builder)["attributes"]["JOINTS_0"] = builder.Add(
      std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, 5121, "VEC4", 4);
  Primitive(&builder)["attributes"]["WEIGHTS_0"] =
      builder.AddFloats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  const int inverse = builder.AddFloats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0,  1,
                                         1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1},
                                        "MAT4", 16);
  builder.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse}}};
  builder.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"scale", {9, 9, 9}}},
                           {{"children", {2}}},
                           {{"translation", {0, 0, 4}}}};
  builder.root["scenes"][0]["nodes"] = {0, 1};
  const MeshFile file = Read(builder);
  EXPECT_NEAR(Box(file).max().z(), 4.0, 1e-6);  // 1 - 1 + 4; the mesh's node does not count
  EXPECT_NEAR(Volume(file.mesh.mesh), 4.0 / 6.0, 1e-6);
}

TEST_F(GltfImport, TheDefaultSceneAloneIsReadAndSaid) {
  GltfBuilder builder = Tetrahedron();
  builder.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"scale", {2, 2, 2}}}};
  builder.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  builder.root["scene"] = 1;
  MeshFile file = Read(builder);
  EXPECT_NEAR(Volume(file.mesh.mesh), 8.0 / 6.0, 1e-6);
  EXPECT_EQ(CountOf(file, "gltf-scenes"), 1);
  builder.root.erase("scenes");
  builder.root.erase("scene");
  EXPECT_NEAR(Volume(Read(builder).mesh.mesh), 9.0 / 6.0, 1e-6);  // all roots
}

// Linear 0.5 is 0.735 in sRGB: 1.055 * 0.5^(1/2.4) - 0.055.
TEST_F(GltfImport, FactorsAndVertexColoursAreLinearLight) {
  GltfBuilder builder = Tetrahedron();
  builder.root["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.0, 1.0, 0.25}}}}}};
  Primitive(&builder)["material"] = 0;
  Eigen::Vector4f shown = Shown(Read(builder).mesh, 0);
  EXPECT_NEAR((shown - Eigen::Vector4f(0.7354f, 0, 1, 1)).norm(), 0.0, 1e-3);  // OPAQUE: no alpha
  builder.root["materials"][0]["alphaMode"] = "BLEND";
  EXPECT_NEAR(Shown(Read(builder).mesh, 0)[3], 0.25, 1e-6);
  builder.root["materials"][0]["alphaMode"] = "OPAQUE";
  builder.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 1};

  const std::vector<float> floats{0.5, 0, 0, 0, 0.5, 0, 0, 0, 0.5, 1, 1, 1};
  const std::vector<float> floats4{0.5, 0, 0, 0.1f, 0, 0.5, 0, 0.1f, 0, 0, 0.5, 0.1f, 1, 1, 1, 1};
  const std::vector<std::uint8_t> bytes{128, 0, 0,   255, 0,   128, 0,   255,
                                        0,   0, 128, 255, 255, 255, 255, 255};
  const std::vector<std::uint16_t> shorts{32768, 0, 0,     0,     32768, 0,
                                          0,     0, 32768, 65535, 65535, 65535};
  const int kinds[] = {builder.AddFloats(floats, "VEC3", 3), builder.AddFloats(floats4, "VEC4", 4),
                       builder.Add(bytes, 5121, "VEC4", 4, true),
                       builder.Add(shorts, 5123, "VEC3", 3, true)};
  for (const int kind : kinds) {
    Primitive(&builder)["attributes"]["COLOR_0"] = kind;
    const MeshFile file = Read(builder);
    // Face 0 has corners 0, 2, 1: red, blue, green.
    const Eigen::Vector4f red = Shown(file.mesh, 0, {1, 0, 0});
    const Eigen::Vector4f blue = Shown(file.mesh, 0, {0, 1, 0});
    EXPECT_NEAR((red - Eigen::Vector4f(0.7354f, 0, 0, 1)).norm(), 0.0, 0.01) << kind;
    EXPECT_NEAR((blue - Eigen::Vector4f(0, 0, 0.7354f, 1)).norm(), 0.0, 0.01) << kind;
    EXPECT_TRUE(file.findings.empty()) << kind;
  }
  // They multiply the base colour.
  builder.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0, 1, 1, 1};
  EXPECT_NEAR(Shown(Read(builder).mesh, 0, {1, 0, 0}).head<3>().norm(), 0.0, 0.01);
}

TEST_F(GltfImport, ColoursBesideATextureAreSaid) {
  GltfBuilder builder = Square();
  builder.AddTexture(core::EncodePng(RedBlue()));
  Primitive(&builder)["attributes"]["COLOR_0"] =
      builder.AddFloats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, "VEC3", 3);
  EXPECT_EQ(CountOf(Read(builder), "vertex-colors-left-out"), 1);
  // One colour for all goes into the material.
  Primitive(&builder)["attributes"]["COLOR_0"] =
      builder.AddFloats({0, 1, 1, 0, 1, 1, 0, 1, 1, 0, 1, 1}, "VEC3", 3);
  const MeshFile file = Read(builder);
  EXPECT_TRUE(file.findings.empty());
  EXPECT_NEAR(file.mesh.materials[0].base_color[0], 0.0f, 1e-6);
}

TEST_F(GltfImport, TexturesSitWhereTheSpecificationPutsThem) {
  GltfBuilder builder = Square();
  builder.AddTexture(core::EncodePng(RedBlue()));
  const auto left_is_red = [](const core::TexturedMesh& mesh) {
    const Eigen::Vector4f right = Shown(mesh, 0, {0.1f, 0.8f, 0.1f});
    const Eigen::Vector4f left = Shown(mesh, 1, {0.1f, 0.1f, 0.8f});
    return left[0] > 0.9f && right[2] > 0.9f;
  };
  EXPECT_TRUE(left_is_red(Read(builder).mesh));
  // TEXCOORD_1 turned half round shows blue on the left.
  json& info = builder.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  Primitive(&builder)["attributes"]["TEXCOORD_1"] =
      builder.AddFloats({1, 0, 0, 0, 0, 1, 1, 1}, "VEC2", 2);
  info["texCoord"] = 1;
  EXPECT_FALSE(left_is_red(Read(builder).mesh));
  // The extension's own texCoord wins.
  info["extensions"]["KHR_texture_transform"] = {{"texCoord", 0}};
  EXPECT_TRUE(left_is_red(Read(builder).mesh));
}

TEST_F(GltfImport, TextureTransformsMoveCoordinates) {
  GltfBuilder builder = Square();
  json& info = builder.AddTexture(core::EncodePng(RedBlue()));
  info["extensions"]["KHR_texture_transform"] = {{"offset", {0.25, 0.125}}, {"scale", {0.5, 2.0}}};
  builder.root["extensionsUsed"] = {"KHR_texture_transform"};
  // The square's corner (1, 1) has (1, 0): (0.5 + 0.25, 0 + 0.125), then v from below.
  MeshFile file = Read(builder);
  EXPECT_NEAR((file.mesh.corner_uvs[2] - Eigen::Vector2f(0.75f, 0.875f)).norm(), 0.0, 1e-6);
  EXPECT_TRUE(file.findings.empty());
  // A quarter turn counter-clockwise, v pointing down: (1, 0) goes up, to (0, -1).
  info["extensions"]["KHR_texture_transform"] = {{"rotation", 1.5707963267948966}};
  file = Read(builder);
  EXPECT_NEAR((file.mesh.corner_uvs[2] - Eigen::Vector2f(0.0f, 2.0f)).norm(), 0.0, 1e-6);
}

TEST_F(GltfImport, NormalisedCoordinatesOfTexturesAreDecoded) {
  GltfBuilder builder = Square();
  builder.AddTexture(core::EncodePng(RedBlue()));
  Primitive(&builder)["attributes"]["TEXCOORD_0"] = builder.Add(
      std::vector<std::uint16_t>{0, 65535, 65535, 65535, 65535, 0, 0, 0}, 5123, "VEC2", 2, true);
  const core::TexturedMesh mesh = Read(builder).mesh;
  EXPECT_NEAR((mesh.corner_uvs[1] - Eigen::Vector2f(1, 0)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((mesh.corner_uvs[2] - Eigen::Vector2f(1, 1)).norm(), 0.0, 1e-6);
}

TEST_F(GltfImport, PicturesBesideAreFoundByEscapedNames) {
  GltfBuilder builder = Square();
  builder.root["images"] = {{{"uri", "tex/red%20blue.png"}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  WriteRedBlue("tex/red blue.png");
  EXPECT_EQ(Read(builder).mesh.textures.size(), 1u);
  builder.root["images"][0]["uri"] =
      "data:image/png;base64," + core::Base64(core::EncodePng(RedBlue()));
  EXPECT_EQ(Read(builder).mesh.textures.size(), 1u);
  builder.root["images"][0]["uri"] = "gone.png";
  EXPECT_EQ(CountOf(Read(builder), "texture-missing"), 1);
}

TEST_F(GltfImport, CompressedTexturesAreNamed) {
  GltfBuilder builder = Square();
  builder.AddTexture(core::EncodePng(RedBlue()));
  json& texture = builder.root["textures"][0];
  texture.erase("source");
  texture["extensions"]["KHR_texture_basisu"]["source"] = 0;
  builder.root["extensionsUsed"] = builder.root["extensionsRequired"] = {"KHR_texture_basisu"};
  MeshFile file = Read(builder);
  ASSERT_EQ(CountOf(file, "texture-unreadable"), 1);
  EXPECT_NE(file.findings[1].sentence.find("KTX2"), std::string::npos);
  EXPECT_EQ(file.mesh.mesh.triangles.size(), 2u);
  // WebP by its extension is read as any picture.
  texture["extensions"] = {{"EXT_texture_webp", {{"source", 0}}}};
  builder.root["extensionsUsed"] = builder.root["extensionsRequired"] = {"EXT_texture_webp"};
  EXPECT_EQ(Read(builder).mesh.textures.size(), 1u);
}

TEST_F(GltfImport, SpecularGlossinessUnlitAndGlowGiveColour) {
  GltfBuilder builder = Tetrahedron();
  Primitive(&builder)["material"] = 0;
  builder.root["materials"] = json::array({json::object()});
  builder.root["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
      {"diffuseFactor", {0, 1, 0, 1}}};
  EXPECT_NEAR((Shown(Read(builder).mesh, 0) - Eigen::Vector4f(0, 1, 0, 1)).norm(), 0.0, 1e-6);
  builder.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}},
                                {"emissiveFactor", {1, 0, 0}}}};
  const MeshFile glowing = Read(builder);
  EXPECT_NEAR((Shown(glowing.mesh, 0) - Eigen::Vector4f(1, 0, 0, 1)).norm(), 0.0, 1e-6);
  EXPECT_EQ(CountOf(glowing, "gltf-emission-as-color"), 1);
}

TEST_F(GltfImport, AlphaOfOpaqueMaterialsDoesNotCount) {
  core::Image image(1, 1, 4);
  image.pixels = {10, 20, 30, 0};
  GltfBuilder builder = Square();
  builder.AddTexture(core::EncodePng(image));
  EXPECT_NEAR(Shown(Read(builder).mesh, 0)[3], 1.0, 1e-6);
  builder.root["materials"][0]["alphaMode"] = "MASK";
  EXPECT_NEAR(Shown(Read(builder).mesh, 0)[3], 0.0, 1e-6);
}

TEST_F(GltfImport, WhatIsNotReadIsSaid) {
  GltfBuilder builder = Square();
  builder.root["materials"][0]["normalTexture"] = {{"index", 0}};
  builder.root["animations"] = json::array({json::object()});
  builder.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_clearcoat"};
  const MeshFile file = Read(builder);
  EXPECT_EQ(CountOf(file, "gltf-maps-not-read"), 1);
  ASSERT_EQ(CountOf(file, "gltf-not-read"), 1);
  for (const core::Finding& finding : file.findings) EXPECT_FALSE(finding.remedy.empty());
  EXPECT_NE(file.findings[0].sentence.find("KHR_lights_punctual"), std::string::npos);
}

TEST_F(GltfImport, RequiredExtensionsOfShapesAreRefusedByName) {
  GltfBuilder builder = Tetrahedron();
  builder.root["extensionsRequired"] = {"VENDOR_shapes"};
  EXPECT_NE(Refused(builder).find("VENDOR_shapes"), std::string::npos);
  builder.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  const std::string refusal = Refused(builder);
  EXPECT_NE(refusal.find("EXT_meshopt_compression"), std::string::npos);
  EXPECT_NE(refusal.find("gltfpack"), std::string::npos);
  builder.root["extensionsRequired"] = {"KHR_materials_clearcoat", "KHR_texture_transform"};
  EXPECT_EQ(Refused(builder), "");
}

// A can of radius 0.04 and height 0.1, compressed by Google's own encoder.
constexpr const char* kDracoCan =
    R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_draco_mesh_compression"],)"
    R"("extensionsRequired":["KHR_draco_mesh_compression"],"scenes":[{"nodes":[0]}],"scene":0,)"
    R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,)"
    R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,)"
    R"("attributes":{"POSITION":0}}}}]}],)"
    R"("accessors":[{"componentType":5126,"count":50,"type":"VEC3"},)"
    R"({"componentType":5125,"count":288,"type":"SCALAR"}],)"
    R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":328}],)"
    R"("buffers":[{"byteLength":328,"uri":"data:application/octet-stream;base64,)";

TEST_F(GltfImport, DracoIsDecompressed) {
  const std::string data =
      "RFJBQ08CAgEBAAAAMmAAXwAAGN+2bdu2bdvWVlVVVVVVVVVVVbWqCgAACgEBEAH/AAABAAkDAAACAAEBAA8HSQEjmTkD"
      "IQUGfMT+5s+BmWgA4O/MkAAADWnFAgCXmUcBABb7BgAAdW8AAFB3FABocQgCgKZmKgCIYBYDgEf9NAD4xk8DQG9cMQB0"
      "1KYCQAiGIABkakcBQBb3BgD8tG8AwE97FABcsQgCwKZyKgCEIBYDQEcBNQD0BlADgG9oMQB4FKKpACCCIggAnOpRAIDF"
      "vgEAQN0bAADUHQUAWhyCAKCpmQoAIpjFAOBRPw0AvvHTANAbVwwAHbWpABCCIQgAmdpRAJDFvQEAP+0bAPDTHgUAVyyC"
      "ALCpnAoAIYjFANBRQA0AvQHUAOAbPw0AQBcDAAAAAP8/AAAK1yO9zcxMvQrXI73NzMw9Dg==";
  const MeshFile file = ReadMeshFile(Write("can.gltf", kDracoCan + data + "\"}]}"));
  EXPECT_EQ(file.mesh.mesh.triangles.size(), 96u);
  EXPECT_TRUE(file.findings.empty());
  const Eigen::Vector3d size = Box(file).sizes();
  EXPECT_NEAR((size - Eigen::Vector3d(0.08, 0.1, 0.08)).norm(), 0.0, 1e-4);
  // A prism over 24 corners: half of 24 r^2 sin(15 degrees) times its height.
  EXPECT_NEAR(Volume(file.mesh.mesh), 12.0 * 0.04 * 0.04 * std::sin(M_PI / 12.0) * 0.1, 2e-7);
  // Damaged data is refused in words.
  std::string damaged = data;
  damaged[30] = damaged[30] == 'A' ? 'B' : 'A';
  damaged.replace(0, 8, "RFJBQ08J");
  EXPECT_NE(Refusal(Write("bad.gltf", kDracoCan + damaged + "\"}]}")).find("Draco"),
            std::string::npos);
}

TEST_F(GltfImport, DamageIsOneErrorEach) {
  EXPECT_NE(Refusal(Write("a.gltf", "{\"asset\": {\"version\": \"2.0\"}")), "");
  EXPECT_NE(Refusal(Write("a.gltf", "[]")), "");
  EXPECT_NE(Refusal(Write("a.gltf", "{\"asset\":{\"version\":\"1.0\"}}")).find("glTF 1.0"),
            std::string::npos);
  EXPECT_NE(Refusal(Write("a.glb", std::string("glTF\1\0\0\0\24\0\0\0", 12) + "        "))
                .find("only 2.0"),
            std::string::npos);
  const std::string whole = Tetrahedron().Glb();
  for (size_t length = 5; length < whole.size(); length += 7) {
    EXPECT_NE(Refusal(Write("cut.glb", whole.substr(0, length))), "") << length;
  }
  GltfBuilder builder = Tetrahedron();
  builder.root["accessors"][0]["count"] = 5;
  EXPECT_NE(Refused(builder).find("beyond"), std::string::npos);
  builder = Tetrahedron();
  builder.root["accessors"][0]["count"] = 3;
  EXPECT_NE(Refused(builder).find("out of range"), std::string::npos);
  builder = Tetrahedron();
  builder.root["accessors"][0]["bufferView"] = 99;
  EXPECT_NE(Refused(builder).find("bufferViews[99]"), std::string::npos);
  builder = Tetrahedron();
  Primitive(&builder)["attributes"].erase("POSITION");
  EXPECT_NE(Refused(builder).find("no faces"), std::string::npos);
}

}  // namespace
}  // namespace simwright::assets
