#pragma once

#include <optional>

#include "physics_params/physical_parameters.h"

namespace simwright::physics_params {

// What a user states of a thing. It wins over what its category knows and over what was drawn.
struct StatedPhysics {
  std::optional<double> mass;      // kg
  std::optional<double> density;   // kg/m^3, of the matter: of the walls where a mass is stated too
  std::optional<double> friction;  // Coulomb coefficient
  bool Any() const { return mass || density || friction; }
};

// Throws core::Error for what no thing has: a mass or density that is not above 0 or not finite, a
// friction below 0 or above 10.
void Validate(const StatedPhysics& stated);

// Ranges and samples of what is stated become the value, with "stated" as their source.
void Apply(const StatedPhysics& stated, PhysicalParameters* parameters);

// As ReconcileMass, with what is stated kept to the last digit: a mass alone fills the solid or
// gives it walls of the material, whatever density that takes; a density alone fills it; both give
// walls. Throws core::Error where a stated mass needs more volume at the stated density than there
// is.
MassModel ReconcileMass(const StatedPhysics& stated, const PhysicalParameters& parameters,
                        const Category& category, const KnowledgeBase& base, double volume,
                        double area);

}  // namespace simwright::physics_params
