#pragma once

#include <string>
#include <vector>

#include "scene/grammar/grammar.h"

namespace simwright::scene {

// The left side of a production: the symbol itself.
struct Head {
  std::string name;
  std::string category;
  bool welded = false;
  bool surface = false;

  // Constructs a group: a symbol without an object.
  Head(const char* group) : name(group) {}             // NOLINT: written as a plain string
  Head(std::string group) : name(std::move(group)) {}  // NOLINT
  Head(std::string symbol, std::string object_slot, bool is_welded)
      : name(std::move(symbol)), category(std::move(object_slot)), welded(is_welded) {}
};
Head Object(const std::string& symbol, const std::string& category);
Head Welded(const std::string& symbol, const std::string& category);
// Returns a group whose frame is a support surface at z = 0.
Head Surface(const std::string& symbol);

// The right side of a production: a symbol by name, its pose rule, and its weight or probability.
struct Child {
  std::string symbol;
  PoseRule pose;
  double weight = 1.0;
};
Child Always(const std::string& symbol, const PoseRule& pose = SamePose());
Child With(double weight, const std::string& symbol, const PoseRule& pose = SamePose());

// The empty symbol, defined in every grammar.
inline constexpr char kNothing[] = "nothing";

// Builds a grammar production by production; names may be used before they are defined, so that a
// symbol may derive itself.
class GrammarBuilder {
 public:
  // `start` is the symbol of the root of every derivation.
  GrammarBuilder(std::string name, std::string start);

  GrammarBuilder& Leaf(const Head& head);
  GrammarBuilder& And(const Head& head, const std::vector<Child>& children);
  GrammarBuilder& Or(const Head& head, const std::vector<Child>& choices);
  GrammarBuilder& Independent(const Head& head, const std::vector<Child>& children);
  // `count_weights`: weights of k = 0, 1, ..., from GeometricWeights or any others.
  GrammarBuilder& Repeat(const Head& head, const std::vector<double>& count_weights,
                         const Child& child);

  GrammarBuilder& Require(const StructureConstraint& constraint);
  GrammarBuilder& Require(const KeepOut& constraint);
  GrammarBuilder& Require(const InsideRim& constraint);
  GrammarBuilder& Options(const GrammarSampleOptions& options);

  // Builds the grammar. Throws core::Error, naming the symbol, for: a symbol defined twice, used
  // but not defined, or never used; an Or without weight, a probability outside [0, 1], a count
  // without weight; an invalid pose rule; a constraint on an unknown symbol or category, or with an
  // impossible number; invalid options; a grammar without an object.
  Grammar Build() const;

 private:
  struct Production {
    Head head;
    NodeKind kind;
    std::vector<Child> children;
    std::vector<double> count_weights;
  };

  GrammarBuilder& Add(Production production);
  void Resolve(Grammar* grammar) const;
  [[noreturn]] void Fail(const std::string& what, const std::string& symbol) const;
  void CheckProduction(const Production& production) const;
  void CheckReachable(const Grammar& grammar) const;
  void CheckStructure(const Grammar& grammar) const;
  void CheckPoseConstraints(const Grammar& grammar) const;

  std::string name_;
  std::string start_;
  std::vector<Production> productions_;
  std::vector<StructureConstraint> structure_;
  std::vector<KeepOut> keep_outs_;
  std::vector<InsideRim> rims_;
  GrammarSampleOptions options_;
};

}  // namespace simwright::scene
