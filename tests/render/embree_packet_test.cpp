// Packets of eight rays, on processors without AVX-512, hit what packets of 16 do.
#include "render/embree_packet.h"

#include <embree3/rtcore.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace simwright::render {
namespace {

TEST(EmbreePacket, EightLanesHitWhatSixteenHit) {
  RTCDevice device = rtcNewDevice("threads=1");
  ASSERT_NE(device, nullptr);
  RTCScene scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Stairs below the z axis: triangle i has its corner at x = i.
  constexpr int kSteps = 10;
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * kSteps));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), kSteps));
  for (int i = 0; i < kSteps; ++i) {
    const auto x = static_cast<float>(i), z = -1.0f - 0.1f * x;
    const float corners[9] = {x, -5.0f, z, x + 1.0f, -5.0f, z, x + 0.5f, 5.0f, z};
    std::copy_n(corners, 9, points + 9 * i);
    for (int k = 0; k < 3; ++k) indices[3 * i + k] = static_cast<unsigned>(3 * i + k);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);

  PacketDirections rays;
  for (int k = 0; k < kPacket; ++k) {
    rays.x[k] = 0.7f * static_cast<float>(k) + 0.21f;  // the last ones miss
    rays.y[k] = -2.0f;
    rays.z[k] = -1.0f;
    rays.valid[k] = k == 3 || k == 12 ? 0 : -1;
  }
  PacketHits hits[2];
  for (const bool wide : {false, true}) {
    PacketHits& found = hits[wide];
    std::fill_n(found.depth, kPacket, 100.0f);
    std::fill_n(found.part, kPacket, -1);
    std::fill_n(found.triangle, kPacket, -1);
    std::fill_n(found.u, kPacket, 0.0f);
    std::fill_n(found.v, kPacket, 0.0f);
    IntersectPacket({scene, wide, Eigen::Vector3f::Zero(), 0.0f, 7}, rays, &found);
  }
  int met = 0;
  for (int k = 0; k < kPacket; ++k) {
    EXPECT_EQ(hits[0].part[k], hits[1].part[k]) << k;
    EXPECT_EQ(hits[0].triangle[k], hits[1].triangle[k]) << k;
    EXPECT_NEAR(hits[0].depth[k], hits[1].depth[k], 1e-5f) << k;
    EXPECT_NEAR(hits[0].u[k], hits[1].u[k], 1e-5f) << k;
    EXPECT_NEAR(hits[0].v[k], hits[1].v[k], 1e-5f) << k;
    if (rays.valid[k] == 0) {
      EXPECT_EQ(hits[0].part[k], -1) << k;
    }
    if (hits[0].part[k] < 0) continue;
    ++met;
    EXPECT_EQ(hits[0].part[k], 7);
    EXPECT_NEAR(hits[0].depth[k], 1.0f + 0.1f * static_cast<float>(hits[0].triangle[k]), 1e-5f);
  }
  EXPECT_GE(met, 5);
  EXPECT_LT(met, 14);
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

}  // namespace
}  // namespace simwright::render
