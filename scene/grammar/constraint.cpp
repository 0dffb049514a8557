#include "scene/grammar/constraint.h"

namespace simwright::scene {

std::string StructureConstraint::Describe() const {
  const std::string count = std::to_string(n);
  const std::string place = within.empty() ? "" : " within " + within;
  switch (kind) {
    case StructureKind::kCategoryAtLeast:
      return "at least " + count + " of " + category + place;
    case StructureKind::kCategoryAtMost:
      return "at most " + count + " of " + category + place;
    case StructureKind::kObjectsAtLeast:
      return "at least " + count + " objects" + place;
    case StructureKind::kEntriesAtMost:
      return "at most " + count + " entries" + place;
    case StructureKind::kTallestAtLeast:
      return "tallest stack of " + category + " at least " + count + place;
    case StructureKind::kTallestAtMost:
      return "tallest stack of " + category + " at most " + count + place;
    case StructureKind::kStacksAtLeast:
      return "at least " + count + " stacks of " + category + place;
  }
  return "";
}

StructureConstraint CategoryAtLeast(const std::string& category, int n) {
  return {StructureKind::kCategoryAtLeast, n, category, ""};
}
StructureConstraint CategoryAtMost(const std::string& category, int n) {
  return {StructureKind::kCategoryAtMost, n, category, ""};
}
StructureConstraint ObjectsAtLeast(int n, const std::string& within) {
  return {StructureKind::kObjectsAtLeast, n, "", within};
}
StructureConstraint EntriesAtMost(int n) {
  return {StructureKind::kEntriesAtMost, n, "", ""};
}
StructureConstraint TallestStackAtLeast(const std::string& category, int n) {
  return {StructureKind::kTallestAtLeast, n, category, ""};
}
StructureConstraint TallestStackAtMost(const std::string& category, int n) {
  return {StructureKind::kTallestAtMost, n, category, ""};
}
StructureConstraint StacksAtLeast(const std::string& category, int n) {
  return {StructureKind::kStacksAtLeast, n, category, ""};
}

std::string InsideRim::Describe() const {
  return "inside the rim of " + surface;
}

}  // namespace simwright::scene
