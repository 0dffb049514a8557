#include "assets/hydroelastic.h"

#include <algorithm>
#include <cmath>

namespace simwright::assets {
namespace {

constexpr double kHydroelasticGravity = 9.81;  // m/s^2
constexpr double kStiffModulus = 5e7;          // Pa, for all other materials
constexpr double kLargestModulus = 1e8;        // Pa: above it Drake's contact solver loses digits
constexpr double kDepthAtRest = 1e-4;          // m, of a round body under its own weight
constexpr double kSmallestHint = 1e-3;         // m

// Young's moduli by order of magnitude, Pa: cushion foams 1e5, textiles and bread likewise; flesh
// of fruit 1e6; natural rubber and silicone 3e6; stiffer materials use the default.
constexpr struct {
  const char* material;
  double modulus;
} kSoftMaterials[] = {
    {"upholstery", 1e5},  {"textile", 1e5},  {"cotton", 2e5}, {"wool", 1e5},        {"bread", 1e5},
    {"meat", 2e5},        {"food", 5e5},     {"dairy", 5e5},  {"vegetable", 1e6},   {"wax", 5e6},
    {"fruit flesh", 1e6}, {"silicone", 3e6}, {"rubber", 3e6}, {"foam plastic", 2e6}};

double ModulusOf(const std::string& material) {
  for (const auto& soft : kSoftMaterials) {
    if (material == soft.material) return soft.modulus;
  }
  return kStiffModulus;
}

}  // namespace

HydroelasticContact HydroelasticContactOf(const std::string& material, double mass,
                                          const Eigen::Vector3d& extents, double friction) {
  HydroelasticContact contact;
  // A ball of radius r that sinks in by d has a contact circle of area 2 pi r d, under a pressure
  // that rises to modulus * d / r: it bears a load of pi * modulus * d^2.
  const double carries = mass * kHydroelasticGravity / (M_PI * kDepthAtRest * kDepthAtRest);
  contact.modulus = std::min(std::max(ModulusOf(material), carries), kLargestModulus);
  contact.resolution_hint = std::max(kSmallestHint, 0.5 * extents.minCoeff());
  contact.friction = friction;
  return contact;
}

}  // namespace simwright::assets
