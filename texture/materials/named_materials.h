#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/random.h"
#include "texture/materials/surface_material.h"

namespace simwright::texture {

// Returns true if `name` ("oak", "cast iron", "glazed ceramic", "apple") is in the list of
// materials. Names are in lower case with blanks between words.
bool IsNamedMaterial(std::string_view name);

// Returns a material of the name. Where it comes in several colours, number `turn` of them is taken
// (in a circle), by default a drawn one; its seed and small differences of colour, roughness and
// scale are drawn always. Throws core::Error for an unknown name.
SurfaceMaterial NamedMaterial(std::string_view name, core::Rng* rng,
                              std::optional<std::uint64_t> turn = std::nullopt);

// Returns all names, sorted, each once.
std::vector<std::string> MaterialNames();

// Returns the colour (sRGB) of a name such as "navy" or "dark green", or none.
std::optional<Eigen::Vector3f> NamedColor(std::string_view name);

// Gives the material `color`, with its second colour beside it: wood darkens towards the latewood,
// a painted metal shows the metal below. Metals and glass take on the hue.
void SetColor(const Eigen::Vector3f& color, SurfaceMaterial* material);

}  // namespace simwright::texture
