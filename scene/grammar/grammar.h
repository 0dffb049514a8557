#pragma once

#include <string>
#include <vector>

#include "scene/grammar/constraint.h"
#include "scene/grammar/pose_rule.h"

namespace simwright::scene {

// How hard DrawScene tries. A try: derivations until one meets what is decided by rejection, then
// draws of its poses until they meet the rest (Pfaff et al., appendix: 1000 derivations, 5000 for
// the restaurant and the pantry; 25 draws).
struct DrawOptions {
  int derivations = 1000;  // a try, at most
  int pose_draws = 25;     // a try, at most; each goes once over all objects that violate something
  int proposals = 8;       // an object and draw
  double temperature = 0.01;  // m of violation that a proposal may add with probability 1/e
  int tries = 100;

  bool IsValid(std::string* error) const;
};

enum class NodeKind {
  kLeaf,         // no children
  kAnd,          // all children
  kOr,           // one child, by its share of the weights
  kIndependent,  // each child with its own probability
  kRepeat,       // the one child, k times, by the weight of k
};

struct Branch {
  int symbol = -1;      // index into Grammar::symbols()
  double weight = 1.0;  // kOr: share; kIndependent: probability
  PoseRule pose;
};

struct Symbol {
  std::string name;
  NodeKind kind = NodeKind::kLeaf;
  std::vector<Branch> branches;
  std::vector<double> count_weights;  // kRepeat: of k = 0, 1, ...
  std::string slot;                   // the asset slot of the object that it is; empty: none
  bool welded = false;                // furniture, fixed in physics
  bool surface = false;               // its frame is a surface's: z = 0 is where things stand

  bool IsObject() const { return !slot.empty(); }
};

// Weights of k = 0 .. last of the geometric count G(p, .) ~ (1 - p)^(k - first) p for
// k = first .. last, 0 below; not normalised. Throws core::Error unless 0 < p <= 1 and
// 0 <= first <= last.
std::vector<double> GeometricWeights(double p, int first, int last);

// A scene grammar as a constant value: symbols, from symbol 0, and constraints on what is derived.
class Grammar {
 public:
  const std::string& name() const { return name_; }
  const std::vector<Symbol>& symbols() const { return symbols_; }
  const std::vector<StructureConstraint>& structure() const { return structure_; }
  const std::vector<KeepOut>& keep_outs() const { return keep_outs_; }
  const std::vector<InsideRim>& rims() const { return rims_; }
  const DrawOptions& options() const { return options_; }

  // The least of its EntriesAtMost; 0 where it has none.
  int MostEntries() const;
  // Every slot that its symbols stand for, furniture among them; sorted, each once.
  std::vector<std::string> Slots() const;

  // Index of a symbol, -1 for an unknown one.
  int Find(const std::string& symbol) const;
  // With other options. Throws core::Error for invalid ones.
  Grammar WithOptions(const DrawOptions& options) const;

 private:
  friend class GrammarBuilder;
  std::string name_;
  std::vector<Symbol> symbols_;
  std::vector<StructureConstraint> structure_;
  std::vector<KeepOut> keep_outs_;
  std::vector<InsideRim> rims_;
  DrawOptions options_;
};

}  // namespace simwright::scene
