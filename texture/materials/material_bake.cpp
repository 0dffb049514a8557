#include "texture/materials/material_bake.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "render/scene.h"

namespace simwright::texture {
namespace {

constexpr int kInsideRays = 12;
constexpr float kInsideBlocked = 0.9f;  // of the horizontal rays

// The tangents of a triangle in the directions of u and v, unit and at right angles to its normal,
// and the spacing of texels (m).
struct TexelFrame {
  Eigen::Vector3f tangent{1, 0, 0}, bitangent{0, 1, 0};
  float spacing = 0.0f;
};

std::vector<TexelFrame> TexelFrames(const core::TriangleMesh& mesh,
                                    const std::vector<Eigen::Vector2f>& uvs, int size) {
  std::vector<TexelFrame> frames(mesh.triangles.size());
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const Eigen::Vector3i& corner = mesh.triangles[t];
    const Eigen::Vector3d e1 = mesh.vertices[corner[1]] - mesh.vertices[corner[0]];
    const Eigen::Vector3d e2 = mesh.vertices[corner[2]] - mesh.vertices[corner[0]];
    const Eigen::Vector2d d1 = (uvs[3 * t + 1] - uvs[3 * t]).cast<double>();
    const Eigen::Vector2d d2 = (uvs[3 * t + 2] - uvs[3 * t]).cast<double>();
    const double area = d1.x() * d2.y() - d1.y() * d2.x();
    const double surface = e1.cross(e2).norm();
    if (!(std::abs(area) > 1e-18) || !(surface > 0.0)) continue;
    const Eigen::Vector3d du = (d2.y() * e1 - d1.y() * e2) / area;
    const Eigen::Vector3d dv = (d1.x() * e2 - d2.x() * e1) / area;
    frames[t].tangent = du.normalized().cast<float>();
    frames[t].bitangent = dv.normalized().cast<float>();
    frames[t].spacing = static_cast<float>(std::sqrt(surface / std::abs(area)) / size);
  }
  return frames;
}

std::uint8_t Byte(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

class Baker {
 public:
  Baker(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector2f>& uvs,
        const TexelMap& map, const MaterialPlan& plan)
      : mesh_(mesh), map_(map), plan_(plan), frames_(TexelFrames(mesh, uvs, map.size)) {
    shape_.mesh = mesh;
    scene_.Add(&shape_);
    scene_.Commit();
    if (std::any_of(plan.inside_material.begin(), plan.inside_material.end(),
                    [](int index) { return index >= 0; })) {
      inside_ = InsideOfVessel(mesh);
    }
  }

  MaterialMaps Bake() {
    MaterialMaps maps;
    maps.color = core::Image(map_.size, map_.size, 3);
    maps.roughness = core::Image(map_.size, map_.size, 1);
    maps.metallic = core::Image(map_.size, map_.size, 1);
    maps.normal = core::Image(map_.size, map_.size, 3);
    std::vector<std::uint8_t> metal(static_cast<std::size_t>(map_.size), 0);
    core::ParallelFor(map_.size, [&](int y) {
      if (core::CancelRequested()) return;
      for (int x = 0; x < map_.size; ++x) {
        const std::size_t texel = map_.Index(x, y);
        if (map_.triangle[texel] < 0) continue;
        const MaterialSample sample = BakeTexel(texel, &maps.normal);
        for (int c = 0; c < 3; ++c) maps.color.pixels[3 * texel + c] = Byte(sample.color[c]);
        maps.roughness.pixels[texel] = Byte(sample.roughness);
        maps.metallic.pixels[texel] = Byte(sample.metallic);
        metal[static_cast<std::size_t>(y)] |= sample.metallic > 0.02f;
      }
    });
    core::CheckCancelled();
    maps.any_metal = std::find(metal.begin(), metal.end(), 1) != metal.end();
    for (core::Image* image : {&maps.color, &maps.roughness, &maps.metallic, &maps.normal}) {
      FillBetweenCharts(map_, kGutter, image);
    }
    return maps;
  }

 private:
  MaterialSample BakeTexel(std::size_t texel, core::Image* normals) const {
    const std::size_t t = static_cast<std::size_t>(map_.triangle[texel]);
    const TexelFrame& at = frames_[t];
    int index = plan_.triangle_material[t];
    if (!inside_.empty() && inside_[t] && plan_.inside_material[index] >= 0) {
      index = plan_.inside_material[index];
    }
    const PartFrame& frame = plan_.frames[plan_.triangle_frame[t]];
    MaterialPoint point;
    point.position = map_.Position(mesh_, texel).cast<float>();
    const int handle = plan_.handle_material[index];
    if (handle >= 0 && IsOnHandle(frame, point.position)) index = handle;
    const SurfaceMaterial& material = plan_.materials[index];
    render::Hit hit;
    hit.instance = 0;
    hit.triangle = map_.triangle[texel];
    const Eigen::Vector3f inside = map_.OnTriangle(texel);
    hit.u = inside[1];
    hit.v = inside[2];
    point.normal = scene_.ShadingNormal(hit);
    point.footprint = at.spacing;
    const MaterialSample sample = EvaluateMaterial(material, frame, point);
    Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
    if (at.spacing > 0.0f) {
      const auto slope = [&](const Eigen::Vector3f& direction) {
        MaterialPoint beside = point;
        beside.position += at.spacing * direction;
        return (EvaluateMaterial(material, frame, beside).height - sample.height) / at.spacing;
      };
      if (sample.height != 0.0f || material.substance == Substance::kPaint) {
        normal = Eigen::Vector3f(-slope(at.tangent), -slope(at.bitangent), 1.0f).normalized();
      }
    }
    for (int c = 0; c < 3; ++c) normals->pixels[3 * texel + c] = Byte(0.5f + 0.5f * normal[c]);
    return sample;
  }

  const core::TriangleMesh& mesh_;
  const TexelMap& map_;
  const MaterialPlan& plan_;
  const std::vector<TexelFrame> frames_;
  core::TexturedMesh shape_;
  render::Scene scene_;
  std::vector<std::uint8_t> inside_;  // (M), empty if no material asks for it
};

}  // namespace

std::vector<std::uint8_t> InsideOfVessel(const core::TriangleMesh& mesh) {
  core::TexturedMesh shape;
  shape.mesh = mesh;
  render::Scene scene;
  scene.Add(&shape);
  scene.Commit();
  const float reach = static_cast<float>(core::Bounds(mesh).diagonal().norm());
  std::vector<std::uint8_t> inside(mesh.triangles.size(), 0);
  core::ParallelFor(static_cast<int>(inside.size()), [&](int t) {
    const Eigen::Vector3i& corner = mesh.triangles[static_cast<std::size_t>(t)];
    const Eigen::Vector3d middle =
        (mesh.vertices[corner[0]] + mesh.vertices[corner[1]] + mesh.vertices[corner[2]]) / 3.0;
    const Eigen::Vector3d normal = core::TriangleAreaVector(mesh, t).stableNormalized();
    const Eigen::Vector3f start = (middle + 2e-3 * reach * normal).cast<float>();
    int blocked = 0;
    for (int ray = 0; ray < kInsideRays; ++ray) {
      const float angle = 6.2831853f * (static_cast<float>(ray) + 0.5f) / kInsideRays;
      const Eigen::Vector3f direction(std::cos(angle), std::sin(angle), 0.02f);
      blocked += scene.Occluded(start, direction, 0.0f, 2.0f * reach);
      if (ray - blocked >= 2) break;
    }
    // The inside of a closed body sees nothing of the sky.
    bool sees_sky = false;
    for (int ray = 0; ray < kInsideRays && !sees_sky; ++ray) {
      const float angle = 6.2831853f * static_cast<float>(ray) / kInsideRays;
      const float aside = ray % 3 == 0 ? 0.1f : ray % 3 == 1 ? 0.4f : 0.8f;
      const Eigen::Vector3f up(aside * std::cos(angle), aside * std::sin(angle), 1.0f);
      sees_sky = !scene.Occluded(start, up, 0.0f, 2.0f * reach);
    }
    inside[static_cast<std::size_t>(t)] = blocked >= kInsideBlocked * kInsideRays && sees_sky;
  });
  return inside;
}

bool IsOnHandle(const PartFrame& frame, const Eigen::Vector3f& position) {
  constexpr float kBeyond = 1.015f;  // of the radius
  if (!frame.round) return false;
  const float radius = 0.5f * frame.box.sizes().head<2>().maxCoeff();
  return (position - frame.box.center()).head<2>().norm() > kBeyond * radius;
}

MaterialMaps BakeMaterials(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector2f>& uvs,
                           const TexelMap& map, const MaterialPlan& plan) {
  const std::size_t count = mesh.triangles.size();
  if (uvs.size() != 3 * count || plan.triangle_material.size() != count ||
      plan.triangle_frame.size() != count || plan.inside_material.size() != plan.materials.size()) {
    throw core::Error("the plan of materials does not fit the mesh");
  }
  return Baker(mesh, uvs, map, plan).Bake();
}

}  // namespace simwright::texture
