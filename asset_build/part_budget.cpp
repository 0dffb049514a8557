#include "asset_build/part_budget.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"

namespace simwright::asset_build {

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
  options.max_hull_vertices = MostVertices(budget);
  return options;
}

void ReportBinding(const core::TriangleMesh& solid, const geometry::DecompositionOptions& options,
                   const PartBudget& budget, const geometry::ConvexDecomposition& done,
                   const std::string& place, core::Findings* findings) {
  constexpr double kRoundOff = 1.01;  // of the limit: measured by samples
  if (!budget.Any()) return;
  const bool stated = budget.tolerance > 0.0;
  const bool exceeded = stated ? done.deviation > kRoundOff * budget.tolerance
                               : done.concavity > kRoundOff * options.threshold;
  if (!exceeded) return;
  geometry::DecompositionOptions unlimited = options;
  unlimited.max_parts = 0;
  unlimited.max_hull_vertices = std::max(unlimited.max_hull_vertices, kMostVertices);
  const geometry::ConvexDecomposition needed = geometry::Decompose(solid, unlimited);
  std::size_t vertices = 0;
  for (const geometry::ConvexPart& part : needed.parts) {
    vertices = std::max(vertices, part.hull.vertices.size());
  }
  char text[240];
  char goal[64] = "the usual precision";
  if (stated) std::snprintf(goal, sizeof goal, "a tolerance of %.2f mm", 1e3 * budget.tolerance);
  std::snprintf(text, sizeof text,
                "%zu collision parts deviate from the solid by up to %.2f mm; %s would take %zu "
                "parts of up to %zu vertices",
                done.parts.size(), 1e3 * done.deviation, goal, needed.parts.size(), vertices);
  findings->push_back({"part-budget", core::Severity::kWarning, place, text, done.deviation,
                       "allow more with --max-parts, --max-vertices or --max-faces"});
}

}  // namespace simwright::asset_build
