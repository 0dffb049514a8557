#pragma once

#include <string>
#include <vector>

#include "scene/grammar/constraint.h"
#include "scene/grammar/pose_rule.h"

namespace simwright::scene {

// The search limits of SampleGrammar. One try samples derivations until one satisfies the
// constraints that are enforced by rejection, then samples poses until they satisfy the others
// (Pfaff et al., appendix: 1000 derivations, 5000 for the restaurant and the pantry; 25 pose
// samples).
struct GrammarSampleOptions {
  int derivations = 1000;     // per try, at most
  int pose_draws = 25;        // per try, at most; each visits every violating object once
  int proposals = 8;          // per object and pose sample
  double temperature = 0.01;  // m, added violation that is accepted with probability 1/e
  int tries = 100;

  bool IsValid(std::string* error) const;
};

enum class NodeKind {
  kLeaf,         // no children
  kAnd,          // all children
  kOr,           // one child, with probability proportional to its weight
  kIndependent,  // each child with its own probability
  kRepeat,       // its child, k times, k sampled by weight
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
  std::string category;               // the category of its object; empty: no object
  bool welded = false;                // furniture, fixed in physics
  bool surface = false;               // its frame is a support surface: objects stand at z = 0

  bool IsObject() const { return !category.empty(); }
};

// Returns the weights of k = 0 .. last of the geometric count G(p, .) ~ (1 - p)^(k - first) p for k
// = first .. last, 0 below; not normalized. Throws core::Error unless 0 < p <= 1 and 0 <= first <=
// last.
std::vector<double> GeometricWeights(double p, int first, int last);

// An immutable scene grammar: symbols, of which symbol 0 is the start, and constraints on the
// derivations.
class Grammar {
 public:
  const std::string& name() const { return name_; }
  const std::vector<Symbol>& symbols() const { return symbols_; }
  const std::vector<StructureConstraint>& structure() const { return structure_; }
  const std::vector<KeepOut>& keep_outs() const { return keep_outs_; }
  const std::vector<InsideRim>& rims() const { return rims_; }
  const GrammarSampleOptions& options() const { return options_; }

  // Returns the smallest bound of its EntriesAtMost constraints; 0 if it has none.
  int MaxEntries() const;
  // Returns all categories of its symbols, furniture included; sorted and unique.
  std::vector<std::string> Categories() const;

  // Returns the index of a symbol; -1 for an unknown one.
  int Find(const std::string& symbol) const;
  // Returns a copy with other options. Throws core::Error for invalid ones.
  Grammar WithOptions(const GrammarSampleOptions& options) const;

 private:
  friend class GrammarBuilder;
  std::string name_;
  std::vector<Symbol> symbols_;
  std::vector<StructureConstraint> structure_;
  std::vector<KeepOut> keep_outs_;
  std::vector<InsideRim> rims_;
  GrammarSampleOptions options_;
};

}  // namespace simwright::scene
