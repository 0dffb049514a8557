#include "render/reflection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace simwright::render {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kFirstBand = 0.488603f;   // of the real basis (light.cpp)
constexpr float kLeastRoughness = 0.05f;  // keeps the lobe wider than a pixel
constexpr float kDielectric = 0.04f;      // reflectance at an index of refraction of 1.5
// The damping of the cosine lobe in IrradianceWeights, divided out to get the basis itself.
constexpr float kCosine1 = 2.0f / 3.0f, kCosine2 = 0.25f;

Eigen::Matrix<float, 9, 1> BasisAt(const Eigen::Vector3f& direction) {
  Eigen::Matrix<float, 9, 1> basis = IrradianceWeights(direction);
  basis.segment<3>(1) /= kCosine1;
  basis.segment<5>(4) /= kCosine2;
  return basis;
}

float PowerOf5(float x) {
  const float square = x * x;
  return square * square * x;
}

// Returns a pair of numbers spread evenly over the unit square (Hammersley).
Eigen::Vector2f SpreadPoint(unsigned i, unsigned count) {
  unsigned bits = i;
  bits = (bits << 16) | (bits >> 16);
  bits = ((bits & 0x00ff00ffu) << 8) | ((bits & 0xff00ff00u) >> 8);
  bits = ((bits & 0x0f0f0f0fu) << 4) | ((bits & 0xf0f0f0f0u) >> 4);
  bits = ((bits & 0x33333333u) << 2) | ((bits & 0xccccccccu) >> 2);
  bits = ((bits & 0x55555555u) << 1) | ((bits & 0xaaaaaaaau) >> 1);
  return {(static_cast<float>(i) + 0.5f) / static_cast<float>(count),
          static_cast<float>(bits) * 0x1.0p-32f};
}

// Returns Smith's visibility, height-correlated, divided by 4 cos cos (Heitz 2014).
float Visibility(float to_light, float to_camera, float alpha_squared) {
  const auto root = [&](float cosine) {
    return std::sqrt(cosine * cosine * (1.0f - alpha_squared) + alpha_squared);
  };
  return 0.5f / (to_light * root(to_camera) + to_camera * root(to_light));
}

// The albedo of the GGX lobe as scale and bias of F0, over roughness and the cosine to the camera:
// the split sum of Karis, "Real shading in Unreal Engine 4", 2013.
class LobeTable {
 public:
  LobeTable() {
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        values_[i][j] = Integrate(Coordinate(i), std::max(0.02f, Coordinate(j)));
      }
    }
  }

  Eigen::Vector2f At(float roughness, float cosine) const {
    const float x = std::clamp(roughness, 0.0f, 1.0f) * (kSide - 1);
    const float y = std::clamp(cosine, 0.0f, 1.0f) * (kSide - 1);
    const int i = std::min(kSide - 2, static_cast<int>(x));
    const int j = std::min(kSide - 2, static_cast<int>(y));
    const float u = x - static_cast<float>(i), v = y - static_cast<float>(j);
    return (1.0f - u) * ((1.0f - v) * values_[i][j] + v * values_[i][j + 1]) +
           u * ((1.0f - v) * values_[i + 1][j] + v * values_[i + 1][j + 1]);
  }

 private:
  static constexpr int kSide = 24;
  static constexpr unsigned kSamples = 256;

  static float Coordinate(int i) { return static_cast<float>(i) / (kSide - 1); }

  static Eigen::Vector2f Integrate(float roughness, float cosine) {
    const float alpha = std::max(kLeastRoughness, roughness) * std::max(kLeastRoughness, roughness);
    const Eigen::Vector3f camera(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
    Eigen::Vector2f sum = Eigen::Vector2f::Zero();
    for (unsigned k = 0; k < kSamples; ++k) {
      // Half vectors are drawn by the lobe's distribution.
      const Eigen::Vector2f point = SpreadPoint(k, kSamples);
      const float z = std::sqrt((1.0f - point.y()) / (1.0f + (alpha * alpha - 1.0f) * point.y()));
      const float across = std::sqrt(std::max(0.0f, 1.0f - z * z));
      const float azimuth = 2.0f * kPi * point.x();
      const Eigen::Vector3f half(across * std::cos(azimuth), across * std::sin(azimuth), z);
      const float c = camera.dot(half);
      const float lit = 2.0f * c * z - cosine;  // z of the mirrored direction
      if (lit <= 0.0f || c <= 0.0f) continue;
      const float weight = 4.0f * Visibility(lit, cosine, alpha * alpha) * lit * c / z;
      const float grazing = PowerOf5(1.0f - std::min(1.0f, c));
      sum += weight * Eigen::Vector2f(1.0f - grazing, grazing);
    }
    return sum / static_cast<float>(kSamples);
  }

  Eigen::Vector2f values_[kSide][kSide];
};

Eigen::Vector2f LobeAlbedo(float roughness, float cosine) {
  static const LobeTable table;
  return table.At(roughness, cosine);
}

}  // namespace

SpecularLight::SpecularLight(const SphericalHarmonicsLight& light) : rest_(light) {
  const Eigen::RowVector3f weights(0.2126f, 0.7152f, 0.0722f);
  const auto luminance = [&](int row) { return weights.dot(light.radiance.row(row)); };
  const Eigen::Vector3f towards(luminance(3), luminance(1), luminance(2));
  if (towards.norm() < 1e-6f) return;
  key_direction_ = towards.normalized();
  // A distant light of irradiance E has the coefficients E Y(direction).
  const Eigen::Matrix<float, 9, 1> basis = BasisAt(key_direction_);
  const Eigen::Vector3f along =
      light.radiance.block<3, 3>(1, 0).transpose() *
      Eigen::Vector3f(key_direction_.y(), key_direction_.z(), key_direction_.x());
  key_irradiance_ = (along / kFirstBand).cwiseMax(0.0f);
  rest_.radiance -= basis * key_irradiance_.transpose();
}

