#include "render/packet_shading.h"

#include <algorithm>
#include <cmath>

#include "render/reflection.h"

namespace simwright::render {
namespace {

using Eigen::Vector3f;

const Vector3f kPlainBackdrop(0.62f, 0.64f, 0.66f);  // sRGB
constexpr float kInfiniteDepth = 1e30f;

Vector3f RayAt(const PixelRays& rays, float x, float y) {
  return rays.at_zero + x * rays.per_x + y * rays.per_y;
}

Vector3f LinearColor(const Vector3f& srgb) {
  return {TabulatedLinear(srgb.x()), TabulatedLinear(srgb.y()), TabulatedLinear(srgb.z())};
}

// Returns the albedo of a look on a base colour (linear); `point`: m, in the pattern's frame.
Vector3f LookAlbedo(const SurfaceLook& look, const Vector3f& base, const Vector3f& point) {
  Vector3f albedo = base.cwiseProduct(look.tint);
  if (look.pattern != Pattern::kNone) {
    const float share = PatternShare(look, point);
    albedo += share * (LinearColor(look.pattern_color) - albedo);
  }
  return albedo;
}

// Returns the shading normal, unit, world, on the side from which `ray` (world) comes: the rule of
// RenderForward.
Vector3f PartNormal(const SeenPart& part, const ShadedTriangle& triangle, float u, float v,
                    const Vector3f& ray) {
  const Vector3f normal = part.world_from_part * triangle.normals.At(u, v);
  if (normal.dot(ray) <= 0.0f) return normal;
  return FacingNormal(normal, part.world_from_part * triangle.normals.face, ray);
}

Vector3f PartAlbedo(const RigidScene& scene, const SeenPart& part, int triangle, float u, float v,
                    const Vector3f& point) {
  const SurfaceLook& look = scene.part(part.index).look;
  const RigidMesh::Content& mesh = *part.mesh;
  const ShadedTriangle& shaded = mesh.triangles[static_cast<std::size_t>(triangle)];
  const bool plain = mesh.materials[static_cast<std::size_t>(shaded.material)].texture < 0;
  const Vector3f base =
      plain && look.color ? LinearColor(*look.color) : LinearAlbedo(mesh, triangle, u, v);
  return LookAlbedo(look, base, point);
}

// Writes the reflection of lane `k`, and turns its normal and albedo into those of its look.
void ApplyLook(const SeenPart& part, const PacketHits& hits, int k, Vector3f* normal,
               Vector3f* albedo, PacketSurface* surface) {
  const RigidMesh::Content& mesh = *part.mesh;
  const auto t = static_cast<std::size_t>(hits.triangle[k]);
  const float u = hits.u[k], v = hits.v[k];
  const Eigen::Vector2f* uvs = mesh.corner_uvs.empty() ? nullptr : &mesh.corner_uvs[3 * t];
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  if (uvs != nullptr) uv = (1.0f - u - v) * uvs[0] + u * uvs[1] + v * uvs[2];
  const SurfaceReflection look =
      SampleReflection(mesh.look, mesh.triangles[t].material, uvs == nullptr ? nullptr : &uv);
  if (look.has_normal && !mesh.corners.empty()) {
    *normal =
        PerturbedNormal(look.tangent_normal, *normal, part.world_from_part * mesh.corners[t], uvs);
  }
  const Vector3f f0 = NormalReflectance(*albedo, look.metallic);
  for (int c = 0; c < 3; ++c) surface->f0[c][k] = f0[c];
  *albedo *= 1.0f - look.metallic;
  surface->roughness[k] = look.roughness;
  surface->reflects = true;
}

// Adds the reflected light of hits whose mesh has a look.
void AddReflections(const SeenScene& seen, const PacketPixels& pixels, PacketSurface* surface) {
  const SpecularLight light(seen.scene->light.ambient);
  for (int k = 0; k < kPacket; ++k) {
    if (surface->roughness[k] < 0.0f) continue;
    const auto vector = [k](const float(&lanes)[3][kPacket]) {
      return Vector3f(lanes[0][k], lanes[1][k], lanes[2][k]);
    };
    const Vector3f reflected =
        light.Reflect({vector(surface->f0), surface->roughness[k]}, vector(surface->normal),
                      -RayAt(seen.rays, pixels.x[k], pixels.y[k]).normalized());
    for (int c = 0; c < 3; ++c) surface->albedo[c][k] += reflected[c];
  }
}

// Returns the normal of floor or wall `code`, facing a camera inside.
Vector3f BackdropNormal(int code) {
  switch (code) {
    case kFloorHit:
      return Vector3f::UnitZ();
    case kWallHit:
      return Vector3f::UnitX();
    case kWallHit - 1:
      return -Vector3f::UnitX();
    case kWallHit - 2:
      return Vector3f::UnitY();
    default:
      return -Vector3f::UnitY();
  }
}

void IntersectFloor(const Backdrop& backdrop, const PixelRays& rays, const PacketPixels& pixels,
                    PacketHits* hits) {
  const float above = backdrop.floor_height - rays.origin.z();
  const float reach = backdrop.floor_radius * backdrop.floor_radius;
  for (int k = 0; k < kPacket; ++k) {
    const float dz = rays.at_zero.z() + pixels.x[k] * rays.per_x.z() + pixels.y[k] * rays.per_y.z();
    const float t = dz < 0.0f ? above / dz : -1.0f;
    const float x = rays.origin.x() + t * (rays.at_zero.x() + pixels.x[k] * rays.per_x.x() +
                                           pixels.y[k] * rays.per_y.x());
    const float y = rays.origin.y() + t * (rays.at_zero.y() + pixels.x[k] * rays.per_x.y() +
                                           pixels.y[k] * rays.per_y.y());
    const bool hit = t > 0.0f && x * x + y * y < reach;
    hits->depth[k] = hit ? t : hits->depth[k];
    hits->part[k] = hit ? kFloorHit : hits->part[k];
  }
}

// From inside, a ray leaves the range of the walls through one of them.
void IntersectWalls(const Backdrop& backdrop, const PixelRays& rays, const PacketPixels& pixels,
                    PacketHits* hits) {
  const Eigen::AlignedBox2f& range = backdrop.wall_range;
  if (!range.contains(rays.origin.head<2>().eval())) return;
  const float low = backdrop.floor_height, high = low + backdrop.wall_height;
  for (int k = 0; k < kPacket; ++k) {
    const Vector3f ray = RayAt(rays, pixels.x[k], pixels.y[k]);
    float nearest = hits->depth[k];
    for (int axis = 0; axis < 2; ++axis) {
      if (ray[axis] == 0.0f) continue;
      const bool upper = ray[axis] > 0.0f;
      const float end = upper ? range.max()[axis] : range.min()[axis];
      const float t = (end - rays.origin[axis]) / ray[axis];
      const float other = rays.origin[1 - axis] + t * ray[1 - axis];
      const float z = rays.origin.z() + t * ray.z();
      if (!(t > 0.0f && t < nearest) || z < low || z > high) continue;
      if (other < range.min()[1 - axis] || other > range.max()[1 - axis]) continue;
      nearest = t;
      hits->part[k] = kWallHit - 2 * axis - (upper ? 1 : 0);
    }
    hits->depth[k] = nearest;
  }
}

// Clears `open` of the points that a part hides from the light.
void TraceShadows(const SeenScene& seen, const PacketShadows& world, int* open) {
  const RigidScene& scene = *seen.scene;
  for (int p = 0; p < scene.size(); ++p) {
    const RigidScene::Part& part = scene.part(p);
    const Eigen::Isometry3f pose = part.world_from_part.cast<float>();
    const Eigen::AlignedBox3f& bounds = part.mesh->bounds();
    const Vector3f center = pose * bounds.center();
    const float radius = 0.5f * bounds.diagonal().norm();
    PacketShadows local;
    bool any = false;
    for (int k = 0; k < kPacket; ++k) {
      const Vector3f from = Vector3f(world.x[k], world.y[k], world.z[k]);
      const Vector3f to = center - from;
      const float along = to.dot(world.direction);
      const bool meets = along > -radius && to.squaredNorm() - along * along < radius * radius;
      local.open[k] = open[k] != 0 && meets ? -1 : 0;
      any = any || local.open[k] != 0;
      const Vector3f point = pose.linear().transpose() * (from - pose.translation());
      local.x[k] = point.x();
      local.y[k] = point.y();
      local.z[k] = point.z();
    }
    if (!any) continue;
    local.direction = pose.linear().transpose() * world.direction;
    int asked[kPacket];
    std::copy(local.open, local.open + kPacket, asked);
    part.mesh->content().tree.Occlude(&local);
    for (int k = 0; k < kPacket; ++k) {
      if (asked[k] != 0 && local.open[k] == 0) open[k] = 0;
    }
  }
}

// Multiplies the colours of hits that face the light, but do not see it.
void DarkenShadows(const SeenScene& seen, const PacketPixels& pixels, const PacketHits& hits,
                   PacketSurface* surface) {
  constexpr float kOff = 1e-3f;  // m: the start of a shadow ray above the surface
  const SceneLight& light = seen.scene->light;
  PacketShadows world;
  world.direction = light.shadow_direction;
  float facing[kPacket];
  int asked = 0;
  for (int k = 0; k < kPacket; ++k) {
    const Vector3f normal(surface->normal[0][k], surface->normal[1][k], surface->normal[2][k]);
    facing[k] = std::min(1.0f, 3.0f * normal.dot(light.shadow_direction));
    world.open[k] = pixels.valid[k] != 0 && hits.part[k] != kNoHit && facing[k] > 0.0f ? -1 : 0;
    asked -= world.open[k];
    const Vector3f point = seen.rays.origin +
                           hits.depth[k] * RayAt(seen.rays, pixels.x[k], pixels.y[k]) +
                           kOff * normal;
    world.x[k] = point.x();
    world.y[k] = point.y();
    world.z[k] = point.z();
  }
  if (asked == 0) return;
  int open[kPacket];
  std::copy(world.open, world.open + kPacket, open);
  TraceShadows(seen, world, open);
  for (int k = 0; k < kPacket; ++k) {
    if (world.open[k] == 0 || open[k] != 0) continue;
    for (auto& channel : surface->albedo) channel[k] *= 1.0f - light.shadow * facing[k];
  }
}

}  // namespace

void SeenScene::See(const RigidScene& seen, const core::Camera& camera) {
  scene = &seen;
  const Eigen::Matrix3d& turn = camera.world_from_camera.linear();
  const Eigen::Vector3d at_zero =
      turn * Eigen::Vector3d(-camera.cx / camera.fx, -camera.cy / camera.fy, 1.0);
  rays = {camera.position().cast<float>(), at_zero.cast<float>(),
          (turn.col(0) / camera.fx).cast<float>(), (turn.col(1) / camera.fy).cast<float>()};
  parts.clear();
  for (int p = 0; p < seen.size(); ++p) {
    const RigidScene::Part& part = seen.part(p);
    const Eigen::Isometry3d camera_from_part =
        camera.world_from_camera.inverse(Eigen::Isometry) * part.world_from_part;
    const Eigen::AlignedBox3d box = part.mesh->bounds().cast<double>();
    Eigen::AlignedBox2d area;
    double nearest = 1e30, farthest = -1e30;
    for (int k = 0; k < 8; ++k) {
      const Eigen::Vector3d corner =
          camera_from_part * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k));
      nearest = std::min(nearest, corner.z());
      farthest = std::max(farthest, corner.z());
      area.extend(Eigen::Vector2d(camera.fx * corner.x() / corner.z() + camera.cx,
                                  camera.fy * corner.y() / corner.z() + camera.cy));
    }
    if (farthest <= 0.0) continue;
    SeenPart one;
    one.x1 = camera.width, one.y1 = camera.height;
    if (nearest > 1e-4) {
      const auto pixel = [](double at, int end) {
        return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(end)));
      };
      one.x0 = pixel(area.min().x() - 1.0, camera.width);
      one.y0 = pixel(area.min().y() - 1.0, camera.height);
      one.x1 = pixel(area.max().x() + 2.0, camera.width);
      one.y1 = pixel(area.max().y() + 2.0, camera.height);
    }
    if (one.x0 >= one.x1 || one.y0 >= one.y1) continue;
    one.index = p;
    one.mesh = &part.mesh->content();
    one.nearest = static_cast<float>(std::max(0.0, nearest) * (1.0 - 1e-5));
    const Eigen::Matrix3d inverse = part.world_from_part.linear().transpose();
    one.world_from_part = part.world_from_part.linear().cast<float>();
    one.rays = {(inverse * (camera.position() - part.world_from_part.translation())).cast<float>(),
                (inverse * at_zero).cast<float>(),
                (inverse * turn.col(0) / camera.fx).cast<float>(),
                (inverse * turn.col(1) / camera.fy).cast<float>()};
    parts.push_back(one);
  }
  std::sort(parts.begin(), parts.end(), [](const SeenPart& a, const SeenPart& b) {
    return a.nearest != b.nearest ? a.nearest < b.nearest : a.index < b.index;
  });
}

