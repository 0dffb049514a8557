#include "render/light.h"

#include <cmath>

namespace simwright::render {
namespace {

// The orthonormal constants of the real basis.
constexpr float kBand0 = 0.282095f, kBand1 = 0.488603f, kBand2 = 1.092548f, kBand2z = 0.315392f,
                kBand2xx = 0.546274f;

Eigen::Matrix<float, 9, 1> Basis(const Eigen::Vector3f& n) {
  Eigen::Matrix<float, 9, 1> basis;
  basis << kBand0, kBand1 * n.y(), kBand1 * n.z(), kBand1 * n.x(), kBand2 * n.x() * n.y(),
      kBand2 * n.y() * n.z(), kBand2z * (3.0f * n.z() * n.z() - 1.0f), kBand2 * n.x() * n.z(),
      kBand2xx * (n.x() * n.x() - n.y() * n.y());
  return basis;
}

}  // namespace

Eigen::Matrix<float, 9, 1> IrradianceWeights(const Eigen::Vector3f& n) {
  Eigen::Matrix<float, 9, 1> weights = Basis(n);
  weights.segment<3>(1) *= 2.0f / 3.0f;
  weights.segment<5>(4) *= 0.25f;
  return weights;
}

Eigen::Matrix<float, 9, 3> IrradianceWeightsJacobian(const Eigen::Vector3f& n) {
  constexpr float k1 = 2.0f / 3.0f * kBand1, k2 = 0.25f * kBand2, k2z = 0.25f * kBand2z,
                  k2xx = 0.25f * kBand2xx;
  Eigen::Matrix<float, 9, 3> jacobian;
  jacobian << 0.0f, 0.0f, 0.0f,        //
      0.0f, k1, 0.0f,                  //
      0.0f, 0.0f, k1,                  //
      k1, 0.0f, 0.0f,                  //
      k2 * n.y(), k2 * n.x(), 0.0f,    //
      0.0f, k2 * n.z(), k2 * n.y(),    //
      0.0f, 0.0f, 6.0f * k2z * n.z(),  //
      k2 * n.z(), 0.0f, k2 * n.x(),    //
      2.0f * k2xx * n.x(), -2.0f * k2xx * n.y(), 0.0f;
  return jacobian;
}

Eigen::Vector3f SphericalHarmonicsLight::Shade(const Eigen::Vector3f& n) const {
  return (radiance.transpose() * IrradianceWeights(n)).cwiseMax(0.0f);
}

SphericalHarmonicsLight SphericalHarmonicsLight::Uniform(float level) {
  SphericalHarmonicsLight light;
  light.radiance.row(0).setConstant(level / kBand0);
  return light;
}

SphericalHarmonicsLight SphericalHarmonicsLight::Studio(const Eigen::Vector3f& key) {
  SphericalHarmonicsLight light = Uniform(0.62f);
  const Eigen::Matrix<float, 9, 1> towards = Basis(key.normalized());
  const Eigen::Matrix<float, 9, 1> above = Basis(Eigen::Vector3f::UnitZ());
  for (int i = 1; i < 4; ++i) {
    light.radiance.row(i).array() += 0.72f * towards[i] + 0.42f * above[i];
  }
  for (int i = 4; i < 9; ++i) light.radiance.row(i).array() += 0.25f * towards[i];
  return light;
}

float LinearFromSrgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

float SrgbFromLinear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

}  // namespace simwright::render
