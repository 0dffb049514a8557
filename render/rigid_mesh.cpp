#include "render/rigid_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "render/light.h"
#include "render/reflection.h"
#include "render/rigid_mesh_content.h"

namespace simwright::render {
namespace {

constexpr int kLinearSteps = 4096, kByteSteps = 16384;

std::array<float, kLinearSteps + 1> MakeLinearTable() {
  std::array<float, kLinearSteps + 1> table;
  for (int i = 0; i <= kLinearSteps; ++i) {
    table[static_cast<std::size_t>(i)] = LinearFromSrgb(static_cast<float>(i) / kLinearSteps);
  }
  return table;
}

std::array<std::uint8_t, kByteSteps + 1> MakeByteTable() {
  std::array<std::uint8_t, kByteSteps + 1> table;
  for (int i = 0; i <= kByteSteps; ++i) {
    const float srgb = SrgbFromLinear(static_cast<float>(i) / kByteSteps);
    table[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255.0f * srgb));
  }
  return table;
}

const std::array<float, kLinearSteps + 1> kLinearTable = MakeLinearTable();
const std::array<std::uint8_t, kByteSteps + 1> kByteTable = MakeByteTable();

std::vector<Eigen::Vector3f> SinglePrecision(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<Eigen::Vector3f> single;
  for (const Eigen::Vector3d& vertex : vertices) single.push_back(vertex.cast<float>());
  return single;
}

// Returns a texture's bilinear sample, sRGB, each in [0, 1] (core::SampleTexture's first three).
Eigen::Vector3f TextureColor(const core::Image& texture, const Eigen::Vector2f& uv) {
  const float x = (uv.x() - std::floor(uv.x())) * static_cast<float>(texture.width) - 0.5f;
  const float y =
      (1.0f - (uv.y() - std::floor(uv.y()))) * static_cast<float>(texture.height) - 0.5f;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  // x0 is in [-1, width - 1], so one step wraps.
  const int xs[2] = {x0 < 0 ? texture.width - 1 : x0, x0 + 1 >= texture.width ? 0 : x0 + 1};
  const int ys[2] = {y0 < 0 ? texture.height - 1 : std::min(y0, texture.height - 1),
                     y0 + 1 >= texture.height ? 0 : y0 + 1};
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int k = 0; k < 4; ++k) {
    const float weight = (k % 2 ? fx : 1.0f - fx) * (k / 2 ? fy : 1.0f - fy);
    const std::uint8_t* p = texture.At(std::min(xs[k % 2], texture.width - 1), ys[k / 2]);
    for (int c = 0; c < 3; ++c) {
      sum[c] += weight * static_cast<float>(p[texture.channels < 3 ? 0 : c]);
    }
  }
  return sum / 255.0f;
}

}  // namespace

float TabulatedLinear(float srgb) {
  return kLinearTable[static_cast<std::size_t>(std::clamp(srgb, 0.0f, 1.0f) * kLinearSteps + 0.5f)];
}

std::uint8_t TabulatedByte(float linear) {
  return kByteTable[static_cast<std::size_t>(std::clamp(linear, 0.0f, 1.0f) * kByteSteps + 0.5f)];
}

RigidMesh::Content::Content(const std::vector<Eigen::Vector3f>& vertices,
                            const core::TexturedMesh& mesh)
    : tree(vertices, mesh.mesh.triangles), corner_uvs(mesh.corner_uvs), textures(mesh.textures) {
  for (const Eigen::Vector3f& vertex : vertices) bounds.extend(vertex);
  const bool colored = !mesh.triangle_material.empty();
  for (const TriangleNormals& normals : NormalsOfTriangles(vertices, mesh.mesh.triangles)) {
    const int material = colored ? mesh.triangle_material[triangles.size()] : 0;
    triangles.push_back({normals, material});
  }
  const auto add_material = [&](const Eigen::Vector4f& color, int texture) {
    ShadedMaterial& material = materials.emplace_back();
    material.srgb = color.head<3>();
    for (int c = 0; c < 3; ++c) material.linear[c] = LinearFromSrgb(color[c]);
    material.texture = corner_uvs.empty() ? -1 : texture;
  };
  if (!colored) {
    add_material(Eigen::Vector4f(0.75f, 0.75f, 0.75f, 1.0f), -1);
    return;
  }
  for (const core::Material& material : mesh.materials) {
    const bool empty =
        material.texture >= 0 && textures[static_cast<std::size_t>(material.texture)].empty();
    add_material(material.base_color, empty ? -1 : material.texture);
  }
}

RigidMesh::RigidMesh(const core::TexturedMesh& mesh, const core::PbrLook& look) {
  core::RequireValid(mesh, "mesh of a scene");
  RequireMaps(look);
  if (mesh.mesh.triangles.empty()) throw core::Error("a mesh without faces cannot be rendered");
  auto content = std::make_unique<Content>(SinglePrecision(mesh.mesh.vertices), mesh);
  if (!mesh.triangle_material.empty()) content->look = look;
  const bool bumpy = std::any_of(content->look.materials.begin(), content->look.materials.end(),
                                 [](const core::PbrMaterial& m) { return m.normal_map >= 0; });
  for (const Eigen::Vector3i& t : mesh.mesh.triangles) {
    if (!bumpy || mesh.corner_uvs.empty()) break;
    Eigen::Matrix3f& corners = content->corners.emplace_back();
    for (int k = 0; k < 3; ++k) {
      corners.col(k) = mesh.mesh.vertices[static_cast<std::size_t>(t[k])].cast<float>();
    }
  }
  content_ = std::move(content);
}

RigidMesh::~RigidMesh() = default;

const Eigen::AlignedBox3f& RigidMesh::bounds() const {
  return content_->bounds;
}

int RigidMesh::triangle_count() const {
  return static_cast<int>(content_->triangles.size());
}

Eigen::Vector3f LinearAlbedo(const RigidMesh::Content& mesh, int triangle, float u, float v) {
  const auto t = static_cast<std::size_t>(triangle);
  const ShadedMaterial& material =
      mesh.materials[static_cast<std::size_t>(mesh.triangles[t].material)];
  if (material.texture < 0) return material.linear;
  const Eigen::Vector2f uv = (1.0f - u - v) * mesh.corner_uvs[3 * t] +
                             u * mesh.corner_uvs[3 * t + 1] + v * mesh.corner_uvs[3 * t + 2];
  const Eigen::Vector3f srgb =
      TextureColor(mesh.textures[static_cast<std::size_t>(material.texture)], uv)
          .cwiseProduct(material.srgb);
  return {TabulatedLinear(srgb.x()), TabulatedLinear(srgb.y()), TabulatedLinear(srgb.z())};
}

}  // namespace simwright::render
