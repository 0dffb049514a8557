#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// A range with the value drawn from it, and what it rests on. min <= sample <= max.
struct Estimate {
  double min = 0.0;
  double max = 0.0;
  double sample = 0.0;
  std::string source;
};

// Size, mass and contact of one thing of a category.
struct PhysicalParameters {
  std::string category;    // the row used
  std::string resolution;  // how the requested name led to it
  std::string material;    // the one drawn; its densities and contact figures are used
  Fill fill = Fill::kSolid;
  Shape shape = Shape::kFree;
  Estimate length, width, height;  // m; length >= width
  Estimate mass;                   // kg
  Estimate density;                // kg/m^3, of the material
  Estimate friction;               // Coulomb coefficient
  Estimate restitution;            // in [0, 1]
};

// Draws a thing of `category`: one quantile for its size (big things are big in every direction),
// with a little freedom a side, and a mass that follows the size. The likeliest material is drawn
// in proportion 1, 1/2, 1/3 ... of the row's order. The same seed gives the same thing.
PhysicalParameters SampleParameters(const Category& category, const KnowledgeBase& base,
                                    std::uint64_t seed);

// Lets the mass follow the true size of the thing: the sample is scaled by the volume of its
// bounding box (`size`, m, length, width, height) over that of the sampled box, and kept in the
// category's range where the size is in its ranges too. The catch-all category "object" knows no
// mass: it takes 250 kg/m^3, hollow household goods, over `solid_volume` (m^3).
// Returns a sentence where the size lies outside the category's ranges, else an empty string.
std::string FollowSize(const Category& category, const Eigen::Vector3d& size, double solid_volume,
                       PhysicalParameters* parameters);

// Mass as it fits a given shape.
struct MassModel {
  double mass = 0.0;            // kg
  double density = 0.0;         // kg/m^3 of the material (solid), or of the wall (shell)
  double wall_thickness = 0.0;  // m; 0: the solid is full
  std::string material;
  bool within_range = true;  // mass lies in the category's range
  std::string sentence;      // how mass, volume and material were reconciled
};

// Makes mass, volume and density agree. `volume` (m^3) and `area` (m^2) are those of the closed
// solid at its true size.
// A body whose sampled mass gives a density within the material's range is full. One that comes
// out lighter is a shell, whose wall has the material's density; a frame is never full. One that
// comes out heavier keeps the nearest density that the row's materials allow, and its mass
// follows, so that rho V = m always holds. Throws core::Error unless volume and area are > 0.
MassModel ReconcileMass(const PhysicalParameters& parameters, const Category& category,
                        const KnowledgeBase& base, double volume, double area);

}  // namespace simwright::physics_params
