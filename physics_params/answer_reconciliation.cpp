#include "physics_params/answer_reconciliation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/error.h"

namespace simwright::physics_params {
namespace {

constexpr double kSingleValueSpread = 0.1;              // to either side
constexpr double kLightest = 5.0, kHeaviest = 12000.0;  // kg/m^3 over the bounding box
constexpr double kSmallest = 1e-3, kLargest = 20.0;     // m
constexpr double kRounding = 1.05;  // of handbook densities, as in the knowledge base's own tests

// The tolerated ratio between two ranges.
struct Tolerance {
  double exact;  // beyond it, a disagreement with the exact category is a warning
  double near;   // up to it, the model overrides a related category
};
constexpr Tolerance kSizeTolerance{1.5, 2.0}, kMassTolerance{2.5, 4.0};

std::string Text(const Interval& range, double unit, const char* name) {
  char text[80];
  std::snprintf(text, sizeof(text), "%.3g-%.3g %s", range.min / unit, range.max / unit, name);
  return text;
}

Interval Spread(const Interval& range) {
  if (range.max > range.min) return range;
  return {range.min * (1.0 - kSingleValueSpread), range.max * (1.0 + kSingleValueSpread)};
}

double Middle(const Interval& range) {
  return std::sqrt(range.min * range.max);
}

// Returns 1 if the ranges overlap, else the ratio of the nearer ends, > 1.
double RangeRatio(const Interval& a, const Interval& b) {
  return std::max({1.0, a.min / b.max, b.min / a.max});
}

void Report(EstimatedCategory* estimate, const std::string& code, core::Severity severity,
            const std::string& sentence, double figure) {
  estimate->findings.push_back({code, severity, estimate->category.name, sentence, figure});
}

// Merges one quantity: the known range becomes the intersection, or the winner's range.
struct ReconciledQuantity {
  const char* name;
  double unit;
  const char* unit_name;
  Tolerance tolerance;
};

void Join(const ReconciledQuantity& quantity, const std::optional<Interval>& said, bool exact,
          const std::string& model, Interval* known, std::string* source,
          EstimatedCategory* estimate) {
  if (!said) return;
  const Interval range = Spread(*said);
  const double apart = RangeRatio(range, *known);
  if (apart <= 1.0) {
    const Interval both{std::max(range.min, known->min), std::min(range.max, known->max)};
    const bool narrower = both.min > known->min || both.max < known->max;
    *source += (narrower ? ", narrowed by " : ", confirmed by ") + model;
    *known = both;
    return;
  }
  const std::string words = std::string(quantity.name) + " of " +
                            Text(range, quantity.unit, quantity.unit_name) + " by " + model +
                            " against " + Text(*known, quantity.unit, quantity.unit_name) +
                            " of the knowledge base: ";
  if (!exact && apart <= quantity.tolerance.near) {
    Report(estimate, "llm-disagrees", core::Severity::kInfo,
           words + "the model wins, since the base has only a related category", apart);
    *known = range;
    *source = model;
    return;
  }
  const bool far = apart > (exact ? quantity.tolerance.exact : quantity.tolerance.near);
  Report(estimate, "llm-disagrees", far ? core::Severity::kWarning : core::Severity::kInfo,
         words + "the base wins", apart);
  *source += "; " + model + " disagreed";
}

// Returns the sum over the sides of their log distance from the known ranges.
double OrderMisfit(const std::array<Interval, 3>& sides, const Category& known) {
  return std::log(RangeRatio(sides[0], known.length)) +
         std::log(RangeRatio(sides[1], known.width)) + std::log(RangeRatio(sides[2], known.height));
}

// Permutes the sides to the order that fits the known ranges best: models give a bottle's height as
// its length.
void PermuteSides(const Category& known, ObjectAnswer* answer, EstimatedCategory* estimate) {
  if (!answer->length || !answer->width || !answer->height) return;
  const std::array<Interval, 3> said = {Spread(*answer->length), Spread(*answer->width),
                                        Spread(*answer->height)};
  std::array<Interval, 3> best = said;
  std::array<int, 3> order = {0, 1, 2};
  do {
    const std::array<Interval, 3> permuted = {said[static_cast<std::size_t>(order[0])],
                                              said[static_cast<std::size_t>(order[1])],
                                              said[static_cast<std::size_t>(order[2])]};
    if (OrderMisfit(permuted, known) < OrderMisfit(best, known)) best = permuted;
  } while (std::next_permutation(order.begin(), order.end()));
  constexpr double kClearly = 0.1;  // a tenth of a side: less is no reason to permute
  if (OrderMisfit(said, known) - OrderMisfit(best, known) < kClearly) return;
  Report(estimate, "llm-turned", core::Severity::kInfo,
         "length, width and height of the answer fit in another order", 0.0);
  answer->length = best[0];
  answer->width = best[1];
  answer->height = best[2];
}

// Returns the mass over the bounding box, kg/m^3.
double MiddleDensity(const ObjectAnswer& answer) {
  return Middle(*answer.mass) /
         (Middle(*answer.length) * Middle(*answer.width) * Middle(*answer.height));
}

bool IsWhole(const ObjectAnswer& answer) {
  return answer.mass && answer.length && answer.width && answer.height;
}

// Returns the base's materials that `words` name, the longest names first ("cast iron" before
// "iron").
std::vector<std::string> MaterialsIn(const std::string& words, const KnowledgeBase& base) {
  static constexpr std::array<std::array<const char*, 2>, 14> kOtherNames = {
      {{"wooden", "wood"},
       {"aluminum", "aluminium"},
       {"metal", "steel"},
       {"stoneware", "ceramic"},
       {"terracotta", "earthenware"},
       {"polypropylene", "plastic"},
       {"polyethylene", "plastic"},
       {"styrofoam", "foam plastic"},
       {"fabric", "textile"},
       {"cloth", "textile"},
       {"fruit", "fruit flesh"},
       {"vegetables", "vegetable"},
       {"marble", "stone"},
       {"granite", "stone"}}};
  std::string left = " " + NormaliseName(words) + " ";
  std::replace_if(
      left.begin(), left.end(), [](char c) { return c == ',' || c == '/' || c == ';' || c == '.'; },
      ' ');
  std::vector<std::pair<std::string, std::string>> names;  // as stated -> as known
  for (const Material& material : base.materials())
    names.emplace_back(material.name, material.name);
  for (const auto& [said, known] : kOtherNames) {
    if (base.FindMaterial(known) != nullptr) names.emplace_back(said, known);
  }
  std::stable_sort(names.begin(), names.end(),
                   [](const auto& a, const auto& b) { return a.first.size() > b.first.size(); });
  std::vector<std::pair<std::size_t, std::string>> found;  // by position
  for (const auto& [said, known] : names) {
    const std::size_t at = left.find(" " + said + " ");
    if (at == std::string::npos) continue;
    std::fill_n(left.begin() + static_cast<std::ptrdiff_t>(at) + 1, said.size(), '#');
    found.emplace_back(at, known);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> materials;
  for (const auto& [at, known] : found) {
    if (std::find(materials.begin(), materials.end(), known) == materials.end()) {
      materials.push_back(known);
    }
  }
  return materials;
}

// Moves the materials that both know to the front, in the model's order.
void PreferMaterials(const std::vector<std::string>& said, Category* category) {
  std::stable_sort(category->materials.begin(), category->materials.end(),
                   [&](const std::string& a, const std::string& b) {
                     return std::find(said.begin(), said.end(), a) <
                            std::find(said.begin(), said.end(), b);
                   });
}

// Drops a mass that the answer's own sizes contradict.
void CheckMass(const Category& category, const KnowledgeBase& base, ObjectAnswer* answer,
               EstimatedCategory* estimate) {
  if (!IsWhole(*answer)) return;
  double densest = 0.0;
  for (const std::string& name : category.materials) {
    densest = std::max(densest, base.FindMaterial(name)->density.max);
  }
  const double density = MiddleDensity(*answer);
  if (density >= kLightest && density <= kRounding * densest) return;
  char text[120];
  std::snprintf(text, sizeof(text),
                "the answer's mass over its sizes gives %.3g kg/m3, which no %s has", density,
                category.name.c_str());
  Report(estimate, "llm-density", core::Severity::kWarning, text, density);
  answer->mass.reset();
}

// Makes length the longer horizontal side.
void OrderSides(EstimatedCategory* estimate) {
  Category& category = estimate->category;
  if (Middle(category.length) >= Middle(category.width)) return;
  std::swap(category.length, category.width);
  std::swap(estimate->length_source, estimate->width_source);
}

// Throws core::Error unless sizes and mass are possible. Returns the density over the bounding box.
double RequirePlausible(const Category& category, const ObjectAnswer& answer,
                        const std::string& where, const char* remedy) {
  for (const Interval& side : {category.length, category.width, category.height}) {
    if (side.min < kSmallest || side.max > kLargest) {
      throw core::Error(
          "a size of " + Text(side, 1e-2, "cm") + " is not that of a household object", where,
          remedy);
    }
  }
  const double density = MiddleDensity(answer);
  if (!(density >= kLightest && density <= kHeaviest)) {
    char text[120];
    std::snprintf(text, sizeof(text),
                  "its mass over its sizes gives %.3g kg/m3, outside %.0f to %.0f", density,
                  kLightest, kHeaviest);
    throw core::Error(text, where, remedy);
  }
  return density;
}

// Returns the stated materials that are dense enough, else the lightest of all that are: the
// weakest assumption. Empty if there is none.
std::vector<std::string> ChooseMaterials(const std::string& words, double density,
                                         const KnowledgeBase& base, EstimatedCategory* estimate) {
  std::vector<std::string> chosen;
  for (const std::string& material : MaterialsIn(words, base)) {
    if (density <= kRounding * base.FindMaterial(material)->density.max) {
      chosen.push_back(material);
    } else {
      Report(estimate, "llm-density", core::Severity::kWarning,
             "it is too heavy for its size to be made of " + material, density);
    }
  }
  if (!chosen.empty()) return chosen;
  constexpr double kFirm = 400.0;  // kg/m^3; foams and textiles are never guessed
  const Material* fitting = nullptr;
  for (const Material& material : base.materials()) {
    if (material.density.max * kRounding < density || material.density.min < kFirm) continue;
    if (fitting == nullptr || material.density.max < fitting->density.max) fitting = &material;
  }
  if (fitting != nullptr) chosen.push_back(fitting->name);
  return chosen;
}

}  // namespace

EstimatedCategory ReconcileAnswer(const Resolution& known, const ObjectAnswer& said,
                                  const KnowledgeBase& base, const std::string& model) {
  EstimatedCategory estimate;
  estimate.category = *known.category;
  estimate.resolution = known.sentence;
  Category& category = estimate.category;
  estimate.length_source = estimate.width_source = estimate.height_source = estimate.mass_source =
      category.source;
  ObjectAnswer answer = said;
  PermuteSides(*known.category, &answer, &estimate);
  CheckMass(category, base, &answer, &estimate);
  const auto side = [&](const char* name) {
    return ReconciledQuantity{name, 1e-2, "cm", kSizeTolerance};
  };
  Join(side("a length"), answer.length, known.exact, model, &category.length,
       &estimate.length_source, &estimate);
  Join(side("a width"), answer.width, known.exact, model, &category.width, &estimate.width_source,
       &estimate);
  Join(side("a height"), answer.height, known.exact, model, &category.height,
       &estimate.height_source, &estimate);
  Join({"a mass", 1e-3, "g", kMassTolerance}, answer.mass, known.exact, model, &category.mass,
       &estimate.mass_source, &estimate);
  OrderSides(&estimate);
  PreferMaterials(MaterialsIn(answer.material, base), &category);
  return estimate;
}

EstimatedCategory CategoryFromAnswer(const std::string& name, const ObjectAnswer& answer,
                                     const KnowledgeBase& base, const std::string& model) {
  const std::string where = "'" + name + "', as " + model + " describes it";
  const char* const remedy = "name a known category with --category, or ask another model";
  if (!IsWhole(answer)) {
    throw core::Error("the answer lacks its mass or one of its sizes", where, remedy);
  }
  EstimatedCategory estimate;
  Category& category = estimate.category;
  category.name = NormaliseName(name);
  category.length = Spread(*answer.length);
  category.width = Spread(*answer.width);
  category.height = Spread(*answer.height);
  category.mass = Spread(*answer.mass);
  OrderSides(&estimate);
  const double density = RequirePlausible(category, answer, where, remedy);
  category.materials = ChooseMaterials(answer.material, density, base, &estimate);
  if (category.materials.empty()) {
    throw core::Error("no known material is as dense as it", where, remedy);
  }
  double densest = 0.0;
  for (const std::string& material : category.materials) {
    densest = std::max(densest, base.FindMaterial(material)->density.max);
  }
  // A solid ball fills half of its box, a bowl a few hundredths; stated ranges are mostly wide.
  category.fill = density > 0.2 * densest ? Fill::kSolid : Fill::kHollow;
  category.shape = Shape::kFree;
  category.source = "estimated by " + model + ", within plausible densities";
  estimate.length_source = estimate.width_source = estimate.height_source = estimate.mass_source =
      category.source;
  estimate.resolution = "'" + category.name +
                        "' is not in the knowledge base, nor a related category; " + model +
                        " was asked";
  return estimate;
}

PhysicalParameters SampleEstimate(const EstimatedCategory& estimate, const KnowledgeBase& base,
                                  std::uint64_t seed) {
  PhysicalParameters parameters = SampleParameters(estimate.category, base, seed);
  parameters.resolution = estimate.resolution;
  parameters.length.source = estimate.length_source;
  parameters.width.source = estimate.width_source;
  parameters.height.source = estimate.height_source;
  parameters.mass.source = estimate.mass_source;
  return parameters;
}

}  // namespace simwright::physics_params
