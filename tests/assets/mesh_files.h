#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "assets/mesh_import.h"
#include "core/base64.h"
#include "core/error.h"

namespace simwright::assets {

// A folder of small mesh files, made in the test.
class MeshFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = std::filesystem::temp_directory_path() /
            (std::string("simwright_") +
             ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name() + "_" +
             ::testing::UnitTest::GetInstance()->current_test_info()->name());
    folder_ = root_ / "source";
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  std::filesystem::path Write(const std::filesystem::path& name, const std::string& bytes) {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  // 8 x 8 texels, the left half red, the right one blue.
  std::filesystem::path WriteRedBlue(const std::filesystem::path& name) {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    core::WritePng(path, RedBlue());
    return path;
  }
  static core::Image RedBlue() {
    core::Image image(8, 8, 3);
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) image.At(x, y)[x < 4 ? 0 : 2] = 255;
    }
    return image;
  }

  // Returns the error message; "" if there was none.
  static std::string Refusal(const std::filesystem::path& path) {
    try {
      ReadMeshFile(path);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  }
  static int CountOf(const MeshFile& file, const std::string& code) {
    return static_cast<int>(std::count_if(file.findings.begin(), file.findings.end(),
                                          [&](const auto& f) { return f.code == code; }));
  }
  static double Volume(const core::TriangleMesh& mesh) {
    double volume = 0.0;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      volume += mesh.vertices[static_cast<size_t>(t[0])].dot(
                    mesh.vertices[static_cast<size_t>(t[1])].cross(
                        mesh.vertices[static_cast<size_t>(t[2])])) /
                6.0;
    }
    return volume;
  }
  // Returns the colour, RGBA in [0, 1], of a triangle at barycentric weights.
  static Eigen::Vector4f Shown(const core::TexturedMesh& mesh, size_t triangle,
                               const Eigen::Vector3f& weights) {
    const core::Material& material =
        mesh.materials[static_cast<size_t>(mesh.triangle_material[triangle])];
    if (material.texture < 0) return material.base_color;
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();
    for (size_t k = 0; k < 3; ++k) {
      uv += weights[static_cast<int>(k)] * mesh.corner_uvs[3 * triangle + k];
    }
    return material.base_color.cwiseProduct(
        core::SampleTexture(mesh.textures[static_cast<size_t>(material.texture)], uv));
  }
  static Eigen::Vector4f Shown(const core::TexturedMesh& mesh, size_t triangle) {
    return Shown(mesh, triangle, Eigen::Vector3f::Constant(1.0f / 3.0f));
  }

  std::filesystem::path root_, folder_;
};

// A tetrahedron with its right angle at the origin: volume 1/6.
inline constexpr float kTetrahedron[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
inline constexpr int kTetrahedronFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

}  // namespace simwright::assets