void IntersectBackdrop(const SeenScene& seen, const PacketPixels& pixels, PacketHits* hits) {
  for (int k = 0; k < kPacket; ++k) {
    hits->depth[k] = kInfiniteDepth;
    hits->u[k] = hits->v[k] = 0.0f;
    hits->part[k] = kNoHit;
    hits->triangle[k] = -1;
  }
  if (!seen.scene->backdrop) return;
  const Backdrop& backdrop = *seen.scene->backdrop;
  if (backdrop.floor) IntersectFloor(backdrop, seen.rays, pixels, hits);
  if (backdrop.walls) IntersectWalls(backdrop, seen.rays, pixels, hits);
}

void EvaluateSurface(const SeenScene& seen, const PacketPixels& pixels, const PacketHits& hits,
                     bool colored, PacketSurface* surface) {
  const RigidScene& scene = *seen.scene;
  const Vector3f background =
      LinearColor(scene.backdrop ? scene.backdrop->background : Vector3f::Ones());
  surface->reflects = false;
  for (int k = 0; k < kPacket; ++k) {
    surface->roughness[k] = -1.0f;
    const int code = hits.part[k];
    Vector3f normal = Vector3f::Zero(), albedo = background;
    const float x = pixels.x[k], y = pixels.y[k], depth = hits.depth[k];
    if (code >= 0) {
      const SeenPart& part = seen.parts[static_cast<std::size_t>(code)];
      const int t = hits.triangle[k];
      const ShadedTriangle& triangle = part.mesh->triangles[static_cast<std::size_t>(t)];
      normal = PartNormal(part, triangle, hits.u[k], hits.v[k], RayAt(seen.rays, x, y));
      if (colored) {
        const Vector3f point = part.rays.origin + depth * RayAt(part.rays, x, y);
        albedo = PartAlbedo(scene, part, t, hits.u[k], hits.v[k], point);
        if (!part.mesh->look.empty()) ApplyLook(part, hits, k, &normal, &albedo, surface);
      }
    } else if (code != kNoHit) {
      normal = BackdropNormal(code);
      if (colored) {
        const SurfaceLook& look =
            code == kFloorHit ? scene.backdrop->floor_look : scene.backdrop->wall_look;
        albedo = LookAlbedo(look, LinearColor(look.color.value_or(kPlainBackdrop)),
                            seen.rays.origin + depth * RayAt(seen.rays, x, y));
      }
    }
    for (int c = 0; c < 3; ++c) {
      surface->normal[c][k] = normal[c];
      surface->albedo[c][k] = albedo[c];
    }
  }
}

