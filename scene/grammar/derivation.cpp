#include "scene/grammar/derivation.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"

namespace simwright::scene {
namespace {

constexpr std::size_t kMostNodes = 10'000;

// Samples an index by weight; the sum of the weights must be above 0.
int SampleIndex(const std::vector<double>& weights, core::Rng& rng) {
  double left = core::Uniform(rng) * std::accumulate(weights.begin(), weights.end(), 0.0);
  int last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    last = static_cast<int>(i);
    if (left < weights[i]) return last;
    left -= weights[i];
  }
  return last;
}

// Samples the branches of a node, in order.
std::vector<int> SampleBranches(const Symbol& symbol, core::Rng& rng) {
  std::vector<int> taken;
  const int count = static_cast<int>(symbol.branches.size());
  switch (symbol.kind) {
    case NodeKind::kLeaf:
      break;
    case NodeKind::kAnd:
      for (int i = 0; i < count; ++i) taken.push_back(i);
      break;
    case NodeKind::kOr: {
      std::vector<double> weights;
      for (const Branch& branch : symbol.branches) weights.push_back(branch.weight);
      taken.push_back(SampleIndex(weights, rng));
      break;
    }
    case NodeKind::kIndependent:
      for (int i = 0; i < count; ++i) {
        const double weight = symbol.branches[static_cast<std::size_t>(i)].weight;
        if (core::Uniform(rng) < weight) taken.push_back(i);
      }
      break;
    case NodeKind::kRepeat:
      taken.assign(static_cast<std::size_t>(SampleIndex(symbol.count_weights, rng)), 0);
      break;
  }
  return taken;
}

// A pending child of a node, by one of its symbol's branches.
struct Pending {
  int parent = -1, branch = -1;
};

DerivedNode ChildOf(const Grammar& grammar, const Derivation& derivation, const Pending& pending) {
  const DerivedNode& node = derivation[static_cast<std::size_t>(pending.parent)];
  const Symbol& symbol = SymbolOf(grammar, node);
  DerivedNode child;
  child.symbol = symbol.branches[static_cast<std::size_t>(pending.branch)].symbol;
  child.parent = pending.parent;
  child.branch = pending.branch;
  child.surface = symbol.surface ? pending.parent : node.surface;
  child.carrier = symbol.IsObject() && !symbol.welded ? pending.parent : node.carrier;
  return child;
}

bool IsWithin(const Grammar& grammar, const Derivation& derivation, int index,
              const std::string& symbol) {
  for (int i = index; i >= 0; i = derivation[static_cast<std::size_t>(i)].parent) {
    if (SymbolOf(grammar, derivation[static_cast<std::size_t>(i)]).name == symbol) return true;
  }
  return false;
}

// The counts for constraints, over the objects of one category or all objects.
struct Census {
  int objects = 0;  // without welded ones
  int entries = 0;  // with welded ones
  int of_slot = 0, stacks = 0, tallest = 0;
};

Census CensusOf(const Grammar& grammar, const Derivation& derivation,
                const StructureConstraint& constraint) {
  Census census;
  std::vector<int> level(derivation.size(), 0);  // level in its stack, from 1
  for (std::size_t i = 0; i < derivation.size(); ++i) {
    const DerivedNode& node = derivation[i];
    const Symbol& symbol = SymbolOf(grammar, node);
    if (!symbol.IsObject()) continue;
    if (!constraint.within.empty() &&
        !IsWithin(grammar, derivation, static_cast<int>(i), constraint.within)) {
      continue;
    }
    ++census.entries;
    if (!symbol.welded) ++census.objects;
    if (symbol.category != constraint.category) continue;
    ++census.of_slot;
    const bool based = node.carrier < 0 || level[static_cast<std::size_t>(node.carrier)] == 0;
    if (based) ++census.stacks;
    level[i] = based ? 1 : level[static_cast<std::size_t>(node.carrier)] + 1;
    census.tallest = std::max(census.tallest, level[i]);
  }
  return census;
}

bool Meets(const Grammar& grammar, const Derivation& derivation,
           const StructureConstraint& constraint) {
  const Census census = CensusOf(grammar, derivation, constraint);
  switch (constraint.kind) {
    case StructureKind::kCategoryAtLeast:
      return census.of_slot >= constraint.n;
    case StructureKind::kCategoryAtMost:
      return census.of_slot <= constraint.n;
    case StructureKind::kObjectsAtLeast:
      return census.objects >= constraint.n;
    case StructureKind::kEntriesAtMost:
      return census.entries <= constraint.n;
    case StructureKind::kTallestAtLeast:
      return census.tallest >= constraint.n;
    case StructureKind::kTallestAtMost:
      return census.tallest <= constraint.n;
    case StructureKind::kStacksAtLeast:
      return census.stacks >= constraint.n;
  }
  return false;
}

}  // namespace

