#pragma once

#include <string>

#include <Eigen/Core>

#include "library/draws.h"

namespace simwright::library {

// The material and appearance of a piece.
struct Matter {
  std::string look;      // name of its colour in files, e.g. "white_enamel"
  std::string material;  // name in the knowledge base: density, friction, restitution
  double density = 0.0;  // kg/m^3
  Eigen::Vector4f color{0.8f, 0.8f, 0.8f, 1.0f};
};

// Returns a knowledge base material at its mean density. Throws core::Error for an unknown one.
Matter MatterOf(const std::string& material, const std::string& look, float r, float g, float b);

// The common appearances. Casing has the material "appliance": its density is fitted to the
// appliance's mass.
Matter Casing(Draws& draws);  // white, cream, black or grey
Matter BrushedSteel();
Matter BlackPlastic();
Matter DarkGlass();                   // for an oven's door
Matter ClearGlass();                  // pale blue
Matter Board(Draws& draws);           // plywood: oak, walnut, white, grey or green
Matter FurnitureMetal(Draws& draws);  // steel or brass, for handles

}  // namespace simwright::library
