#include "scene/grammar/grammar.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"

namespace simwright::scene {

bool GrammarSampleOptions::IsValid(std::string* error) const {
  const auto within = [](int value, int high) { return value >= 1 && value <= high; };
  if (!within(derivations, 10'000'000)) {
    *error = "derivations per try must be in 1 .. 10 000 000";
  } else if (!within(pose_draws, 1'000'000)) {
    *error = "pose samples per try must be in 1 .. 1 000 000";
  } else if (!within(proposals, 1000)) {
    *error = "proposals must be in 1 .. 1000";
  } else if (!within(tries, 1'000'000)) {
    *error = "tries must be in 1 .. 1 000 000";
  } else if (!std::isfinite(temperature) || temperature <= 0.0) {
    *error = "the temperature must be positive and finite";
  } else {
    return true;
  }
  return false;
}

std::vector<double> GeometricWeights(double p, int first, int last) {
  if (!(p > 0.0 && p <= 1.0)) {
    throw core::Error("the probability of a geometric count must be in (0, 1]", std::to_string(p));
  }
  if (first < 0 || last < first || last > 10'000) {
    throw core::Error("a geometric count must run from 0 or more to at most 10 000",
                      std::to_string(first) + " .. " + std::to_string(last));
  }
  std::vector<double> weights(last + 1, 0.0);
  for (int k = first; k <= last; ++k) weights[k] = std::pow(1.0 - p, k - first) * p;
  return weights;
}

int Grammar::MaxEntries() const {
  int most = 0;
  for (const StructureConstraint& one : structure_) {
    if (one.kind != StructureKind::kEntriesAtMost) continue;
    most = most == 0 ? one.n : std::min(most, one.n);
  }
  return most;
}

std::vector<std::string> Grammar::Categories() const {
  std::set<std::string> categories;
  for (const Symbol& symbol : symbols_) {
    if (symbol.IsObject()) categories.insert(symbol.category);
  }
  return {categories.begin(), categories.end()};
}

int Grammar::Find(const std::string& symbol) const {
  for (std::size_t i = 0; i < symbols_.size(); ++i) {
    if (symbols_[i].name == symbol) return static_cast<int>(i);
  }
  return -1;
}

Grammar Grammar::WithOptions(const GrammarSampleOptions& options) const {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "scene grammar " + name_);
  Grammar changed = *this;
  changed.options_ = options;
  return changed;
}

}  // namespace simwright::scene
