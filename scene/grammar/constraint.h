#pragma once

#include <string>
#include <vector>

namespace simwright::scene {

// On what a derivation consists of; decided by rejection. Welded furniture is no object, but is an
// entry of the scene. A stack: objects of one slot, each standing on the one before; what stands
// on top of another slot (a lid) does not count.
enum class StructureKind {
  kSlotAtLeast,     // n objects of `slot`
  kSlotAtMost,      //
  kObjectsAtLeast,  // n objects
  kEntriesAtMost,   // n entries, welded ones included: the length of a learned scene
  kTallestAtLeast,  // the tallest stack of `slot` has n members
  kTallestAtMost,   //
  kStacksAtLeast,   // n stacks of `slot`
};

struct StructureConstraint {
  StructureKind kind;
  int n = 0;
  std::string slot;    // empty where the kind names none
  std::string within;  // a symbol: only what was derived from it counts; empty: everything

  // "at least 3 stacks of steamer": what an error calls it.
  std::string Describe() const;
};

StructureConstraint SlotAtLeast(const std::string& slot, int n);
StructureConstraint SlotAtMost(const std::string& slot, int n);
StructureConstraint ObjectsAtLeast(int n, const std::string& within = "");
StructureConstraint EntriesAtMost(int n);
StructureConstraint TallestStackAtLeast(const std::string& slot, int n);
StructureConstraint TallestStackAtMost(const std::string& slot, int n);
StructureConstraint StacksAtLeast(const std::string& slot, int n);

// How a constraint on poses is met: by drawing anew the poses of what violates it, or by throwing
// the derivation away, which favours derivations with room (the paper does both).
enum class Decision { kRedraw, kReject };

struct KeepOutBody {
  std::string symbol;
  double radius = 0.0;  // m
};

// Objects that stand on one surface, not on each other, are at least the sum of their radii apart,
// measured between their origins across the surface.
struct KeepOut {
  std::string name;
  std::vector<KeepOutBody> bodies;
  // Where given, only pairs with one of these symbols count.
  std::vector<std::string> against;
  // Where given, a pair derived from the same one of these symbols does not count.
  std::string exempt_within;
  Decision decision = Decision::kRedraw;
};

// Origins of the objects that stand on the surface, not on each other, lie within its rim by
// `margin` (m).
struct InsideRim {
  std::string surface;               // symbol
  std::vector<std::string> symbols;  // objects that it is asked of; empty: all
  bool round = false;                // a disc of radius half_x, else a rectangle
  double half_x = 0.0;
  double half_y = 0.0;
  double margin = 0.0;
  Decision decision = Decision::kRedraw;

  std::string Describe() const;
};

}  // namespace simwright::scene
