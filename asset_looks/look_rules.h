#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/random.h"
#include "texture/materials/surface_material.h"

namespace simwright::asset_looks {

// A kind of surface on an asset: all triangles of one material on parts of one role.
struct LookSlot {
  std::string material;   // its name in the asset's files, in plain words: "brushed steel", "red"
  std::string part;       // "body", "handle"; empty if parts have no names
  std::string substance;  // the material of the knowledge base: "ceramic"
  double area = 0.0;      // m^2
  Eigen::Vector3f color{0.8f, 0.8f, 0.8f};  // sRGB, as the asset has it

  bool IsFitting() const;  // a handle, button, label or screen: no words about the whole mean it
};

// Returns a name from a file in plain words: lower case, blanks, no number at the end.
std::string PlainWords(const std::string& name);

// Returns the name of the material (texture::NamedMaterial) that a surface has by rule: from the
// name in the asset's files where it says one, else from the category (fruit, bread, balls), else
// from the material of the knowledge base. Where a rule leaves a choice (the kind of wood), it is
// drawn.
std::string MaterialByRule(const LookSlot& slot, const std::string& category, core::Rng* rng);

// Returns what a package of the category has as its title: "CEREAL" for a cereal box, the name of a
// brand where the category says nothing.
std::string PrintTitle(const std::string& category, core::Rng* rng);

}  // namespace simwright::asset_looks
