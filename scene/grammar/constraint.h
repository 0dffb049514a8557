#pragma once

#include <string>
#include <vector>

namespace simwright::scene {

// Constraints on the contents of a derivation, enforced by rejection. Welded furniture does not
// count as an object, but as an entry of the scene. A stack is a sequence of objects of one
// category, each on top of the previous one; an object on top of another category (a lid) does not
// count.
enum class StructureKind {
  kCategoryAtLeast,  // n objects of `category`
  kCategoryAtMost,   //
  kObjectsAtLeast,   // n objects
  kEntriesAtMost,    // n entries, welded ones included: the length of a learned scene
  kTallestAtLeast,   // the tallest stack of `category` has n members
  kTallestAtMost,    //
  kStacksAtLeast,    // n stacks of `category`
};

struct StructureConstraint {
  StructureKind kind;
  int n = 0;
  std::string category;  // empty if the kind needs none
  std::string within;    // a symbol: only its derivation counts; empty: the whole scene

  // Returns the constraint in words, for errors: "at least 3 stacks of steamer".
  std::string Describe() const;
};

StructureConstraint CategoryAtLeast(const std::string& category, int n);
StructureConstraint CategoryAtMost(const std::string& category, int n);
StructureConstraint ObjectsAtLeast(int n, const std::string& within = "");
StructureConstraint EntriesAtMost(int n);
StructureConstraint TallestStackAtLeast(const std::string& category, int n);
StructureConstraint TallestStackAtMost(const std::string& category, int n);
StructureConstraint StacksAtLeast(const std::string& category, int n);

// The enforcement of a constraint on poses: resampling the poses that violate it, or rejecting the
// derivation, which favours derivations with free space (the paper does both).
enum class Decision { kResample, kReject };

struct KeepOutBody {
  std::string symbol;
  double radius = 0.0;  // m
};

// A minimum distance between objects on one surface (not stacked on each other): the sum of their
// radii, measured between their origins in the plane of the surface.
struct KeepOut {
  std::string name;
  std::vector<KeepOutBody> bodies;
  // If not empty, only pairs with one of these symbols count.
  std::vector<std::string> against;
  // If not empty, pairs derived from the same instance of this symbol are exempt.
  std::string exempt_within;
  Decision decision = Decision::kResample;
};

// A rim: the origins of the objects on the surface (not stacked on each other) lie at least
// `margin` (m) inside it.
struct InsideRim {
  std::string surface;               // symbol
  std::vector<std::string> symbols;  // the objects it applies to; empty: all
  bool round = false;                // a disc of radius half_x, else a rectangle
  double half_x = 0.0;
  double half_y = 0.0;
  double margin = 0.0;
  Decision decision = Decision::kResample;

  std::string Describe() const;
};

}  // namespace simwright::scene
