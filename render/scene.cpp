#include "render/scene.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/ray_tree.h"

namespace simwright::render {
namespace {

struct Instance {
  const core::TexturedMesh* mesh;
  Eigen::Isometry3d world_from_mesh;
  std::vector<Eigen::Vector3f> vertices;  // (N x 3), world
  std::vector<Eigen::Vector3f> normals;   // (N x 3), world
  const core::PbrLook* look = nullptr;
};

constexpr float kSmoothCosine = 0.766f;  // 40 degrees

}  // namespace

struct Scene::Content {
  RayTree tree;
  std::vector<Instance> instances;

  static void Place(Instance* instance, const std::vector<Eigen::Vector3d>& vertices) {
    instance->vertices.resize(vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i) {
      instance->vertices[i] = (instance->world_from_mesh * vertices[i]).cast<float>();
    }
    instance->normals.assign(vertices.size(), Eigen::Vector3f::Zero());
    for (const Eigen::Vector3i& t : instance->mesh->mesh.triangles) {
      const Eigen::Vector3f& a = instance->vertices[t[0]];
      const Eigen::Vector3f area =
          (instance->vertices[t[1]] - a).cross(instance->vertices[t[2]] - a);
      for (int k = 0; k < 3; ++k) instance->normals[t[k]] += area;
    }
    for (Eigen::Vector3f& normal : instance->normals) normal.stableNormalize();
  }
};

Scene::Scene() : content_(std::make_unique<Content>()) {}

Scene::~Scene() = default;

int Scene::Add(const core::TexturedMesh* mesh, const Eigen::Isometry3d& world_from_mesh,
               const core::PbrLook* look) {
  core::RequireValid(*mesh, "scene");
  if (look != nullptr) RequireMaps(*look);
  if (mesh->mesh.triangles.empty()) throw core::Error("a mesh without faces cannot be rendered");
  Instance instance{mesh, world_from_mesh, {}, {}, look};
  Content::Place(&instance, mesh->mesh.vertices);
  const int index = content_->tree.Add(instance.vertices, mesh->mesh.triangles, false);
  content_->instances.push_back(std::move(instance));
  return index;
}

void Scene::MoveVertices(int instance, const std::vector<Eigen::Vector3d>& vertices) {
  Instance& moved = content_->instances.at(static_cast<size_t>(instance));
  if (vertices.size() != moved.vertices.size()) {
    throw core::Error("the number of vertices must not change");
  }
  Content::Place(&moved, vertices);
  content_->tree.Move(instance, moved.vertices);
}

void Scene::Commit() {
  content_->tree.Commit();
}

Hit Scene::Intersect(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                     float far) const {
  return content_->tree.Intersect(origin, direction, near, far);
}

void Scene::IntersectBundle(const Eigen::Vector3f& origin, const Eigen::Vector3f* directions,
                            int count, Hit* hits) const {
  static_assert(kRayBundle == RayTree::kBundle);
  content_->tree.IntersectBundle(origin, directions, count, 0.0f, 1e30f, hits);
}

bool Scene::Occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                     float far) const {
  return content_->tree.Occluded(origin, direction, near, far);
}

int Scene::size() const {
  return static_cast<int>(content_->instances.size());
}

const core::TexturedMesh& Scene::mesh(int instance) const {
  return *content_->instances.at(static_cast<size_t>(instance)).mesh;
}

const core::PbrLook* Scene::look(int instance) const {
  return content_->instances[static_cast<size_t>(instance)].look;
}

bool Scene::HasLooks() const {
  return std::any_of(content_->instances.begin(), content_->instances.end(),
                     [](const Instance& instance) { return instance.look != nullptr; });
}

SurfaceReflection Scene::ReflectionAt(const Hit& hit, const Eigen::Vector3f& normal,
                                      Eigen::Vector3f* perturbed) const {
  *perturbed = normal;
  const Instance& of = content_->instances[static_cast<size_t>(hit.instance)];
  const core::TexturedMesh& mesh = *of.mesh;
  if (of.look == nullptr || mesh.triangle_material.empty()) return {};
  const size_t t = static_cast<size_t>(hit.triangle);
  if (mesh.corner_uvs.empty()) {
    return SampleReflection(*of.look, mesh.triangle_material[t], nullptr);
  }
  const Eigen::Vector2f* uvs = &mesh.corner_uvs[3 * t];
  const Eigen::Vector2f uv = (1.0f - hit.u - hit.v) * uvs[0] + hit.u * uvs[1] + hit.v * uvs[2];
  const SurfaceReflection surface = SampleReflection(*of.look, mesh.triangle_material[t], &uv);
  if (surface.has_normal) {
    *perturbed =
        PerturbedNormal(surface.tangent_normal, normal, Corners(hit.instance, hit.triangle), uvs);
  }
  return surface;
}

Eigen::Matrix3f Scene::Corners(int instance, int triangle) const {
  const Instance& of = content_->instances[static_cast<size_t>(instance)];
  const Eigen::Vector3i& t = of.mesh->mesh.triangles[static_cast<size_t>(triangle)];
  Eigen::Matrix3f corners;
  for (int k = 0; k < 3; ++k) corners.col(k) = of.vertices[t[k]];
  return corners;
}

Eigen::Vector3f Scene::ShadingNormal(const Hit& hit) const {
  const Instance& of = content_->instances[static_cast<size_t>(hit.instance)];
  const Eigen::Vector3i& t = of.mesh->mesh.triangles[static_cast<size_t>(hit.triangle)];
  const Eigen::Matrix3f c = Corners(hit.instance, hit.triangle);
  const Eigen::Vector3f face = (c.col(1) - c.col(0)).cross(c.col(2) - c.col(0)).stableNormalized();
  const float weights[3] = {1.0f - hit.u - hit.v, hit.u, hit.v};
  Eigen::Vector3f smooth = Eigen::Vector3f::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3f& normal = of.normals[t[k]];
    smooth += weights[k] * (normal.dot(face) > kSmoothCosine ? normal : face);
  }
  return smooth.stableNormalized();
}

Eigen::Vector4f Scene::Albedo(const Hit& hit) const {
  const core::TexturedMesh& mesh = *content_->instances[static_cast<size_t>(hit.instance)].mesh;
  if (mesh.triangle_material.empty()) return {0.75f, 0.75f, 0.75f, 1.0f};
  const size_t t = static_cast<size_t>(hit.triangle);
  const core::Material& material = mesh.materials[mesh.triangle_material[t]];
  if (material.texture < 0 || mesh.corner_uvs.empty()) return material.base_color;
  const Eigen::Vector2f uv = (1.0f - hit.u - hit.v) * mesh.corner_uvs[3 * t] +
                             hit.u * mesh.corner_uvs[3 * t + 1] +
                             hit.v * mesh.corner_uvs[3 * t + 2];
  return core::SampleTexture(mesh.textures[material.texture], uv).cwiseProduct(material.base_color);
}

Eigen::AlignedBox3f Scene::bounds() const {
  Eigen::AlignedBox3f box;
  for (const Instance& instance : content_->instances) {
    for (const Eigen::Vector3f& vertex : instance.vertices) box.extend(vertex);
  }
  return box;
}

}  // namespace simwright::render
