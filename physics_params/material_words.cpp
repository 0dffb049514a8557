#include "physics_params/material_words.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace simwright::physics_params {
namespace {

// Words that name a material of the base differently.
constexpr struct {
  std::string_view word, material;
} kMaterialWords[] = {{"foam", "foam plastic"},      {"wooden", "wood"},
                      {"iron", "cast iron"},         {"metal", "steel"},
                      {"stainless", "steel"},        {"aluminum", "aluminium"},
                      {"acrylic", "plastic"},        {"artificial", "plastic"},
                      {"fake", "plastic"},           {"clay", "earthenware"},
                      {"terracotta", "earthenware"}, {"fabric", "textile"},
                      {"cloth", "textile"},          {"woolen", "wool"}};

const Material* MaterialNamed(const std::string& word, const KnowledgeBase& base) {
  for (const auto& row : kMaterialWords) {
    if (word == row.word) return base.FindMaterial(row.material);
  }
  return base.FindMaterial(word);
}

bool IsMadeOf(const Category& row, const Material& material) {
  return std::find(row.materials.begin(), row.materials.end(), material.name) !=
         row.materials.end();
}

bool IsFarInDensity(const Category& row, const Material& material, const KnowledgeBase& base) {
  constexpr double kFar = 2.0;
  return std::all_of(row.materials.begin(), row.materials.end(), [&](const std::string& name) {
    const Interval& own = base.FindMaterial(name)->density;
    return material.density.min > kFar * own.max || material.density.max * kFar < own.min;
  });
}

}  // namespace

Resolution WithNamedMaterial(const std::vector<std::string>& words, size_t head,
                             const KnowledgeBase& base, Resolution found) {
  for (size_t i = 0; i < head; ++i) {
    const Material* material = MaterialNamed(words[i], base);
    if (material == nullptr) continue;
    if (IsMadeOf(*found.category, *material)) {
      found.material = material->name;
      return found;
    }
    for (const Variant& variant : found.category->variants) {
      const Category* row = base.FindCategory(variant.category);
      if (!IsMadeOf(*row, *material)) continue;
      found.category = row;
      found.material = material->name;
      found.sentence += ", made of " + material->name;
      return found;
    }
    if (found.category->fill == Fill::kSolid && IsFarInDensity(*found.category, *material, base)) {
      return {};
    }
  }
  return found;
}

}  // namespace simwright::physics_params
