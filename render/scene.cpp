#include "render/scene.h"

#include <embree3/rtcore.h>

#include <cmath>

#include "core/error.h"

namespace simwright::render {
namespace {

struct Instance {
  const core::TexturedMesh* mesh;
  Eigen::Isometry3d world_from_mesh;
  RTCGeometry geometry;
  std::vector<Eigen::Vector3f> vertices;  // (N x 3), world
  std::vector<Eigen::Vector3f> normals;   // (N x 3), world
};

constexpr float kSmoothCosine = 0.766f;  // 40 degrees

}  // namespace

struct Scene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Instance> instances;
  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void Upload(Instance* instance, const std::vector<Eigen::Vector3d>& vertices) {
    instance->vertices.resize(vertices.size());
    auto* buffer = static_cast<float*>(
        rtcGetGeometryBufferData(instance->geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    for (size_t i = 0; i < vertices.size(); ++i) {
      instance->vertices[i] = (instance->world_from_mesh * vertices[i]).cast<float>();
      Eigen::Map<Eigen::Vector3f>(buffer + 3 * i) = instance->vertices[i];
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

Scene::Scene() : embree_(std::make_unique<Embree>()) {
  embree_->device = rtcNewDevice("threads=1");  // rays are traced from our own threads
  if (embree_->device == nullptr) throw core::Error("Embree cannot start");
  embree_->scene = rtcNewScene(embree_->device);
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
}

Scene::~Scene() = default;

int Scene::Add(const core::TexturedMesh* mesh, const Eigen::Isometry3d& world_from_mesh) {
  core::RequireValid(*mesh, "scene");
  if (mesh->mesh.triangles.empty()) throw core::Error("a mesh without faces cannot be drawn");
  Instance instance{mesh, world_from_mesh, nullptr, {}, {}};
  instance.geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetNewGeometryBuffer(instance.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                          3 * sizeof(float), mesh->mesh.vertices.size());
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(instance.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), mesh->mesh.triangles.size()));
  for (size_t i = 0; i < mesh->mesh.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      indices[3 * i + k] = static_cast<unsigned>(mesh->mesh.triangles[i][k]);
    }
  }
  embree_->Upload(&instance, mesh->mesh.vertices);
  rtcCommitGeometry(instance.geometry);
  const int index = static_cast<int>(embree_->instances.size());
  rtcAttachGeometryByID(embree_->scene, instance.geometry, static_cast<unsigned>(index));
  rtcReleaseGeometry(instance.geometry);  // the scene holds it on
  embree_->instances.push_back(std::move(instance));
  return index;
}

void Scene::MoveVertices(int instance, const std::vector<Eigen::Vector3d>& vertices) {
  Instance& moved = embree_->instances.at(static_cast<size_t>(instance));
  if (vertices.size() != moved.vertices.size()) {
    throw core::Error("the number of vertices may not change");
  }
  rtcSetGeometryBuildQuality(moved.geometry, RTC_BUILD_QUALITY_REFIT);
  embree_->Upload(&moved, vertices);
  rtcUpdateGeometryBuffer(moved.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(moved.geometry);
}

void Scene::Commit() {
  rtcCommitScene(embree_->scene);
}

Hit Scene::Intersect(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                     float far) const {
  RTCRayHit query;
  query.ray = {
      origin.x(), origin.y(), origin.z(), near, direction.x(), direction.y(), direction.z(), 0.0f,
      far,        ~0u,        0,          0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(embree_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {query.ray.tfar, static_cast<int>(query.hit.geomID), static_cast<int>(query.hit.primID),
          query.hit.u, query.hit.v};
}

bool Scene::Occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                     float far) const {
  RTCRay ray{
      origin.x(), origin.y(), origin.z(), near, direction.x(), direction.y(), direction.z(), 0.0f,
      far,        ~0u,        0,          0};
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0.0f;
}

int Scene::size() const {
  return static_cast<int>(embree_->instances.size());
}

const core::TexturedMesh& Scene::mesh(int instance) const {
  return *embree_->instances.at(static_cast<size_t>(instance)).mesh;
}

Eigen::Matrix3f Scene::Corners(int instance, int triangle) const {
  const Instance& of = embree_->instances[static_cast<size_t>(instance)];
  const Eigen::Vector3i& t = of.mesh->mesh.triangles[static_cast<size_t>(triangle)];
  Eigen::Matrix3f corners;
  for (int k = 0; k < 3; ++k) corners.col(k) = of.vertices[t[k]];
  return corners;
}

Eigen::Vector3f Scene::ShadingNormal(const Hit& hit) const {
  const Instance& of = embree_->instances[static_cast<size_t>(hit.instance)];
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
  const core::TexturedMesh& mesh = *embree_->instances[static_cast<size_t>(hit.instance)].mesh;
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
  for (const Instance& instance : embree_->instances) {
    for (const Eigen::Vector3f& vertex : instance.vertices) box.extend(vertex);
  }
  return box;
}

}  // namespace simwright::render