void Illuminate(const SeenScene& seen, const PacketPixels& pixels, const PacketHits& hits,
                PacketSurface* surface) {
  const SceneLight& light = seen.scene->light;
  const Eigen::Matrix<float, 9, 3>& radiance = light.ambient.radiance;
  // IrradianceWeights is a polynomial of degree 2 in the normal; evaluated for all lanes together.
  alignas(64) float weights[9][kPacket];
  const Eigen::Matrix<float, 9, 1> at_x = IrradianceWeights(Vector3f::UnitX());
  const Eigen::Matrix<float, 9, 1> at_z = IrradianceWeights(Vector3f::UnitZ());
  const float k0 = at_x[0], k1 = at_x[3], k20 = 0.5f * at_z[6], k22 = at_x[8];
  const float k2 = 2.0f * k22;  // of xy, yz and xz
  for (int k = 0; k < kPacket; ++k) {
    const float x = surface->normal[0][k], y = surface->normal[1][k], z = surface->normal[2][k];
    weights[0][k] = k0;
    weights[1][k] = k1 * y;
    weights[2][k] = k1 * z;
    weights[3][k] = k1 * x;
    weights[4][k] = k2 * x * y;
    weights[5][k] = k2 * y * z;
    weights[6][k] = k20 * (3.0f * z * z - 1.0f);
    weights[7][k] = k2 * x * z;
    weights[8][k] = k22 * (x * x - y * y);
  }
  for (int c = 0; c < 3; ++c) {
    alignas(64) float sum[kPacket] = {};
    for (int i = 0; i < 9; ++i) {
      const float level = radiance(i, c);
      for (int k = 0; k < kPacket; ++k) sum[k] += level * weights[i][k];
    }
    for (int k = 0; k < kPacket; ++k) {
      const float lit = std::max(0.0f, sum[k]);
      surface->albedo[c][k] *= hits.part[k] == kNoHit ? 1.0f : lit;
    }
  }
  if (surface->reflects) AddReflections(seen, pixels, surface);
  if (light.shadow > 0.0f) DarkenShadows(seen, pixels, hits, surface);
}

}  // namespace simwright::render