const Symbol& SymbolOf(const Grammar& grammar, const DerivedNode& node) {
  return grammar.symbols()[static_cast<std::size_t>(node.symbol)];
}

// Depth first with an explicit stack: a symbol that derives itself may recurse thousands of times.
Derivation Derive(const Grammar& grammar, core::Rng& rng) {
  Derivation derivation(1);
  derivation[0].symbol = 0;
  std::vector<Pending> pending;
  for (int last = 0;; last = static_cast<int>(derivation.size()) - 1) {
    const Symbol& symbol = SymbolOf(grammar, derivation[static_cast<std::size_t>(last)]);
    const std::vector<int> taken = SampleBranches(symbol, rng);
    for (auto branch = taken.rbegin(); branch != taken.rend(); ++branch) {
      pending.push_back({last, *branch});
    }
    if (pending.empty()) return derivation;
    if (derivation.size() > kMostNodes) {
      throw core::Error("a derivation has more than " + std::to_string(kMostNodes) + " nodes",
                        "scene grammar " + grammar.name(),
                        "reduce the probability with which its symbols derive themselves");
    }
    derivation.push_back(ChildOf(grammar, derivation, pending.back()));
    pending.pop_back();
  }
}

int EndOf(const Derivation& derivation, int first) {
  auto end = static_cast<std::size_t>(first) + 1;
  while (end < derivation.size() && derivation[end].parent >= first) ++end;
  return static_cast<int>(end);
}

void SamplePosesFrom(const Grammar& grammar, int first, bool keep, core::Rng& rng,
                     Derivation* derivation) {
  const auto begin = static_cast<std::size_t>(first);
  const auto end = static_cast<std::size_t>(EndOf(*derivation, first));
  const Eigen::Isometry3d before_from_world = (*derivation)[begin].world_from_node.inverse();
  for (std::size_t i = begin; i < end; ++i) {
    DerivedNode& node = (*derivation)[i];
    if (node.parent < 0) continue;  // the root is the world
    if (keep && i != begin) {
      node.world_from_node =
          (*derivation)[begin].world_from_node * before_from_world * node.world_from_node;
      continue;
    }
    const auto parent = static_cast<std::size_t>(node.parent);
    const Symbol& above = SymbolOf(grammar, (*derivation)[parent]);
    const PoseRule& rule = above.branches[static_cast<std::size_t>(node.branch)].pose;
    const Eigen::Isometry3d surface =
        node.surface < 0 ? Eigen::Isometry3d::Identity()
                         : (*derivation)[static_cast<std::size_t>(node.surface)].world_from_node;
    node.world_from_node = SamplePose(rule, (*derivation)[parent].world_from_node, surface, rng);
  }
}

int FirstViolatedStructure(const Grammar& grammar, const Derivation& derivation) {
  for (std::size_t i = 0; i < grammar.structure().size(); ++i) {
    if (!Meets(grammar, derivation, grammar.structure()[i])) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace simwright::scene
