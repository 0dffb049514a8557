#include "render/embree_packet.h"

#include <embree3/rtcore.h>

#include <algorithm>

namespace simwright::render {
namespace {

void TraceLanes(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHit16* rays) {
  rtcIntersect16(valid, scene, context, rays);
}
void TraceLanes(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHit8* rays) {
  rtcIntersect8(valid, scene, context, rays);
}

// Traces lanes [first, first + Lanes).
template <typename Rays, int Lanes>
void IntersectLanes(const PacketQuery& query, const PacketDirections& directions, int first,
                    PacketHits* hits) {
  Rays rays;
  std::fill_n(rays.ray.org_x, Lanes, query.origin.x());
  std::fill_n(rays.ray.org_y, Lanes, query.origin.y());
  std::fill_n(rays.ray.org_z, Lanes, query.origin.z());
  std::fill_n(rays.ray.tnear, Lanes, query.near);
  std::copy_n(directions.x + first, Lanes, rays.ray.dir_x);
  std::copy_n(directions.y + first, Lanes, rays.ray.dir_y);
  std::copy_n(directions.z + first, Lanes, rays.ray.dir_z);
  std::copy_n(hits->depth + first, Lanes, rays.ray.tfar);
  std::fill_n(rays.ray.time, Lanes, 0.0f);
  std::fill_n(rays.ray.mask, Lanes, ~0u);
  std::fill_n(rays.ray.id, Lanes, 0u);
  std::fill_n(rays.ray.flags, Lanes, 0u);
  std::fill_n(rays.hit.geomID, Lanes, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(rays.hit.instID[0], Lanes, RTC_INVALID_GEOMETRY_ID);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  TraceLanes(directions.valid + first, query.scene, &context, &rays);
  for (int k = 0; k < Lanes; ++k) {
    const bool hit = rays.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
    const int part =
        query.part == kGeometryIsPart ? static_cast<int>(rays.hit.geomID[k]) : query.part;
    hits->depth[first + k] = hit ? rays.ray.tfar[k] : hits->depth[first + k];
    hits->u[first + k] = hit ? rays.hit.u[k] : hits->u[first + k];
    hits->v[first + k] = hit ? rays.hit.v[k] : hits->v[first + k];
    hits->part[first + k] = hit ? part : hits->part[first + k];
    hits->triangle[first + k] =
        hit ? static_cast<int>(rays.hit.primID[k]) : hits->triangle[first + k];
  }
}

}  // namespace

bool HasWidePackets(RTCDeviceTy* device) {
  return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
}

void IntersectPacket(const PacketQuery& query, const PacketDirections& directions,
                     PacketHits* hits) {
  if (query.wide) {
    IntersectLanes<RTCRayHit16, 16>(query, directions, 0, hits);
  } else {
    IntersectLanes<RTCRayHit8, 8>(query, directions, 0, hits);
    IntersectLanes<RTCRayHit8, 8>(query, directions, 8, hits);
  }
}

}  // namespace simwright::render
