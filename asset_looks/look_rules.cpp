#include "asset_looks/look_rules.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <optional>

#include "texture/materials/named_materials.h"

namespace simwright::asset_looks {
namespace {

bool IsOneOf(const std::string& word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* one) { return word == one; });
}

std::string LastWord(const std::string& words) {
  const std::size_t space = words.rfind(' ');
  return space == std::string::npos ? words : words.substr(space + 1);
}

std::string DrawnOf(std::initializer_list<const char*> names, core::Rng* rng) {
  return *(names.begin() + core::UniformIndex(*rng, static_cast<std::int64_t>(names.size())));
}

std::string DrawnWood(core::Rng* rng) {
  return DrawnOf(
      {"oak", "walnut", "beech", "pine", "maple", "cherry", "birch", "ash", "acacia", "teak"}, rng);
}

bool IsWood(const std::string& name) {
  return IsOneOf(name, {"wood", "oak", "walnut", "beech", "pine", "maple", "cherry", "birch", "ash",
                        "acacia", "teak", "mahogany", "plywood", "veneer"});
}

// Returns what a name in a file stands for, beside materials.
std::string MaterialOfRole(const std::string& name, const LookSlot& slot) {
  // The prints of a wooden toy are its paint.
  if (name == "print" && slot.substance == "wood") return "toy paint";
  static const struct {
    const char* role;
    const char* material;
  } kRoles[] = {{"print", "print"},         {"label", "print"},
                {"wrapper", "print"},       {"sleeve", "print"},
                {"cap", "plastic"},         {"case", "plastic"},
                {"grip", "black plastic"},  {"barrel", "plastic"},
                {"plate", "black plastic"}, {"touchpad", "black plastic"},
                {"slot", "black plastic"},  {"wick", "black plastic"},
                {"dark", "black plastic"},  {"cone", "black plastic"},
                {"surround", "rubber"},     {"pages", "paper"},
                {"carton", "paper"},        {"lens", "glass"},
                {"shade", "linen"},         {"rod", "brass"},
                {"front", "fabric"},        {"hoop", "bamboo"},
                {"core", "cardboard"},      {"crust", "bread"},
                {"shell", "egg"},           {"ripe", "avocado"},
                {"tea", "brown glass"},     {"seat", "upholstery"},
                {"cushion", "upholstery"},  {"mirror", "chrome"},
                {"coffee", "chocolate"},    {"leaf", "plant"},
                {"leaves", "plant"}};
  for (const auto& row : kRoles) {
    if (name == row.role) return row.material;
  }
  if (name == "board") return slot.substance == "wood" ? "wood" : "cardboard";
  if (name == "enamel") return "appliance";
  if (name == "moulding") return "paint";
  if (name == "lid" && !IsOneOf(slot.substance, {"ceramic", "porcelain", "bamboo", "wood"})) {
    return "plastic";
  }
  return "";
}

std::string MaterialOfSubstance(const LookSlot& slot, core::Rng* rng) {
  const std::string& name = slot.substance;
  if (name == "wood") return DrawnWood(rng);
  if (name == "plywood") return DrawnOf({"oak", "walnut", "birch", "paint", "plywood", "ash"}, rng);
  if (name == "liquid in plastic" || name == "food" || name == "liquid in steel") return "print";
  if (name == "liquid in glass") return DrawnOf({"brown glass", "green glass", "glass"}, rng);
  if (name == "foam plastic") return "foam";
  if (name == "textile") return "fabric";
  if (name == "dairy") return "cheese";
  return texture::IsNamedMaterial(name) ? name : "plastic";
}

// Handles and fittings come in several metals.
std::string DrawnMetal(const std::string& stated, core::Rng* rng) {
  if (core::Uniform(*rng) < 0.5) return stated;
  return DrawnOf({"brass", "stainless steel", "iron", "chrome", "copper", "aluminium"}, rng);
}

bool IsByCategory(const std::string& substance) {
  return IsOneOf(substance, {"fruit flesh", "vegetable", "bread", "dairy", "meat", "rubber",
                             "leather", "wax", "soap", "plant"});
}

std::string StatedMaterial(const std::string& name, const LookSlot& slot, core::Rng* rng) {
  const std::string last = LastWord(name);
  for (const std::string& word : {name, last}) {
    if (word.empty()) continue;
    if (IsWood(word)) {
      // A piece of furniture is of another wood in the next variant.
      return word != "wood" && word != "veneer" && core::Uniform(*rng) < 0.4 ? word
                                                                             : DrawnWood(rng);
    }
    if (const std::string role = MaterialOfRole(word, slot); !role.empty()) {
      return role == "wood" ? DrawnWood(rng) : role;
    }
    if (IsOneOf(word, {"brass", "brushed steel", "chrome"}) && slot.IsFitting()) {
      return DrawnMetal(word == "brushed steel" ? "steel" : word, rng);
    }
    if (texture::IsNamedMaterial(word) && !texture::NamedColor(word)) return word;
  }
  return "";
}

}  // namespace

bool LookSlot::IsFitting() const {
  return IsOneOf(part, {"handle", "knob", "button", "lever", "switch", "screen", "keyboard",
                        "hinge", "wheel", "key", "label"}) ||
         IsOneOf(material,
                 {"print", "label", "screen", "lens", "grip", "wick", "cap", "clear glass",
                  "dark glass", "black plastic", "brass", "brushed steel"});
}

std::string PlainWords(const std::string& name) {
  std::string words;
  for (const char c : name) {
    const bool separates = c == '_' || c == '-' || c == '.' || c == ' ';
    if (separates && (words.empty() || words.back() == ' ')) continue;
    words += separates ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  while (!words.empty() &&
         (words.back() == ' ' || std::isdigit(static_cast<unsigned char>(words.back())))) {
    words.pop_back();
  }
  return words;
}

std::string MaterialByRule(const LookSlot& slot, const std::string& category, core::Rng* rng) {
  const std::string kind = LastWord(category);
  if (IsByCategory(slot.substance) || kind == "egg") {
    for (const std::string& name : {category, kind}) {
      if (texture::IsNamedMaterial(name)) return name;
    }
  }
  const std::string stated = StatedMaterial(slot.material, slot, rng);
  if (!stated.empty()) return stated;
  return MaterialOfSubstance(slot, rng);
}

std::string PrintTitle(const std::string& category, core::Rng* rng) {
  static const char* const kBrands[] = {"SOLARA", "NORDHUS", "VERDE",  "ALDER & CO", "MONTE ROSA",
                                        "KIRSCH", "HARVEST", "LUMINA", "OLD MILL",   "BRIO"};
  std::string title;
  for (std::size_t at = 0; at < category.size();) {
    const std::size_t space = std::min(category.find(' ', at), category.size());
    const std::string word = category.substr(at, space - at);
    if (!IsOneOf(word,
                 {"box", "carton", "can", "bottle", "jar", "bag", "tin", "large", "small", "object",
                  "packet", "tube", "toy", "block", "book", "mug", "cup", "bowl", "plate"})) {
      title += (title.empty() ? "" : " ") + word;
    }
    at = space + 1;
  }
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (!title.empty()) return title;
  return kBrands[core::UniformIndex(*rng, static_cast<std::int64_t>(std::size(kBrands)))];
}

}  // namespace simwright::asset_looks
