#include "importers/import_category.h"

#include <algorithm>
#include <cctype>

namespace simwright::importers {
namespace {

// Names of PartNet-Mobility's categories (Xiang et al. 2020, "SAPIEN", table of categories) that
// are written without spaces or mean something else here.
constexpr struct {
  const char* partnet;
  const char* category;
} kPartnetNames[] = {{"coffeemachine", "coffee maker"},
                     {"dispenser", "soap dispenser"},
                     {"display", "monitor"},
                     {"eyeglasses", "glasses"},
                     {"foldingchair", "folding chair"},
                     {"kitchenpot", "pot"},
                     {"mouse", "computer mouse"},
                     {"remote", "remote control"},
                     {"storagefurniture", "cabinet"},
                     {"trashcan", "trash can"},
                     {"washingmachine", "washing machine"}};

// Strips a unit from the end of a file's name: "mug_cm" is a mug.
std::string WithoutUnit(std::string name) {
  for (const char* unit : {"mm", "cm", "meters", "metres", "inches", "inch"}) {
    const std::string ending = unit;
    if (name.size() <= ending.size() + 1 || !name.ends_with(ending)) continue;
    const char before = name[name.size() - ending.size() - 1];
    if (before != '_' && before != '-' && before != ' ') continue;
    name.resize(name.size() - ending.size() - 1);
    break;
  }
  return name;
}

}  // namespace

physics_params::Resolution ImportCategory(const std::string& wanted, const std::string& name) {
  if (!wanted.empty()) return physics_params::RequireCategory(wanted);
  std::string known = name;
  std::transform(known.begin(), known.end(), known.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  known = WithoutUnit(known);
  for (const auto& row : kPartnetNames) {
    if (known == row.partnet) known = row.category;
  }
  const auto& base = physics_params::KnowledgeBase::Shipped();
  physics_params::Resolution found =
      physics_params::ResolveCategory(known, base, physics_params::WordNet::Installed());
  if (found.category == nullptr) {
    found.category = base.FindCategory("object");
    found.sentence += "; treated as a plastic or wooden object: give --category for a better mass";
  }
  return found;
}

}  // namespace simwright::importers
