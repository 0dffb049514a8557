#pragma once

#include <Eigen/Core>

#include "core/mesh.h"
#include "core/pbr_look.h"
#include "render/light.h"

namespace simwright::render {

// Specular reflection at a point, in glTF's metallic-roughness model.
struct Reflection {
  Eigen::Vector3f f0 = Eigen::Vector3f::Constant(0.04f);  // at normal incidence, linear RGB
  float roughness = 1.0f;                                 // [0, 1]
};

// The specular light of a spherical-harmonics light. Its strongest distant light, of which bands 1
// have the direction and the irradiance, is taken out and reflected by a GGX lobe; the rest is
// reflected as the mean over the lobe, by damping the bands (Ramamoorthi and Hanrahan, "A
// signal-processing framework for inverse rendering", 2001: exp(-(alpha l)^2) in band l) and by
// the lobe's albedo (Karis, "Real shading in Unreal Engine 4", 2013).
class SpecularLight {
 public:
  explicit SpecularLight(const SphericalHarmonicsLight& light);

  // Returns the reflected radiance, linear RGB, at a surface with unit `normal` seen from the unit
  // direction `to_camera`. `openness` in [0, 1] dims the surroundings, `key_share` the distant
  // light.
  Eigen::Vector3f Reflect(const Reflection& reflection, const Eigen::Vector3f& normal,
                          const Eigen::Vector3f& to_camera, float openness = 1.0f,
                          float key_share = 1.0f) const;

  // The unit direction towards the distant light.
  const Eigen::Vector3f& key_direction() const { return key_direction_; }

 private:
  Eigen::Vector3f key_direction_ = Eigen::Vector3f::UnitZ();
  Eigen::Vector3f key_irradiance_ = Eigen::Vector3f::Zero();
  SphericalHarmonicsLight rest_;
};

// The material of a surface point, from its look.
struct SurfaceReflection {
  float metallic = 0.0f, roughness = 1.0f;
  Eigen::Vector3f tangent_normal{0, 0, 1};  // of the normal map, unit, tangent space
  bool has_normal = false;
};

// Throws core::Error unless every map of the look is one of its images, and not empty.
void RequireMaps(const core::PbrLook& look);

// Samples a look's material at texture coordinates; `uv` is null without coordinates.
SurfaceReflection SampleReflection(const core::PbrLook& look, int material,
                                   const Eigen::Vector2f* uv);

// Returns the unit normal that a normal map gives a point: `corners` (one per column) and `uvs` of
// its triangle give the directions in which u and v grow; `normal` is the shading normal.
Eigen::Vector3f PerturbedNormal(const Eigen::Vector3f& tangent_normal,
                                const Eigen::Vector3f& normal, const Eigen::Matrix3f& corners,
                                const Eigen::Vector2f* uvs);

// Returns F0 of a material: 0.04 of dielectrics, the base colour (linear) of metals.
Eigen::Vector3f NormalReflectance(const Eigen::Vector3f& albedo, float metallic);

}  // namespace simwright::render
