#include "viewer/mesh_packing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "viewer/document.h"

namespace simwright::viewer {
namespace {

template <typename T>
T At(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

// Returns the position of a corner of a packed mesh.
Eigen::Vector3f Position(const PackedMesh& mesh, std::uint32_t vertex) {
  return {At<float>(mesh.bytes, 12 * vertex), At<float>(mesh.bytes, 12 * vertex + 4),
          At<float>(mesh.bytes, 12 * vertex + 8)};
}

Eigen::Vector3d Normal(const PackedMesh& mesh, std::uint32_t vertex) {
  const std::size_t at = 12 * static_cast<std::size_t>(mesh.vertices) + 4 * vertex;
  return Eigen::Vector3d(At<std::int8_t>(mesh.bytes, at), At<std::int8_t>(mesh.bytes, at + 1),
                         At<std::int8_t>(mesh.bytes, at + 2)) /
         127.0;
}

std::uint32_t Index(const PackedMesh& mesh, int triangle, int corner) {
  const std::size_t per_vertex = mesh.has_uvs ? 24 : 16;
  return At<std::uint32_t>(mesh.bytes, per_vertex * static_cast<std::size_t>(mesh.vertices) +
                                           4 * static_cast<std::size_t>(3 * triangle + corner));
}

TEST(MeshPacking, ABoxHasAVertexForEachCornerOfEachFace) {
  core::TexturedMesh box;
  box.mesh = assets::BoxMesh({0.2, 0.3, 0.4});
  const PackedMesh packed = PackMesh(box);
  EXPECT_EQ(packed.vertices, 24);
  EXPECT_EQ(packed.triangles, 12);
  ASSERT_EQ(packed.bytes.size(), 24u * 16 + 12 * 12);
  for (int t = 0; t < 12; ++t) {
    const Eigen::Vector3d flat = core::TriangleAreaVector(box.mesh, t).normalized();
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = Index(packed, t, k);
      ASSERT_LT(vertex, 24u);
      const Eigen::Vector3d source =
          box.mesh.vertices[static_cast<std::size_t>(box.mesh.triangles[t][k])];
      EXPECT_LT((Position(packed, vertex) - source.cast<float>()).norm(), 1e-7);
      EXPECT_LT((Normal(packed, vertex) - flat).norm(), 0.01) << "faces stay flat";
    }
  }
}

TEST(MeshPacking, ASphereIsSmooth) {
  core::TexturedMesh sphere;
  sphere.mesh = assets::SphereMesh(1.0, 32);
  const PackedMesh packed = PackMesh(sphere);
  EXPECT_EQ(packed.vertices, static_cast<int>(sphere.mesh.vertices.size()));
  for (std::uint32_t v = 0; v < static_cast<std::uint32_t>(packed.vertices); ++v) {
    const Eigen::Vector3d radial = Position(packed, v).cast<double>().normalized();
    EXPECT_GT(Normal(packed, v).normalized().dot(radial), std::cos(0.06));
  }
}

TEST(MeshPacking, TrianglesAreGroupedByMaterial) {
  core::TexturedMesh box;
  box.mesh = assets::BoxMesh({1, 1, 1});
  box.materials.resize(2);
  for (int t = 0; t < 12; ++t) box.triangle_material.push_back(t % 3 == 0 ? 1 : 0);
  const PackedMesh packed = PackMesh(box);
  ASSERT_EQ(packed.groups.size(), 2u);
  EXPECT_EQ(packed.groups[0].material, 0);
  EXPECT_EQ(packed.groups[0].count, 8);
  EXPECT_EQ(packed.groups[1].first, 8);
  EXPECT_EQ(packed.groups[1].count, 4);
}

TEST(MeshPacking, TextureCoordinatesStayAtTheirCorners) {
  core::TexturedMesh box;
  box.mesh = assets::BoxMesh({1, 1, 1});
  box.textures.emplace_back(2, 2, 3);
  for (int corner = 0; corner < 36; ++corner) {
    box.corner_uvs.emplace_back(0.01f * static_cast<float>(corner), 0.5f);
  }
  const PackedMesh packed = PackMesh(box);
  ASSERT_TRUE(packed.has_uvs);
  for (int corner = 0; corner < 36; ++corner) {
    const std::uint32_t vertex = Index(packed, corner / 3, corner % 3);
    const float u =
        At<float>(packed.bytes, 16 * static_cast<std::size_t>(packed.vertices) + 8 * vertex);
    EXPECT_EQ(u, 0.01f * static_cast<float>(corner));
  }
}

TEST(DocumentBuilder, EqualMeshesAreStoredOnce) {
  DocumentBuilder builder("asset", "boxes");
  const int first = builder.AddMesh(assets::BoxMesh({1, 1, 1}), "a");
  EXPECT_EQ(builder.AddMesh(assets::BoxMesh({1, 1, 1}), "b"), first);
  EXPECT_NE(builder.AddMesh(assets::BoxMesh({1, 1, 2}), "c"), first);
  EXPECT_EQ(builder.Take().buffers.size(), 2u);
}

TEST(DocumentBuilder, RefusesDamagedMeshes) {
  DocumentBuilder builder("asset", "damaged");
  core::TriangleMesh mesh = assets::BoxMesh({1, 1, 1});
  mesh.triangles.emplace_back(0, 1, 99);
  EXPECT_THROW(builder.AddMesh(mesh, "a.obj"), core::Error);
  mesh = assets::BoxMesh({1, 1, 1});
  mesh.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(builder.AddMesh(mesh, "a.obj"), core::Error);
}

}  // namespace
}  // namespace simwright::viewer
