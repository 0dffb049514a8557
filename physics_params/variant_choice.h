#pragma once

#include <optional>
#include <string>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// The material and the size class that a user states of an object; either may be unset.
struct VariantChoice {
  std::optional<std::string> material;  // a name of the base's materials
  std::optional<SizeClass> size_class;
  bool Any() const { return material || size_class; }
};

// Returns the row of `category` and its variants that fits the choice, with its materials narrowed
// to the stated one. A variant with the stated size class is taken whole; of other rows, the ranges
// of size and mass are cut to that third of their logarithm. Its remaining variants are those that
// the choice does not exclude. Throws core::Error, which lists the materials, if neither the row
// nor a variant is made of the stated material.
Category ChosenVariant(const Category& category, const KnowledgeBase& base,
                       const VariantChoice& choice);

}  // namespace simwright::physics_params
