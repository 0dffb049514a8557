#include "scene/grammar/constraint.h"

namespace simwright::scene {

std::string StructureConstraint::Describe() const {
  const std::string count = std::to_string(n);
  const std::string place = within.empty() ? "" : " within " + within;
  switch (kind) {
    case StructureKind::kSlotAtLeast:
      return "at least " + count + " of " + slot + place;
    case StructureKind::kSlotAtMost:
      return "at most " + count + " of " + slot + place;
    case StructureKind::kObjectsAtLeast:
      return "at least " + count + " objects" + place;
    case StructureKind::kEntriesAtMost:
      return "at most " + count + " entries" + place;
    case StructureKind::kTallestAtLeast:
      return "tallest stack of " + slot + " at least " + count + place;
    case StructureKind::kTallestAtMost:
      return "tallest stack of " + slot + " at most " + count + place;
    case StructureKind::kStacksAtLeast:
      return "at least " + count + " stacks of " + slot + place;
  }
  return "";
}

StructureConstraint SlotAtLeast(const std::string& slot, int n) {
  return {StructureKind::kSlotAtLeast, n, slot, ""};
}
StructureConstraint SlotAtMost(const std::string& slot, int n) {
  return {StructureKind::kSlotAtMost, n, slot, ""};
}
StructureConstraint ObjectsAtLeast(int n, const std::string& within) {
  return {StructureKind::kObjectsAtLeast, n, "", within};
}
StructureConstraint EntriesAtMost(int n) {
  return {StructureKind::kEntriesAtMost, n, "", ""};
}
StructureConstraint TallestStackAtLeast(const std::string& slot, int n) {
  return {StructureKind::kTallestAtLeast, n, slot, ""};
}
StructureConstraint TallestStackAtMost(const std::string& slot, int n) {
  return {StructureKind::kTallestAtMost, n, slot, ""};
}
StructureConstraint StacksAtLeast(const std::string& slot, int n) {
  return {StructureKind::kStacksAtLeast, n, slot, ""};
}

std::string InsideRim::Describe() const {
  return "inside the rim of " + surface;
}

}  // namespace simwright::scene
