#include "geometry/convex_decomposition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/concavity.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_pieces.h"
#include "geometry/hull_fit.h"
#include "geometry/hull_simplify.h"
#include "geometry/simplify.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr int kMostParts = 256;
constexpr int kFewestVertices = 16;    // of a simplified hull
constexpr int kSearchFaces = 3000;     // faces of the simplified solid on which cuts are searched
constexpr double kSearchError = 2e-3;  // of the diagonal: its largest deviation
constexpr int kSolidSamples = 4000;
constexpr int kFewEvaluations = 30;    // hulls measured per part, to improve every attempt
constexpr int kManyEvaluations = 150;  // and the best one
constexpr int kFewParts = 8;           // fewer parts than these get as many evaluations
constexpr std::size_t kImproved = 1;   // attempts per cutting, least concave first
constexpr std::size_t kFinalists = 1;  // attempts that are improved further; more found no better
constexpr double kProtrusion = 1e-2;   // of the diagonal: accepted of a simplified hull
constexpr double kUncovered = 1e-4;  // of the diagonal: a vertex farther outside enlarges the hull

// Returns the vertices of a closed triangle mesh without holes that has so many faces (Euler).
int VerticesWithFaces(int faces) {
  return (faces + 4) / 2;
}

void RequireOptions(const DecompositionOptions& options) {
  const bool good = options.threshold > 0.0 && options.threshold <= 2.0 && options.max_parts >= 0 &&
                    options.max_hull_vertices >= kFewestVertices &&
                    (options.max_hull_faces == 0 ||
                     VerticesWithFaces(options.max_hull_faces) >= kFewestVertices) &&
                    options.tolerance >= 0.0 && std::isfinite(options.tolerance) &&
                    options.candidates >= 1 && options.beam >= 1 && options.depth >= 1 &&
                    options.depth <= 4 && options.min_thickness > 0.0 &&
                    options.min_thickness < 0.1;
  if (!good) throw core::Error("a decomposition option is out of range", "convex decomposition");
}

// Returns the mesh on which cuts are searched: the solid itself, or a simplified mesh close to it.
core::TriangleMesh SearchMesh(const core::TriangleMesh& solid, double diagonal) {
  if (static_cast<int>(solid.triangles.size()) <= kSearchFaces) return solid;
  SimplifyOptions options;
  options.face_budget = kSearchFaces;
  options.max_error = kSearchError * diagonal;
  try {
    core::TriangleMesh thin = Simplify(solid, options);
    if (SignedVolume(thin) > 0.0) return thin;
  } catch (const core::Error&) {
    // Not a manifold: search on the unchanged solid, which takes longer.
  }
  return solid;
}

// Measures the concavities that are not known yet.
void MeasureConcavities(const CutContext& context, std::vector<Piece>* pieces) {
  core::ParallelFor(static_cast<int>(pieces->size()), [&](int i) {
    Piece& piece = (*pieces)[i];
    if (piece.concavity >= 0.0) return;
    piece.concavity =
        context.fit->Concavity(piece.hull, piece.volume, std::numeric_limits<double>::infinity());
  });
}

// A decomposition by cuts: the finest pieces, and coarser ones that were cut further.
struct Cutting {
  std::vector<Piece> cells;                // the finest pieces
  std::vector<std::vector<Piece>> stages;  // at ascending numbers of pieces, with their cells
};

using Cutter = std::vector<Piece> (*)(const Piece&, const CutContext&);

