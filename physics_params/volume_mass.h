#pragma once

#include <string>
#include <vector>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// One way in which the measured shape may be filled.
struct Filling {
  std::string material;
  double weight = 0.0;  // share; the weights of an input sum to 1
  Interval density;     // kg/m^3, the central 90 %
  bool shell = false;   // a wall of `wall` inside the surface; else solid
  Interval wall;        // m, the central 90 %; used of shells alone
};

struct VolumeMassInput {
  double volume = 0.0;        // m^3, enclosed by the surface at true size
  double area = 0.0;          // m^2, of the surface
  double volume_error = 0.0;  // standard error of ln(volume); the area has 2/3 of it
  std::vector<Filling> fillings;
};

struct VolumeMassOutput {
  double median = 0.0;  // kg
  Interval mass;        // kg, the central interval with the requested probability
};

// Returns the mass of a body of measured volume whose material is known up to its density and, of a
// shell, its wall. Density, wall and volume are independent and log-normal. A solid's mass is
// density x volume: a closed form. A shell's is density x volume (1 - (1 - wall area / (3
// volume))^3), as in geometry/mass_properties.h, a wall as thick as the body being solid; the wall
// is integrated over 200 equal quantiles, which moves an end of the interval by less than 0.5 %.
// Throws core::Error unless volume, area, weights and ranges are positive, the error is not
// negative, and 0 < probability < 1.
VolumeMassOutput MassFromVolume(const VolumeMassInput& input, double probability);

// Returns the input for a shape of a category: each material of the row with weights 1, 1/2, 1/3
// ... in their order. A solid row, and a material without a usual wall (contents, fruit, devices),
// is solid. Other rows are shells with the material's usual wall, but solid where the mean
// thickness 2 volume / area is at most 1.5 times that wall: such a mesh models its walls. Half of a
// frame is solid parts, half hollow ones.
VolumeMassInput VolumeInputOf(const Category& category, const KnowledgeBase& base, double volume,
                              double area, double volume_error);

// A mass interval and how it was found.
struct MeasuredMass {
  Interval mass;         // kg, stated to hold with probability 0.9
  std::string sentence;  // "its measured volume of 1.45 l in wood weighs 0.61 to 1.2 kg"
};

// Combines what the name and the volume say: the narrowest of the name's 90 % interval, the
// volume's 90 % interval, and the intersection of their 95 % intervals, which holds with 90 % at
// least, whatever their dependence. The choice depends on widths alone, so that a volume never
// widens an interval. If the 95 % intervals do not overlap, the volume's 90 % interval stands, and
// the sentence says so.
MeasuredMass MassOfMeasured(const Category& category, const KnowledgeBase& base, double volume,
                            double area, double volume_error);

}  // namespace simwright::physics_params
