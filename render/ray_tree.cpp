#include "render/ray_tree.h"

#include <embree3/rtcore.h>

#include <algorithm>

#include "core/error.h"
#include "render/embree_packet.h"

namespace simwright::render {
namespace {

RTCRayHit Query(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                float far) {
  RTCRayHit query;
  query.ray = {
      origin.x(), origin.y(), origin.z(), near, direction.x(), direction.y(), direction.z(), 0.0f,
      far,        ~0u,        0,          0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

Hit Answer(const RTCRayHit& query) {
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {query.ray.tfar, static_cast<int>(query.hit.geomID), static_cast<int>(query.hit.primID),
          query.hit.u, query.hit.v};
}

// Embree passes the context to the filter; its first member must be Embree's own.
struct IgnoringContext {
  RTCIntersectContext context;
  const IgnoredFaces* ignored;
};

void IgnoreFaces(const RTCFilterFunctionNArguments* arguments) {
  const IgnoredFaces& ignored =
      *reinterpret_cast<const IgnoringContext*>(arguments->context)->ignored;
  const auto* hit = reinterpret_cast<const RTCHit*>(arguments->hit);
  if (static_cast<int>(hit->geomID) != ignored.instance) return;
  for (int i = 0; i < ignored.count; ++i) {
    if (static_cast<int>(hit->primID) == ignored.triangles[i]) arguments->valid[0] = 0;
  }
}

}  // namespace

struct RayTree::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<RTCGeometry> geometries;
  bool dynamic = false, wide = false;

  // Embree keeps a refittable tree per geometry only in a dynamic scene of low build quality;
  // otherwise Embree 3.13 rebuilds. The geometry's own tree still has full quality, so rays are as
  // fast.
  void MakeDynamic() {
    if (dynamic) return;
    dynamic = true;
    SetFlags(RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
    for (RTCGeometry geometry : geometries) {
      rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
      rtcCommitGeometry(geometry);
    }
  }
  void SetFlags(RTCSceneFlags more) {
    rtcSetSceneFlags(scene,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION | more));
  }

  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

RayTree::RayTree() : embree_(std::make_unique<Embree>()) {
  embree_->device = rtcNewDevice("threads=1");  // rays are traced from our own threads
  if (embree_->device == nullptr) throw core::Error("Embree cannot start");
  embree_->wide = HasWidePackets(embree_->device);
  embree_->scene = rtcNewScene(embree_->device);
  embree_->SetFlags(RTC_SCENE_FLAG_NONE);
}

RayTree::~RayTree() = default;

int RayTree::Add(const std::vector<Eigen::Vector3f>& vertices,
                 const std::vector<Eigen::Vector3i>& triangles, bool moves) {
  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), triangles.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Eigen::Map<Eigen::Vector3f>(points + 3 * i) = vertices[i];
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) indices[3 * i + k] = static_cast<unsigned>(triangles[i][k]);
  }
  if (moves) embree_->MakeDynamic();
  if (embree_->dynamic) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
  rtcCommitGeometry(geometry);
  const int index = static_cast<int>(embree_->geometries.size());
  rtcAttachGeometryByID(embree_->scene, geometry, static_cast<unsigned>(index));
  rtcReleaseGeometry(geometry);  // the scene keeps a reference
  embree_->geometries.push_back(geometry);
  return index;
}

void RayTree::Move(int geometry, const std::vector<Eigen::Vector3f>& vertices) {
  embree_->MakeDynamic();
  RTCGeometry moved = embree_->geometries[static_cast<std::size_t>(geometry)];
  auto* points = static_cast<float*>(rtcGetGeometryBufferData(moved, RTC_BUFFER_TYPE_VERTEX, 0));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Eigen::Map<Eigen::Vector3f>(points + 3 * i) = vertices[i];
  }
  rtcUpdateGeometryBuffer(moved, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(moved);
}

void RayTree::Commit() {
  rtcCommitScene(embree_->scene);
}

Hit RayTree::Intersect(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                       float far) const {
  RTCRayHit query = Query(origin, direction, near, far);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(embree_->scene, &context, &query);
  return Answer(query);
}

void RayTree::IntersectPacket(const Eigen::Vector3f& origin, const PacketDirections& directions,
                              float near, float far, PacketHits* hits) const {
  std::fill_n(hits->depth, kPacket, far);
  std::fill_n(hits->part, kPacket, -1);
  std::fill_n(hits->triangle, kPacket, -1);
  std::fill_n(hits->u, kPacket, 0.0f);
  std::fill_n(hits->v, kPacket, 0.0f);
  render::IntersectPacket({embree_->scene, embree_->wide, origin, near}, directions, hits);
}

Hit RayTree::IntersectIgnoring(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                               float near, float far, const IgnoredFaces& ignored) const {
  RTCRayHit query = Query(origin, direction, near, far);
  IgnoringContext context;
  rtcInitIntersectContext(&context.context);
  context.context.filter = IgnoreFaces;
  context.ignored = &ignored;
  rtcIntersect1(embree_->scene, &context.context, &query);
  return Answer(query);
}

bool RayTree::Occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                       float far) const {
  RTCRay ray = Query(origin, direction, near, far).ray;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0.0f;
}

}  // namespace simwright::render