Eigen::Vector3f SpecularLight::Reflect(const Reflection& reflection, const Eigen::Vector3f& normal,
                                       const Eigen::Vector3f& to_camera, float openness,
                                       float key_share) const {
  const float roughness = std::clamp(reflection.roughness, kLeastRoughness, 1.0f);
  const float alpha = roughness * roughness;
  const float cosine = std::clamp(normal.dot(to_camera), 1e-3f, 1.0f);
  const Eigen::Vector3f mirrored = 2.0f * cosine * normal - to_camera;

  Eigen::Matrix<float, 9, 1> basis = BasisAt(mirrored.normalized());
  basis.segment<3>(1) *= std::exp(-alpha * alpha);
  basis.segment<5>(4) *= std::exp(-4.0f * alpha * alpha);
  const Eigen::Vector3f surroundings = (rest_.radiance.transpose() * basis).cwiseMax(0.0f);
  const Eigen::Vector2f lobe = LobeAlbedo(roughness, cosine);
  Eigen::Vector3f reflected =
      openness *
      surroundings.cwiseProduct(reflection.f0 * lobe.x() + Eigen::Vector3f::Constant(lobe.y()));

  const float lit = normal.dot(key_direction_);
  if (lit <= 0.0f || key_share <= 0.0f) return reflected;
  const Eigen::Vector3f half = (key_direction_ + to_camera).normalized();
  const float h = std::clamp(normal.dot(half), 0.0f, 1.0f);
  const float a2 = alpha * alpha;
  const float d = h * h * (a2 - 1.0f) + 1.0f;
  const float distribution = a2 / (kPi * d * d);
  const float visibility = Visibility(lit, cosine, a2);
  const float grazing = PowerOf5(1.0f - std::clamp(to_camera.dot(half), 0.0f, 1.0f));
  const Eigen::Vector3f fresnel =
      reflection.f0 + grazing * (Eigen::Vector3f::Ones() - reflection.f0);
  reflected += key_share * distribution * visibility * lit * fresnel.cwiseProduct(key_irradiance_);
  return reflected;
}

void RequireMaps(const core::PbrLook& look) {
  for (const core::PbrMaterial& material : look.materials) {
    for (const int map : {material.metallic_map, material.roughness_map, material.normal_map}) {
      const bool is_there = map < static_cast<int>(look.images.size());
      if (map >= 0 && (!is_there || look.images[static_cast<std::size_t>(map)].empty())) {
        throw core::Error("a material names a map that is missing", "the look of a mesh");
      }
    }
  }
}

SurfaceReflection SampleReflection(const core::PbrLook& look, int material,
                                   const Eigen::Vector2f* uv) {
  SurfaceReflection surface;
  if (material < 0 || material >= static_cast<int>(look.materials.size())) return surface;
  const core::PbrMaterial& pbr = look.materials[static_cast<std::size_t>(material)];
  const auto sample = [&](int map) -> Eigen::Vector4f {
    if (map < 0 || uv == nullptr) return Eigen::Vector4f::Ones();
    return core::SampleTexture(look.images[static_cast<std::size_t>(map)], *uv);
  };
  surface.metallic = pbr.metallic * sample(pbr.metallic_map).x();
  surface.roughness = pbr.roughness * sample(pbr.roughness_map).x();
  if (pbr.normal_map < 0 || uv == nullptr) return surface;
  Eigen::Vector3f normal = 2.0f * sample(pbr.normal_map).head<3>() - Eigen::Vector3f::Ones();
  normal.head<2>() *= pbr.normal_scale;
  surface.has_normal = normal.norm() > 1e-3f;
  if (surface.has_normal) surface.tangent_normal = normal.normalized();
  return surface;
}

Eigen::Vector3f PerturbedNormal(const Eigen::Vector3f& tangent_normal,
                                const Eigen::Vector3f& normal, const Eigen::Matrix3f& corners,
                                const Eigen::Vector2f* uvs) {
  const Eigen::Vector2f a = uvs[1] - uvs[0], b = uvs[2] - uvs[0];
  const float area = a.x() * b.y() - a.y() * b.x();
  const Eigen::Vector3f p = corners.col(1) - corners.col(0), q = corners.col(2) - corners.col(0);
  const float side = area < 0.0f ? -1.0f : 1.0f;
  Eigen::Vector3f along_u = side * (p * b.y() - q * a.y());
  along_u -= along_u.dot(normal) * normal;
  if (!(along_u.norm() > 1e-12f)) return normal;
  along_u.stableNormalize();
  // The face's own side decides where v grows, also where the shading normal faces the camera.
  const bool back = p.cross(q).dot(normal) < 0.0f;
  const Eigen::Vector3f along_v = (back ? -side : side) * normal.cross(along_u);
  return (tangent_normal.x() * along_u + tangent_normal.y() * along_v + tangent_normal.z() * normal)
      .stableNormalized();
}

Eigen::Vector3f NormalReflectance(const Eigen::Vector3f& albedo, float metallic) {
  return (1.0f - metallic) * Eigen::Vector3f::Constant(kDielectric) + metallic * albedo;
}

}  // namespace simwright::render
