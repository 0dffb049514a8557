#include "scene/grammar/grammar_builder.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::scene {

Head Object(const std::string& symbol, const std::string& category) {
  return Head(symbol, category, /*is_welded=*/false);
}
Head Welded(const std::string& symbol, const std::string& category) {
  return Head(symbol, category, /*is_welded=*/true);
}
Head Surface(const std::string& symbol) {
  Head head(symbol);
  head.surface = true;
  return head;
}

Child Always(const std::string& symbol, const PoseRule& pose) {
  return {symbol, pose, 1.0};
}
Child With(double weight, const std::string& symbol, const PoseRule& pose) {
  return {symbol, pose, weight};
}

GrammarBuilder::GrammarBuilder(std::string name, std::string start)
    : name_(std::move(name)), start_(std::move(start)) {}

GrammarBuilder& GrammarBuilder::Add(Production production) {
  productions_.push_back(std::move(production));
  return *this;
}
GrammarBuilder& GrammarBuilder::Leaf(const Head& head) {
  return Add({head, NodeKind::kLeaf, {}, {}});
}
GrammarBuilder& GrammarBuilder::And(const Head& head, const std::vector<Child>& children) {
  return Add({head, NodeKind::kAnd, children, {}});
}
GrammarBuilder& GrammarBuilder::Or(const Head& head, const std::vector<Child>& choices) {
  return Add({head, NodeKind::kOr, choices, {}});
}
GrammarBuilder& GrammarBuilder::Independent(const Head& head, const std::vector<Child>& children) {
  return Add({head, NodeKind::kIndependent, children, {}});
}
GrammarBuilder& GrammarBuilder::Repeat(const Head& head, const std::vector<double>& count_weights,
                                       const Child& child) {
  return Add({head, NodeKind::kRepeat, {child}, count_weights});
}
GrammarBuilder& GrammarBuilder::Require(const StructureConstraint& constraint) {
  structure_.push_back(constraint);
  return *this;
}
GrammarBuilder& GrammarBuilder::Require(const KeepOut& constraint) {
  keep_outs_.push_back(constraint);
  return *this;
}
GrammarBuilder& GrammarBuilder::Require(const InsideRim& constraint) {
  rims_.push_back(constraint);
  return *this;
}
GrammarBuilder& GrammarBuilder::Options(const GrammarSampleOptions& options) {
  options_ = options;
  return *this;
}

void GrammarBuilder::Fail(const std::string& what, const std::string& symbol) const {
  throw core::Error(what, "scene grammar " + name_ + (symbol.empty() ? "" : ", " + symbol));
}

void GrammarBuilder::CheckProduction(const Production& production) const {
  const std::string& name = production.head.name;
  if (production.kind != NodeKind::kLeaf && production.children.empty()) {
    Fail("it derives nothing: declare it as a leaf", name);
  }
  double total = 0.0;
  for (const Child& child : production.children) {
    std::string error;
    if (!child.pose.IsValid(&error)) Fail(error, name + " -> " + child.symbol);
    const bool negative = !(child.weight >= 0.0) || !std::isfinite(child.weight);
    if (negative || (production.kind == NodeKind::kIndependent && child.weight > 1.0)) {
      Fail("a weight is negative, or a probability is outside [0, 1]",
           name + " -> " + child.symbol);
    }
    total += child.weight;
  }
  if (production.kind == NodeKind::kOr && total <= 0.0)
    Fail("no choice has a positive weight", name);
  if (production.kind != NodeKind::kRepeat) return;
  double count_total = 0.0;
  for (const double weight : production.count_weights) {
    if (!(weight >= 0.0) || !std::isfinite(weight)) Fail("a count's weight is negative", name);
    count_total += weight;
  }
  if (count_total <= 0.0) Fail("no count has a positive weight", name);
}

void GrammarBuilder::Resolve(Grammar* grammar) const {
  std::vector<Production> productions = productions_;
  productions.push_back({Head(kNothing), NodeKind::kLeaf, {}, {}});
  std::stable_partition(productions.begin(), productions.end(),
                        [this](const Production& p) { return p.head.name == start_; });
  if (productions.front().head.name != start_) Fail("the start is not defined", start_);
  for (const Production& production : productions) {
    const Head& head = production.head;
    if (head.name.empty()) Fail("a symbol has no name", "");
    if (grammar->Find(head.name) >= 0) Fail("it is defined twice", head.name);
    CheckProduction(production);
    Symbol symbol;
    symbol.name = head.name;
    symbol.kind = production.kind;
    symbol.count_weights = production.count_weights;
    symbol.category = head.category;
    symbol.welded = head.welded;
    symbol.surface = head.surface;
    grammar->symbols_.push_back(symbol);
  }
  for (std::size_t i = 0; i < productions.size(); ++i) {
    for (const Child& child : productions[i].children) {
      const int target = grammar->Find(child.symbol);
      if (target < 0) Fail("it is used, but not defined", child.symbol);
      grammar->symbols_[i].branches.push_back({target, child.weight, child.pose});
    }
  }
}

