#include "scene/grammar/scene_sample.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/error.h"
#include "scene/grammar/derivation.h"
#include "scene/grammar/pose_violation.h"

namespace simwright::scene {
namespace {

// The number of violations of each constraint.
using Failures = std::map<std::string, int>;

// Samples derivations and rejects those that violate the structure or, once the poses are sampled,
// a constraint that is enforced by rejection; each counts as a derivation.
std::optional<Derivation> DeriveValid(const Grammar& grammar, core::Rng& rng, SceneSample* sample,
                                      Failures* failures) {
  for (int i = 0; i < grammar.options().derivations; ++i) {
    ++sample->derivations;
    Derivation derivation = Derive(grammar, rng);
    const int unmet = FirstViolatedStructure(grammar, derivation);
    if (unmet >= 0) {
      ++(*failures)[grammar.structure()[static_cast<std::size_t>(unmet)].Describe()];
      continue;
    }
    ++sample->pose_draws;
    SamplePosesFrom(grammar, 0, /*keep=*/false, rng, &derivation);
    const PoseViolation violation(grammar, derivation, Decision::kReject);
    if (violation.Sum(derivation) == 0.0) return derivation;
    ++(*failures)[violation.Worst(derivation)];
  }
  return std::nullopt;
}

// Returns the node whose pose is resampled to move `node`: itself, or its nearest ancestor with a
// random rule on the same surface; -1 if nothing moves it.
int Movable(const Grammar& grammar, const Derivation& derivation, int node) {
  const int surface = derivation[static_cast<std::size_t>(node)].surface;
  for (int i = node; i != surface && i >= 0;) {
    const DerivedNode& one = derivation[static_cast<std::size_t>(i)];
    if (one.parent < 0) return -1;
    const Symbol& above = SymbolOf(grammar, derivation[static_cast<std::size_t>(one.parent)]);
    if (above.branches[static_cast<std::size_t>(one.branch)].pose.IsRandom()) return i;
    i = one.parent;
  }
  return -1;
}

// Makes one pass over the violating objects. Proposals are sampled from the pose rules, so that
// accepted poses keep their distribution where no constraint interferes.
void RedrawOffenders(const Grammar& grammar, const PoseViolation& violation, core::Rng& rng,
                     Derivation* derivation) {
  for (const int offender : violation.ViolatingObjects(*derivation)) {
    const int movable = Movable(grammar, *derivation, offender);
    if (movable < 0) continue;
    const int end = EndOf(*derivation, movable);
    double now = violation.SumOf(*derivation, movable, end);
    for (int i = 0; i < grammar.options().proposals && now > 0.0; ++i) {
      const Derivation before(derivation->begin() + movable, derivation->begin() + end);
      SamplePosesFrom(grammar, movable, /*keep=*/true, rng, derivation);
      const double then = violation.SumOf(*derivation, movable, end);
      const double acceptance = std::exp((now - then) / grammar.options().temperature);
      if (then > now && core::Uniform(rng) >= acceptance) {
        std::copy(before.begin(), before.end(), derivation->begin() + movable);
      } else {
        now = then;
      }
    }
  }
}

// Resamples violating poses until none violates a constraint; returns false if the attempts did not
// suffice, or if a new pose violates a constraint that is enforced by rejection.
bool PlaceValid(const Grammar& grammar, core::Rng& rng, Derivation* derivation, SceneSample* sample,
                Failures* failures) {
  const PoseViolation violation(grammar, *derivation, Decision::kResample);
  for (int i = 0; violation.Sum(*derivation) > 0.0; ++i) {
    if (i == grammar.options().pose_draws) {
      ++(*failures)[violation.Worst(*derivation)];
      return false;
    }
    ++sample->pose_draws;
    RedrawOffenders(grammar, violation, rng, derivation);
  }
  const PoseViolation rejected(grammar, *derivation, Decision::kReject);
  if (rejected.Sum(*derivation) == 0.0) return true;
  ++(*failures)[rejected.Worst(*derivation)];
  return false;
}

std::vector<SceneObject> Flattened(const Grammar& grammar, const Derivation& derivation) {
  std::vector<SceneObject> objects;
  std::vector<int> entry(derivation.size(), -1);  // the object at or above a node
  for (std::size_t i = 0; i < derivation.size(); ++i) {
    const DerivedNode& node = derivation[i];
    const int above = node.parent < 0 ? -1 : entry[static_cast<std::size_t>(node.parent)];
    entry[i] = above;
    const Symbol& symbol = SymbolOf(grammar, node);
    if (!symbol.IsObject()) continue;
    entry[i] = static_cast<int>(objects.size());
    objects.push_back({symbol.category, symbol.name, node.world_from_node, symbol.welded, above});
  }
  return objects;
}

[[noreturn]] void Fail(const Grammar& grammar, const SceneSample& sample,
                       const Failures& failures) {
  const auto most =
      std::max_element(failures.begin(), failures.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  throw core::Error("no scene satisfies '" + most->first + "' (violated " +
                        std::to_string(most->second) + " times in " +
                        std::to_string(sample.derivations) + " derivations and " +
                        std::to_string(sample.pose_draws) + " pose samples)",
                    "scene grammar " + grammar.name(), "relax it, or allow more tries");
}

}  // namespace

SceneSample SampleGrammar(const Grammar& grammar, core::Rng& rng) {
  SceneSample sample;
  Failures failures;
  while (sample.tries < grammar.options().tries) {
    ++sample.tries;
    std::optional<Derivation> derivation = DeriveValid(grammar, rng, &sample, &failures);
    if (!derivation || !PlaceValid(grammar, rng, &*derivation, &sample, &failures)) continue;
    sample.objects = Flattened(grammar, *derivation);
    return sample;
  }
  Fail(grammar, sample, failures);
}

}  // namespace simwright::scene