// Cuts the most concave piece repeatedly until all pieces meet the threshold or their number
// reaches the last of `limits` (ascending), and keeps the pieces at each limit; limits that were
// not reached share one final stage.
Cutting CutRepeatedly(const core::TriangleMesh& solid, double threshold,
                      const std::vector<int>& limits, const CutContext& context, Cutter cutter) {
  std::vector<Piece> nodes;  // all pieces; those of one cut follow their parent
  std::vector<int> parent, open, done;
  const auto add = [&](std::vector<Piece>&& pieces, int from) {
    MeasureConcavities(context, &pieces);
    for (Piece& piece : pieces) {
      open.push_back(static_cast<int>(nodes.size()));
      nodes.push_back(std::move(piece));
      parent.push_back(from);
    }
  };
  std::vector<Piece> bodies;
  for (core::TriangleMesh& body : ConnectedBodies(solid)) {
    bodies.push_back(MakePiece(std::move(body), context));
  }
  add(std::move(bodies), -1);
  std::vector<std::vector<int>> stages;
  const auto keep = [&] {
    stages.push_back(done);
    stages.back().insert(stages.back().end(), open.begin(), open.end());
  };
  std::size_t limit = 0;
  while (!open.empty()) {
    core::CheckCancelled();
    while (limit < limits.size() && static_cast<int>(open.size() + done.size()) >= limits[limit]) {
      if (++limit < limits.size()) keep();
    }
    if (limit == limits.size()) break;
    const auto worst = std::max_element(open.begin(), open.end(), [&](int a, int b) {
      return nodes[a].concavity < nodes[b].concavity;
    });
    const int node = *worst;
    open.erase(worst);
    std::vector<Piece> cut;
    if (nodes[node].concavity > threshold) cut = cutter(nodes[node], context);
    if (cut.empty()) done.push_back(node);
    add(std::move(cut), node);
  }
  keep();

  Cutting cutting;
  for (const int leaf : stages.back()) {
    for (int node = leaf; node >= 0; node = parent[node]) {
      nodes[node].cells.push_back(static_cast<int>(cutting.cells.size()));
    }
    cutting.cells.push_back(nodes[leaf]);
  }
  for (const std::vector<int>& stage : stages) {
    cutting.stages.emplace_back();
    for (const int node : stage) {
      Piece piece = nodes[node];
      piece.mesh = {};  // merging needs the hulls only
      cutting.stages.back().push_back(std::move(piece));
    }
  }
  return cutting;
}

double WorstConcavity(const std::vector<Piece>& pieces) {
  double worst = 0.0;
  for (const Piece& piece : pieces) worst = std::max(worst, piece.concavity);
  return worst;
}

// Convex parts as groups of the finest pieces of a cutting.
struct Attempt {
  std::vector<Piece> cells, parts;
  double worst = 0.0;  // concavity
};

// Merges the pieces of each stage of a cutting to at most `max_parts`, one after the other: the
// last has most of the work, so that threads share its loops instead of the stages.
std::vector<Attempt> Merged(const Cutting& cutting, int max_parts, const CutContext& context) {
  const DecompositionOptions& options = *context.options;
  std::vector<Attempt> attempts;
  for (const std::vector<Piece>& stage : cutting.stages) {
    Attempt attempt{cutting.cells, stage};
    if (options.merge || static_cast<int>(stage.size()) > max_parts) {
      MergePieces(context, options.merge ? options.threshold : 0.0, max_parts, &attempt.parts);
    }
    MeasureConcavities(context, &attempt.parts);
    attempt.worst = WorstConcavity(attempt.parts);
    attempts.push_back(std::move(attempt));
  }
  return attempts;
}

// Returns true if `a` is the better result: closer to the threshold, then of fewer parts, then less
// concave.
bool IsBetter(const Attempt& a, const Attempt& b, double threshold) {
  const auto rank = [&](const Attempt& attempt) {
    const double beyond = std::max(0.0, attempt.worst - threshold);
    return std::tuple(beyond, attempt.parts.size(), attempt.worst);
  };
  return rank(a) < rank(b);
}

// Returns the best of the cuttings' merged results, without a limit on the number of parts.
std::vector<Piece> FewestParts(const std::vector<Cutting>& cuttings, const CutContext& context) {
  std::vector<Attempt> attempts;
  for (const Cutting& cutting : cuttings) {
    for (Attempt& attempt : Merged(cutting, kMostParts, context)) {
      attempts.push_back(std::move(attempt));
    }
  }
  const auto better = [&](const Attempt& a, const Attempt& b) {
    return IsBetter(a, b, context.options->threshold);
  };
  return std::min_element(attempts.begin(), attempts.end(), better)->parts;
}

