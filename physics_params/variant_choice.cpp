#include "physics_params/variant_choice.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace simwright::physics_params {
namespace {

// A row with its share of the objects under a name.
struct Candidate {
  Category row;
  double weight = 0.0;
  std::optional<SizeClass> size_class;
};

std::vector<Candidate> CandidatesOf(const Category& category, const KnowledgeBase& base) {
  std::vector<Candidate> candidates{{category, 1.0, std::nullopt}};
  for (const Variant& variant : category.variants) {
    candidates.push_back(
        {*base.FindCategory(variant.category), variant.weight, variant.size_class});
    candidates[0].weight -= variant.weight;
  }
  return candidates;
}

bool IsMadeOf(const Category& row, const std::string& material) {
  return std::find(row.materials.begin(), row.materials.end(), material) != row.materials.end();
}

void KeepMaterial(const std::string& material, const std::string& name,
                  std::vector<Candidate>* candidates) {
  std::vector<Candidate> kept;
  std::vector<std::string> known;
  for (Candidate& one : *candidates) {
    for (const std::string& other : one.row.materials) {
      if (std::find(known.begin(), known.end(), other) == known.end()) known.push_back(other);
    }
    if (!IsMadeOf(one.row, material)) continue;
    // A row of several materials holds less of each: weights 1, 1/2, 1/3 ... in their order.
    double total = 0.0, share = 0.0;
    for (size_t i = 0; i < one.row.materials.size(); ++i) {
      total += 1.0 / static_cast<double>(i + 1);
      if (one.row.materials[i] == material) share = 1.0 / static_cast<double>(i + 1);
    }
    one.weight *= share / total;
    one.row.materials = {material};
    kept.push_back(std::move(one));
  }
  if (kept.empty()) {
    std::string list;
    for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
    throw core::Error("'" + name + "' is not known in this material", "--material " + material,
                      "--material one of: " + list + "; or state --density");
  }
  *candidates = std::move(kept);
}

const Candidate& Heaviest(const std::vector<Candidate>& candidates) {
  return *std::max_element(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.weight < b.weight; });
}

Interval Third(const Interval& range, SizeClass size_class) {
  const double third = std::log(range.max / range.min) / 3.0;
  const int index = static_cast<int>(size_class);
  return {range.min * std::exp(index * third), range.min * std::exp((index + 1) * third)};
}

void KeepSizeClass(SizeClass size_class, std::vector<Candidate>* candidates) {
  std::vector<Candidate> kept;
  for (const Candidate& one : *candidates) {
    if (one.size_class == size_class) kept.push_back(one);
  }
  if (kept.empty()) {
    Candidate heaviest = Heaviest(*candidates);
    Category& row = heaviest.row;
    for (Interval* range : {&row.length, &row.width, &row.height, &row.mass}) {
      *range = Third(*range, size_class);
    }
    kept.push_back(std::move(heaviest));
  }
  *candidates = std::move(kept);
}

}  // namespace

Category ChosenVariant(const Category& category, const KnowledgeBase& base,
                       const VariantChoice& choice) {
  if (!choice.Any()) return category;
  std::vector<Candidate> candidates = CandidatesOf(category, base);
  if (choice.material) {
    const Material* material = base.FindMaterial(*choice.material);
    KeepMaterial(material != nullptr ? material->name : *choice.material, category.name,
                 &candidates);
  }
  if (choice.size_class) KeepSizeClass(*choice.size_class, &candidates);
  Category chosen = Heaviest(candidates).row;
  chosen.variants.clear();
  double total = 0.0;
  for (const Candidate& one : candidates) total += one.weight;
  for (const Candidate& one : candidates) {
    if (one.row.name == chosen.name) continue;
    chosen.variants.push_back({one.row.name, one.weight / total, one.size_class, false});
  }
  return chosen;
}

}  // namespace simwright::physics_params
