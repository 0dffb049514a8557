// Files with a wrong extension and unsupported formats: both are named with a remedy.
#include "assets/mesh_format.h"

#include "mesh_files.h"

namespace simwright::assets {
namespace {

class MeshFormats : public MeshFolder {};

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(MeshFormats, LfsPointersAreNamedInEveryFormat) {
  const std::string pointer =
      "version https://git-lfs.github.com/spec/v1\noid sha256:" + std::string(64, 'a') +
      "\nsize 1234\n";
  for (const char* name : {"a.obj", "a.glb", "a.gltf", "a.ply", "a.stl", "a.dae", "a.fbx"}) {
    const std::string refusal = Refusal(Write(name, pointer));
    EXPECT_NE(refusal.find("Git LFS pointer"), std::string::npos) << name << ": " << refusal;
    EXPECT_NE(refusal.find("git lfs pull"), std::string::npos) << name;
  }
  EXPECT_THROW(ReadBareObj(folder_ / "a.obj"), core::Error);
}

TEST_F(MeshFormats, WhatStandsInForAFileIsNamed) {
  const auto expect = [&](const std::string& bytes, const std::string& word) {
    const std::string refusal = Refusal(Write("x.obj", bytes));
    EXPECT_NE(refusal.find(word), std::string::npos) << word << ": " << refusal;
  };
  expect("../.git/annex/objects/aB/cd/SHA256E-s12--00.obj/SHA256E-s12--00.obj", "git-annex");
  expect("<!DOCTYPE html>\n<html><body>404</body></html>", "web page");
  expect(std::string("PK\3\4rest", 8), "archive");
  expect("\x1f\x8b\x08rest", "archive");
  expect("Salted__0123456789", "encrypted");
  expect(std::string(2000, '\0'), "zeros");
  expect("glTF\2\0\0\0", "rename it to .glb");
  expect("ply\nformat ascii 1.0\n", "rename it to .ply");
  expect("<?xml version=\"1.0\"?>\n<COLLADA>", "rename it to .dae");
  expect("", "empty");
}

TEST_F(MeshFormats, FormatsThatAreNotReadAreNamedWithARemedy) {
  const auto expect = [&](const char* name, const std::string& word, const std::string& remedy) {
    const std::string refusal = Refusal(Write(name, "something"));
    EXPECT_NE(refusal.find(word), std::string::npos) << refusal;
    EXPECT_NE(refusal.find(remedy), std::string::npos) << refusal;
  };
  expect("a.FBX", "FBX", "Blender");
  expect("a.usdz", "USD", "Blender");
  expect("a.step", "STEP", "FreeCAD");
  expect("a.3ds", "3DS", "Blender");
  expect("a.off", "OFF", "PLY");
  expect("a.mtl", "an OBJ's materials", ".obj");
  expect("a.xyz", "not a mesh", "OBJ");
  EXPECT_NE(Refusal(Write("a.obj", "Kaydara FBX Binary  \0")).find("FBX"), std::string::npos);
}

TEST_F(MeshFormats, EndingsCountInAnyCase) {
  EXPECT_EQ(ReadMesh(Write("A.OBJ", kTriangle)).mesh.triangles.size(), 1u);
  EXPECT_TRUE(HasMeshExtension("a.GLB"));
  EXPECT_FALSE(HasMeshExtension("a.fbx"));
}

// Every prefix of a file is rejected or read, never with more content than it has.
TEST_F(MeshFormats, FilesCutShortAreRefusedInWords) {
  const std::string whole =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty "
      "float y\nproperty float z\nelement face 1\nproperty list uchar int "
      "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (size_t length = 1; length < whole.size() - 2; ++length) {
    EXPECT_NE(Refusal(Write("cut.ply", whole.substr(0, length))), "") << length;
  }
  EXPECT_EQ(Refusal(Write("cut.ply", whole)), "");
}

}  // namespace
}  // namespace simwright::assets