// Improves the best merged results of each cutting a little and the best of all further, and
// returns that.
std::vector<Piece> LeastConcave(const std::vector<Cutting>& cuttings, int max_parts,
                                const CutContext& context) {
  const auto better = [&](const Attempt& a, const Attempt& b) {
    return IsBetter(a, b, context.options->threshold);
  };
  const auto improve = [&](int evaluations, std::vector<Attempt>* attempts) {
    // Threads share the loops of each attempt, since there are few attempts.
    for (Attempt& attempt : *attempts) {
      const int parts = std::max<int>(kFewParts, attempt.parts.size());
      RegroupCells(context, evaluations * parts, &attempt.cells, &attempt.parts);
      MeasureConcavities(context, &attempt.parts);
      attempt.worst = WorstConcavity(attempt.parts);
    }
    std::stable_sort(attempts->begin(), attempts->end(), better);
  };
  std::vector<Attempt> attempts;
  for (const Cutting& cutting : cuttings) {
    std::vector<Attempt> merged = Merged(cutting, max_parts, context);
    std::stable_sort(merged.begin(), merged.end(), better);
    for (std::size_t i = 0; i < std::min(kImproved, merged.size()); ++i) {
      attempts.push_back(std::move(merged[i]));
    }
  }
  improve(kFewEvaluations, &attempts);
  attempts.resize(std::min(kFinalists, attempts.size()));
  improve(kManyEvaluations, &attempts);
  return std::move(attempts[0].parts);
}

// Returns the hull with at most `max_vertices`. The simplified hull keeps the volume and therefore
// protrudes a little; where it deviates too far from the solid, the inscribed hull takes its place.
core::TriangleMesh WithinVertices(const core::TriangleMesh& hull, int max_vertices,
                                  const CutContext& context) {
  if (static_cast<int>(hull.vertices.size()) <= max_vertices) return hull;
  core::TriangleMesh simple = SimplifyHull(hull, max_vertices);
  const double limit = context.options->tolerance > 0.0
                           ? context.options->threshold * context.fit->unit()
                           : context.fit->Distance(hull) + kProtrusion * context.diagonal;
  const double distance = context.fit->Distance(simple);
  if (distance <= limit) return simple;
  core::TriangleMesh inscribed = ThickenedConvexHull(
      hull.vertices, context.options->min_thickness * context.diagonal, max_vertices);
  return context.fit->Distance(inscribed) < distance ? inscribed : simple;
}

// Grows the hulls by the solid's own vertices that lie outside of the simplified solid's parts.
void GrowHulls(const core::TriangleMesh& solid, const CutContext& context,
               std::vector<Piece>* pieces) {
  const double reach = kUncovered * context.diagonal;
  std::vector<std::vector<Eigen::Vector4d>> planes;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Piece& piece : *pieces) {
    planes.push_back(FacePlanes(piece.hull));
    boxes.push_back(core::Bounds(piece.hull));
  }
  std::vector<std::vector<Vector3d>> taken(pieces->size());
  for (const Vector3d& v : solid.vertices) {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t home = 0;
    for (std::size_t i = 0; i < pieces->size() && nearest > reach; ++i) {
      if (boxes[i].exteriorDistance(v) >= nearest) continue;
      const double height = MaxPlaneDistance(planes[i], v);
      if (height >= nearest) continue;
      nearest = height;
      home = i;
    }
    if (nearest > reach) taken[home].push_back(v);
  }
  for (std::size_t i = 0; i < pieces->size(); ++i) {
    if (taken[i].empty()) continue;
    Piece& piece = (*pieces)[i];
    taken[i].insert(taken[i].end(), piece.hull.vertices.begin(), piece.hull.vertices.end());
    piece.hull = ThickenedConvexHull(taken[i], context.options->min_thickness * context.diagonal);
    piece.hull_volume = SignedVolume(piece.hull);
    piece.concavity = -1.0;
  }
}

// Returns ConvexDecomposition::deviation.
double Deviation(const std::vector<ConvexPart>& parts, const HullDeviation& fit) {
  const int count = static_cast<int>(parts.size());
  std::vector<std::vector<Eigen::Vector4d>> planes(parts.size());
  std::vector<double> distances(parts.size());
  core::ParallelFor(count, [&](int i) {
    distances[i] = fit.Distance(parts[i].hull);
    planes[i] = FacePlanes(parts[i].hull);
  });
  double farthest = 0.0;
  for (const double distance : distances) farthest = std::max(farthest, distance);
  for (const Vector3d& p : fit.samples()) {
    double height = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < planes.size() && height > farthest; ++i) {
      height = std::min(height, MaxPlaneDistance(planes[i], p));
    }
    farthest = std::max(farthest, height);
  }
  return farthest;
}

