#include "asset_build/part_budget.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"

namespace simwright::asset_build {
namespace {

bool LimitsHulls(const PartBudget& budget) {
  return budget.max_vertices > 0 || budget.max_faces > 0;
}

// Returns true if the parts are less precise than asked.
bool IsExceeded(const core::TriangleMesh& solid, const geometry::DecompositionOptions& options,
                const PartBudget& budget, const geometry::ConvexDecomposition& done) {
  constexpr double kRoundOff = 1.01;  // of the limit: measured by samples
  if (budget.tolerance > 0.0) return done.deviation > kRoundOff * budget.tolerance;
  if (done.concavity > kRoundOff * options.threshold) return true;
  // Concavity does not see the vertices that hulls lack; its unit is half the longest side.
  const double unit = 0.5 * core::Bounds(solid).sizes().maxCoeff();
  return LimitsHulls(budget) && done.deviation > kRoundOff * options.threshold * unit;
}

// Names the limits that the user gave and could raise.
std::string Remedy(const PartBudget& budget) {
  std::string options;
  const auto add = [&](bool given, const char* option) {
    if (given) options += (options.empty() ? "" : ", ") + std::string(option);
  };
  add(budget.max_parts > 0, "--max-parts");
  add(budget.max_vertices > 0, "--max-vertices");
  add(budget.max_faces > 0, "--max-faces");
  return options.empty() ? "give a larger --part-tolerance" : "allow more with " + options;
}

}  // namespace

void Validate(const PartBudget& budget) {
  const auto require = [](int value, int least, int most, const char* option) {
    if (value == 0 || (value >= least && value <= most)) return;
    throw core::Error("is out of range", option,
                      "give " + std::to_string(least) + " to " + std::to_string(most));
  };
  require(budget.max_parts, 1, kMostParts, "--max-parts");
  require(budget.max_vertices, kLeastVertices, kMostVertices, "--max-vertices");
  require(budget.max_faces, kLeastFaces, 2 * kMostVertices - 4, "--max-faces");
  if (!(budget.tolerance >= 0.0) || !std::isfinite(budget.tolerance)) {
    throw core::Error("is not a length", "--part-tolerance", "give metres, e.g. 0.002");
  }
}

int MostVertices(const PartBudget& budget) {
  int most = budget.max_vertices;
  if (most == 0) most = geometry::DecompositionOptions{}.max_hull_vertices;
  // A closed triangle mesh without holes has F = 2 V - 4 faces.
  return budget.max_faces > 0 ? std::min(most, (budget.max_faces + 4) / 2) : most;
}

geometry::DecompositionOptions Limited(geometry::DecompositionOptions options,
                                       const PartBudget& budget) {
  if (budget.max_parts > 0) options.max_parts = budget.max_parts;
  if (budget.tolerance > 0.0) options.tolerance = budget.tolerance;
  if (LimitsHulls(budget)) options.max_hull_vertices = MostVertices(budget);
  return options;
}

void ReportBinding(const core::TriangleMesh& solid, const geometry::DecompositionOptions& options,
                   const PartBudget& budget, const geometry::ConvexDecomposition& done,
                   const std::string& place, core::Findings* findings) {
  if (!budget.Any() || !IsExceeded(solid, options, budget, done)) return;
  geometry::DecompositionOptions unlimited = options;
  unlimited.max_parts = 0;
  if (LimitsHulls(budget)) unlimited.max_hull_vertices = kMostVertices;
  const geometry::ConvexDecomposition needed = geometry::Decompose(solid, unlimited);
  std::size_t vertices = 0;
  for (const geometry::ConvexPart& part : needed.parts) {
    vertices = std::max(vertices, part.hull.vertices.size());
  }
  char text[280];
  char goal[64] = "the usual precision";
  if (budget.tolerance > 0.0) {
    std::snprintf(goal, sizeof goal, "a tolerance of %.2f mm", 1e3 * budget.tolerance);
  }
  const bool reached = !IsExceeded(solid, options, budget, needed);
  char more[120];
  if (reached) {
    std::snprintf(more, sizeof more, "would take %zu parts of up to %zu vertices",
                  needed.parts.size(), vertices);
  } else {
    std::snprintf(more, sizeof more, "is not reached by %zu parts without limits either: %.2f mm",
                  needed.parts.size(), 1e3 * needed.deviation);
  }
  std::snprintf(text, sizeof text, "%zu collision part%s from the solid by about %.2f mm; %s %s",
                done.parts.size(), done.parts.size() == 1 ? " deviates" : "s deviate",
                1e3 * done.deviation, goal, more);
  findings->push_back(
      {"part-budget", core::Severity::kWarning, place, text, done.deviation, Remedy(budget)});
}

}  // namespace simwright::asset_build