void GrammarBuilder::CheckReachable(const Grammar& grammar) const {
  std::vector<bool> reached(grammar.symbols().size(), false);
  std::vector<int> pending = {0};
  bool has_object = false;
  while (!pending.empty()) {
    const int index = pending.back();
    pending.pop_back();
    if (reached[index]) continue;
    reached[index] = true;
    const Symbol& symbol = grammar.symbols()[index];
    has_object |= symbol.IsObject() && !symbol.welded;
    for (const Branch& branch : symbol.branches) pending.push_back(branch.symbol);
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const std::string& symbol = grammar.symbols()[i].name;
    if (!reached[i] && symbol != kNothing) Fail("it is never used", symbol);
  }
  if (!has_object) Fail("no object can be derived: a scene needs at least one", "");
}

void GrammarBuilder::CheckStructure(const Grammar& grammar) const {
  for (const StructureConstraint& constraint : grammar.structure()) {
    const std::string text = constraint.Describe();
    const bool at_most_of_slot = constraint.kind == StructureKind::kCategoryAtMost;
    if (constraint.n < (at_most_of_slot ? 0 : 1)) Fail("a number below 1 has no effect", text);
    if (!constraint.within.empty() && grammar.Find(constraint.within) < 0) {
      Fail("its symbol is not defined", text);
    }
    const bool names_slot = constraint.kind != StructureKind::kObjectsAtLeast &&
                            constraint.kind != StructureKind::kEntriesAtMost;
    if (!names_slot) continue;
    const auto& symbols = grammar.symbols();
    if (constraint.category.empty() ||
        std::none_of(symbols.begin(), symbols.end(),
                     [&](const auto& s) { return s.category == constraint.category; })) {
      Fail("no symbol has its category", text);
    }
  }
}

void GrammarBuilder::CheckPoseConstraints(const Grammar& grammar) const {
  for (const KeepOut& keep_out : grammar.keep_outs()) {
    for (const KeepOutBody& body : keep_out.bodies) {
      const int index = grammar.Find(body.symbol);
      if (index < 0 || !grammar.symbols()[index].IsObject()) {
        Fail(body.symbol + " is not an object of the grammar", keep_out.name);
      }
      if (!(body.radius >= 0.0) || !std::isfinite(body.radius)) {
        Fail("a radius is negative or not finite", keep_out.name);
      }
    }
    for (const std::string& symbol : keep_out.against) {
      if (grammar.Find(symbol) < 0) Fail(symbol + " is not defined", keep_out.name);
    }
    if (!keep_out.exempt_within.empty() && grammar.Find(keep_out.exempt_within) < 0) {
      Fail(keep_out.exempt_within + " is not defined", keep_out.name);
    }
  }
  for (const InsideRim& rim : grammar.rims()) {
    const int index = grammar.Find(rim.surface);
    if (index < 0 || !grammar.symbols()[index].surface) Fail("it is not a surface", rim.surface);
    for (const std::string& symbol : rim.symbols) {
      if (grammar.Find(symbol) < 0) Fail(symbol + " is not defined", rim.Describe());
    }
    const double smallest = rim.round ? rim.half_x : std::min(rim.half_x, rim.half_y);
    if (!(rim.margin >= 0.0 && smallest > rim.margin && std::isfinite(rim.half_x + rim.half_y))) {
      Fail("its rim leaves no space inside", rim.surface);
    }
  }
}

Grammar GrammarBuilder::Build() const {
  Grammar grammar;
  grammar.name_ = name_;
  grammar.structure_ = structure_;
  grammar.keep_outs_ = keep_outs_;
  grammar.rims_ = rims_;
  Resolve(&grammar);
  CheckReachable(grammar);
  CheckStructure(grammar);
  CheckPoseConstraints(grammar);
  return grammar.WithOptions(options_);
}

}  // namespace simwright::scene
