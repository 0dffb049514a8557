#pragma once

#include <optional>

#include "physics_params/physical_parameters.h"
#include "physics_params/variant_choice.h"

namespace simwright::physics_params {

// The properties of an object that a user states. They override its category's and sampled values.
struct StatedPhysics {
  std::optional<double> mass;      // kg
  std::optional<double> density;   // kg/m^3, of the material: of the walls if a mass is stated too
  std::optional<double> friction;  // Coulomb coefficient
  VariantChoice variant;           // the material and the size class
  bool Any() const { return mass || density || friction; }
};

// Throws core::Error for impossible values: a mass or density that is not above 0 or not finite, a
// friction below 0 or above 10.
void Validate(const StatedPhysics& stated);

// Sets the ranges and samples of stated properties to the value, with "stated" as their source,
// and the stated intervals of mass and friction to the same values.
void Apply(const StatedPhysics& stated, PhysicalParameters* parameters);

// Works like ReconcileMass, but keeps stated values exactly: a mass alone makes a solid, or walls
// of the material, whatever density that takes; a density alone makes a solid; both give walls.
// Throws core::Error if a stated mass needs more volume at the stated density than there is.
MassModel ReconcileMass(const StatedPhysics& stated, const PhysicalParameters& parameters,
                        const Category& category, const KnowledgeBase& base, double volume,
                        double area);

}  // namespace simwright::physics_params
