#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "physics_params/knowledge_base.h"
#include "physics_params/stated_interval.h"

namespace simwright::physics_params {

// A range, a value sampled from it, and their source. min <= sample <= max.
struct Estimate {
  double min = 0.0;
  double max = 0.0;
  double sample = 0.0;
  std::string source;
};

// The size, mass and contact parameters of one object of a category.
struct PhysicalParameters {
  std::string category;    // the row used
  std::string resolution;  // how the requested name was resolved
  std::string material;    // the sampled material; its density and contact parameters are used
  Fill fill = Fill::kSolid;
  Shape shape = Shape::kFree;
  Estimate length, width, height;  // m; length >= width
  Estimate mass;                   // kg
  Estimate density;                // kg/m^3, of the material
  Estimate friction;               // Coulomb coefficient
  Estimate restitution;            // in [0, 1]
  StatedIntervals intervals;       // calibrated, of size, mass and friction
};

// Samples an object of `category` and states its intervals: one quantile for its size (big objects
// are big in every dimension), with a small variation per side, and a mass that follows the size.
// The row's materials are sampled with weights 1, 1/2, 1/3 ... in their order. The same seed gives
// the same object.
PhysicalParameters SampleParameters(const Category& category, const KnowledgeBase& base,
                                    std::uint64_t seed);

// Rescales the mass to the object's true size: multiplies the sample by the volume of its bounding
// box (`size`, m, length, width, height) over that of the sampled box, and clamps it to the
// category's range if the size is in its ranges too. The catch-all category "object" has no mass:
// it uses 250 kg/m^3, typical of hollow household goods, over `solid_volume` (m^3). Returns a
// sentence if the size is outside the category's ranges, else an empty string.
std::string ScaleMassToSize(const Category& category, const Eigen::Vector3d& size,
                            double solid_volume, PhysicalParameters* parameters);

// The mass and density of a given shape.
struct MassModel {
  double mass = 0.0;            // kg
  double density = 0.0;         // kg/m^3 of the material (solid) or the wall (shell)
  double wall_thickness = 0.0;  // m; 0: solid
  std::string material;
  bool within_range = true;  // mass is in the category's range
  std::string sentence;      // how mass, volume and material were reconciled
};

// Makes mass, volume and density consistent. `volume` (m^3) and `area` (m^2) are those of the
// closed solid at its true size. A body whose sampled mass gives a density within the material's
// range is solid. A lighter one is a shell, whose wall has the material's density; a frame is never
// solid. A heavier one takes the nearest density that the row's materials allow, and its mass
// follows, so that rho V = m always holds. Throws core::Error unless volume and area are > 0.
MassModel ReconcileMass(const PhysicalParameters& parameters, const Category& category,
                        const KnowledgeBase& base, double volume, double area);

}  // namespace simwright::physics_params
