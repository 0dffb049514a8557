#include "physics_params/stated_physics.h"

#include <cmath>

#include "core/error.h"
#include "geometry/mass_properties.h"
#include "physics_params/rounded_text.h"

namespace simwright::physics_params {
namespace {

Estimate Stated(double value) {
  return {value, value, value, "stated"};
}

void RequirePositive(const std::optional<double>& value, const char* option) {
  if (value && !(*value > 0.0 && std::isfinite(*value))) {
    throw core::Error("must be above 0", std::string(option) + " " + RoundedText(*value));
  }
}

// Both are stated: the material's volume is spread over the solid or its surface.
MassModel WithBoth(double mass, double density, double volume, double area) {
  MassModel model;
  model.mass = mass;
  model.density = density;
  const double full = density * volume;
  constexpr double kSame = 1e-6;
  if (mass > full * (1.0 + kSame)) {
    throw core::Error("a mass of " + RoundedText(mass) + " kg does not fit into " +
                          RoundedText(volume * 1e3) + " l at " + RoundedText(density) + " kg/m3",
                      "", "state one of --mass and --density, or a larger --size");
  }
  if (mass >= full * (1.0 - kSame)) {
    model.sentence = "full: the stated mass and density fill its volume";
    return model;
  }
  model.wall_thickness = geometry::WallThickness(mass / full, volume, area);
  model.sentence = "shell: the stated mass at the stated density is a wall of " +
                   RoundedText(model.wall_thickness * 1e3) + " mm";
  return model;
}

}  // namespace

void Validate(const StatedPhysics& stated) {
  RequirePositive(stated.mass, "--mass");
  RequirePositive(stated.density, "--density");
  constexpr double kSlowest = 10.0;
  if (stated.friction && !(*stated.friction >= 0.0 && *stated.friction <= kSlowest)) {
    throw core::Error("a friction coefficient must lie in 0 to 10",
                      "--friction " + RoundedText(*stated.friction));
  }
}

void Apply(const StatedPhysics& stated, PhysicalParameters* parameters) {
  if (stated.mass) {
    parameters->mass = Stated(*stated.mass);
    parameters->intervals.mass = {*stated.mass, *stated.mass};
  }
  if (stated.density) parameters->density = Stated(*stated.density);
  if (stated.friction) {
    parameters->friction = Stated(*stated.friction);
    parameters->intervals.friction = {*stated.friction, *stated.friction};
  }
}

MassModel ReconcileMass(const StatedPhysics& stated, const PhysicalParameters& parameters,
                        const Category& category, const KnowledgeBase& base, double volume,
                        double area) {
  MassModel model;
  if (stated.mass && stated.density) {
    model = WithBoth(*stated.mass, *stated.density, volume, area);
  } else if (stated.density) {
    model.density = *stated.density;
    model.mass = model.density * volume;
    model.sentence = "full: the stated density over its volume";
  } else {
    model = ReconcileMass(parameters, category, base, volume, area);
    if (!stated.mass || model.mass == *stated.mass) return model;
    model.mass = *stated.mass;
    model.density = model.mass / volume;
    model.sentence =
        "full: the stated mass over its volume is " + RoundedText(model.density) + " kg/m3";
  }
  if (model.material.empty()) model.material = parameters.material;
  model.within_range = category.mass.Contains(model.mass);
  return model;
}

}  // namespace simwright::physics_params
