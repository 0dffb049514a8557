#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "render/light.h"
#include "render/rigid_mesh.h"
#include "render/surface_look.h"

namespace simwright::render {

// The surroundings of a scene: a horizontal floor, and walls or a plain background.
struct Backdrop {
  bool floor = true;
  float floor_height = 0.0f;   // m; slightly below what stands on it, or both flicker
  float floor_radius = 20.0f;  // m around the world's z axis
  SurfaceLook floor_look;      // grey unless it has a colour
  // The inner sides of four vertical walls, from the floor up to `wall_height`: x and y ranges, m.
  bool walls = false;
  Eigen::AlignedBox2f wall_range{Eigen::Vector2f(-3.0f, -3.0f), Eigen::Vector2f(3.0f, 3.0f)};
  float wall_height = 3.0f;  // m
  SurfaceLook wall_look;
  std::int32_t label = 0;  // of floor and walls
  // The colour where nothing is hit, sRGB.
  Eigen::Vector3f background = Eigen::Vector3f(0.80f, 0.84f, 0.88f);
};

// The light of a scene. Shadows are off by default.
struct SceneLight {
  SphericalHarmonicsLight ambient = SphericalHarmonicsLight::Studio({0.4f, -0.5f, 0.75f});
  // The share of light that a surface loses where `shadow_direction` (unit, towards the light) is
  // occluded: hard shadows. 0: no shadow rays.
  float shadow = 0.0f;
  Eigen::Vector3f shadow_direction = Eigen::Vector3f(0.4f, -0.5f, 0.75f).normalized();
};

// Rigid parts with poses: one moving world. A pose costs a few dozen operations: no tree is rebuilt
// or refitted, because rays are transformed into the frames of the parts. Mutable, one thread at a
// time; rendering is const and thread-safe.
class RigidScene {
 public:
  struct Part {
    std::shared_ptr<const RigidMesh> mesh;
    std::int32_t label = 0;
    Eigen::Isometry3d world_from_part = Eigen::Isometry3d::Identity();
    SurfaceLook look;
  };

  // Adds a part; returns its index. `label`: what the segmentation has, >= 0.
  int Add(std::shared_ptr<const RigidMesh> mesh, std::int32_t label,
          const Eigen::Isometry3d& world_from_part = Eigen::Isometry3d::Identity());
  void SetPose(int part, const Eigen::Isometry3d& world_from_part);
  void SetLook(int part, const SurfaceLook& look);

  int size() const { return static_cast<int>(parts_.size()); }
  const Part& part(int index) const { return parts_[static_cast<std::size_t>(index)]; }

  std::optional<Backdrop> backdrop;  // none: nothing is hit beside the parts
  SceneLight light;

 private:
  std::vector<Part> parts_;
};

}  // namespace simwright::render