ConvexDecomposition DecomposeUnit(const core::TriangleMesh& solid,
                                  const DecompositionOptions& options) {
  const double diagonal = core::Bounds(solid).diagonal().norm();
  const double volume = SignedVolume(solid);
  const HullDeviation fit(solid, kSolidSamples, options.seed);
  CutContext context{&options, &fit, diagonal, volume, 0.0};
  context.excess = MakePiece(solid, context).Excess();

  // Cut more pieces than needed, then merge: merging considers all neighbours, cutting only one
  // piece at a time. The best surplus varies, so several are tried.
  const int p = options.max_parts;
  const core::TriangleMesh search = SearchMesh(solid, diagonal);
  std::vector<int> limits{kMostParts}, halving{kMostParts};
  if (p > 0) {
    limits = {p, p + p / 2 + 2, 3 * p + 10};
    halving = {2 * p, 4 * p};
  }
  std::vector<Cutting> cuttings{CutRepeatedly(search, options.threshold, limits, context, BestCut)};
  cuttings.push_back(CutRepeatedly(search, options.threshold, limits, context, FlatCut));
  if (p > 0) cuttings.push_back(CutRepeatedly(search, options.threshold, halving, context, Halved));
  std::vector<Piece> pieces =
      p > 0 ? LeastConcave(cuttings, p, context) : FewestParts(cuttings, context);
  GrowHulls(solid, context, &pieces);

  int most_vertices = options.max_hull_vertices;
  if (options.max_hull_faces > 0) {
    most_vertices = std::min(most_vertices, VerticesWithFaces(options.max_hull_faces));
  }
  ConvexDecomposition result;
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.hull_volume > b.hull_volume; });
  MeasureConcavities(context, &pieces);
  result.concavity = WorstConcavity(pieces);
  result.parts.resize(pieces.size());
  core::ParallelFor(static_cast<int>(pieces.size()), [&](int i) {
    result.parts[i].concavity = pieces[i].concavity;
    result.parts[i].hull = WithinVertices(pieces[i].hull, most_vertices, context);
  });
  result.deviation = Deviation(result.parts, fit);
  result.coverage = Coverage(solid, Hulls(result));
  return result;
}

}  // namespace

ConvexDecomposition Decompose(const core::TriangleMesh& solid,
                              const DecompositionOptions& options) {
  core::RequireValid(solid, "convex decomposition");
  RequireOptions(options);
  if (solid.empty()) throw core::Error("the mesh has no triangles", "convex decomposition");
  core::TriangleMesh welded = Weld(solid, 0.0);
  const double diagonal = core::Bounds(welded).diagonal().norm();
  const double volume = SignedVolume(welded);
  if (!(volume > 1e-12 * std::pow(diagonal, 3)) || !std::isfinite(volume)) {
    throw core::Error("the mesh encloses no positive volume", "convex decomposition",
                      "close it and turn its faces outward");
  }
  // Work in a normalised frame, with the scale a power of two: rounding is then the same for a
  // solid that is tiny, huge or far away.
  const Vector3d middle = core::Bounds(welded).center();
  const double scale = std::exp2(-std::ceil(std::log2(diagonal)));
  for (Vector3d& v : welded.vertices) v = (v - middle) * scale;
  DecompositionOptions unit = options;
  if (options.tolerance > 0.0) {
    const double half = 0.5 * core::Bounds(solid).sizes().maxCoeff();
    unit.threshold = std::min(2.0, options.tolerance / half);
  }
  ConvexDecomposition result = DecomposeUnit(welded, unit);
  result.deviation /= scale;
  for (ConvexPart& part : result.parts) {
    for (Vector3d& v : part.hull.vertices) v = v / scale + middle;
  }
  return result;
}

std::vector<core::TriangleMesh> Hulls(const ConvexDecomposition& decomposition) {
  std::vector<core::TriangleMesh> hulls;
  for (const ConvexPart& part : decomposition.parts) hulls.push_back(part.hull);
  return hulls;
}

}  // namespace simwright::geometry
