#include "render/mesh_tree.h"

#include <embree3/rtcore.h>

#include "core/error.h"
#include "render/embree_packet.h"

namespace simwright::render {
namespace {

// The device of all mesh trees. Trees hold references to it, so that the order of destruction does
// not matter.
class MeshTreeDevice {
 public:
  MeshTreeDevice() : device_(rtcNewDevice("threads=1")) {  // rays come from our own threads
    if (device_ == nullptr) throw core::Error("Embree cannot start");
    wide_ = HasWidePackets(device_);
  }
  ~MeshTreeDevice() { rtcReleaseDevice(device_); }
  RTCDevice get() const { return device_; }
  bool wide() const { return wide_; }  // true if this CPU traces 16 rays together, else 8

 private:
  RTCDevice device_;
  bool wide_ = false;
};

const MeshTreeDevice& TheDevice() {
  static const MeshTreeDevice device;
  return device;
}

void TraceShadow(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay16* rays) {
  rtcOccluded16(valid, scene, context, rays);
}
void TraceShadow(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay8* rays) {
  rtcOccluded8(valid, scene, context, rays);
}

template <typename Query, int Lanes>
void OccludeLanes(RTCScene scene, int first, PacketShadows* shadows) {
  Query query;
  for (int k = 0; k < Lanes; ++k) {
    query.org_x[k] = shadows->x[first + k];
    query.org_y[k] = shadows->y[first + k];
    query.org_z[k] = shadows->z[first + k];
    query.dir_x[k] = shadows->direction.x();
    query.dir_y[k] = shadows->direction.y();
    query.dir_z[k] = shadows->direction.z();
    query.tnear[k] = 0.0f;
    query.tfar[k] = 1e30f;
    query.time[k] = 0.0f;
    query.mask[k] = ~0u;
    query.id[k] = query.flags[k] = 0;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  TraceShadow(shadows->open + first, scene, &context, &query);
  for (int k = 0; k < Lanes; ++k) {
    if (query.tfar[k] < 0.0f) shadows->open[first + k] = 0;
  }
}

}  // namespace

struct MeshTree::Embree {
  RTCScene scene = rtcNewScene(TheDevice().get());
  bool wide = TheDevice().wide();
  ~Embree() { rtcReleaseScene(scene); }
};

MeshTree::MeshTree(const std::vector<Eigen::Vector3f>& vertices,
                   const std::vector<Eigen::Vector3i>& triangles)
    : embree_(std::make_unique<Embree>()) {
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(TheDevice().get(), RTC_GEOMETRY_TYPE_TRIANGLE);
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
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);  // the scene keeps a reference
  rtcCommitScene(embree_->scene);
}

MeshTree::~MeshTree() = default;

void MeshTree::Intersect(const PixelRays& rays, const PacketPixels& pixels, int part,
                         PacketHits* hits) const {
  PacketDirections directions;
  for (int k = 0; k < kPacket; ++k) {
    const float x = pixels.x[k], y = pixels.y[k];
    directions.x[k] = rays.at_zero.x() + x * rays.per_x.x() + y * rays.per_y.x();
    directions.y[k] = rays.at_zero.y() + x * rays.per_x.y() + y * rays.per_y.y();
    directions.z[k] = rays.at_zero.z() + x * rays.per_x.z() + y * rays.per_y.z();
    directions.valid[k] = pixels.valid[k];
  }
  IntersectPacket({embree_->scene, embree_->wide, rays.origin, 0.0f, part}, directions, hits);
}

void MeshTree::Occlude(PacketShadows* shadows) const {
  if (embree_->wide) {
    OccludeLanes<RTCRay16, 16>(embree_->scene, 0, shadows);
  } else {
    OccludeLanes<RTCRay8, 8>(embree_->scene, 0, shadows);
    OccludeLanes<RTCRay8, 8>(embree_->scene, 8, shadows);
  }
}

}  // namespace simwright::render
