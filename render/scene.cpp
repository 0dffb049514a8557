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
  std::vector<TriangleNormals> normals;   // of the triangles, world
  const core::PbrLook* look = nullptr;
};

}  // namespace

struct Scene::Content {
  RayTree tree;
  std::vector<Instance> instances;

  static void Place(Instance* instance, const std::vector<Eigen::Vector3d>& vertices) {
    instance->vertices.resize(vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i) {
      instance->vertices[i] = (instance->world_from_mesh * vertices[i]).cast<float>();
    }
    instance->normals = NormalsOfTriangles(instance->vertices, instance->mesh->mesh.triangles);
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

void Scene::IntersectPacket(const Eigen::Vector3f& origin, const PacketDirections& directions,
                            PacketHits* hits) const {
  content_->tree.IntersectPacket(origin, directions, 0.0f, 1e30f, hits);
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

const TriangleNormals& Scene::Normals(int instance, int triangle) const {
  return content_->instances[static_cast<size_t>(instance)].normals[static_cast<size_t>(triangle)];
}

Eigen::Vector3f Scene::ShadingNormal(const Hit& hit) const {
  return Normals(hit.instance, hit.triangle).At(hit.u, hit.v);
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
