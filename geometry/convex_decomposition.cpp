#include "geometry/convex_decomposition.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
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
constexpr int kSearchFaces = 3000;     // faces of the simplified solid on which cuts are searched
constexpr double kSearchError = 2e-3;  // of the diagonal: its largest deviation
constexpr int kSolidSamples = 4000;
constexpr double kUncovered = 1e-4;  // of the diagonal: a vertex farther outside enlarges the hull

void RequireOptions(const DecompositionOptions& options) {
  const bool good = options.threshold > 0.0 && options.threshold <= 2.0 && options.max_parts >= 0 &&
                    options.max_hull_vertices >= 16 && options.candidates >= 1 &&
                    options.beam >= 1 && options.depth >= 1 && options.depth <= 4 &&
                    options.min_thickness > 0.0 && options.min_thickness < 0.1;
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

void MeasureConcavity(const CutContext& context, Piece* piece) {
  if (piece->concavity >= 0.0) return;
  piece->concavity =
      context.fit->Concavity(piece->hull, piece->volume, std::numeric_limits<double>::infinity());
}

// Cuts the most concave piece repeatedly until all pieces meet the threshold or their number
// reaches the last of `limits` (ascending). Returns the pieces at each limit; limits that were not
// reached share one final stage.
std::vector<std::vector<Piece>> CutRepeatedly(const core::TriangleMesh& solid, double threshold,
                                              const std::vector<int>& limits,
                                              const CutContext& context) {
  std::vector<Piece> pieces, done;
  for (core::TriangleMesh& body : ConnectedBodies(solid)) {
    pieces.push_back(MakePiece(std::move(body), context));
    MeasureConcavity(context, &pieces.back());
  }
  std::vector<std::vector<Piece>> stages;
  const auto keep = [&] {
    stages.push_back(done);
    stages.back().insert(stages.back().end(), pieces.begin(), pieces.end());
    for (Piece& piece : stages.back()) piece.mesh = {};  // merging needs the hulls only
  };
  std::size_t limit = 0;
  while (!pieces.empty()) {
    core::CheckCancelled();
    while (limit < limits.size() &&
           static_cast<int>(pieces.size() + done.size()) >= limits[limit]) {
      if (++limit < limits.size()) keep();
    }
    if (limit == limits.size()) break;
    const auto worst =
        std::max_element(pieces.begin(), pieces.end(),
                         [](const Piece& a, const Piece& b) { return a.concavity < b.concavity; });
    Piece piece = std::move(*worst);
    pieces.erase(worst);
    std::vector<Piece> cut;
    if (piece.concavity > threshold) cut = BestCut(piece, context);
    if (cut.empty()) {
      done.push_back(std::move(piece));
      continue;
    }
    for (Piece& p : cut) {
      MeasureConcavity(context, &p);
      pieces.push_back(std::move(p));
    }
  }
  keep();
  return stages;
}

// Merges the pieces of each stage to at most `max_parts` and returns the least concave result.
std::vector<Piece> BestMerged(std::vector<std::vector<Piece>> stages, int max_parts,
                              const CutContext& context) {
  const DecompositionOptions& options = *context.options;
  std::vector<Piece>* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (std::vector<Piece>& pieces : stages) {
    if (options.merge || static_cast<int>(pieces.size()) > max_parts) {
      MergePieces(context, options.merge ? options.threshold : 0.0, max_parts, &pieces);
    }
    double worst = 0.0;
    for (Piece& piece : pieces) {
      MeasureConcavity(context, &piece);
      worst = std::max(worst, piece.concavity);
    }
    if (worst >= least) continue;
    least = worst;
    best = &pieces;
  }
  return std::move(*best);
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
  std::vector<int> limits{kMostParts};
  if (p > 0) limits = {p, p + p / 4 + 1, p + p / 2 + 2, 2 * p + 6};
  std::vector<Piece> pieces =
      BestMerged(CutRepeatedly(SearchMesh(solid, diagonal), options.threshold, limits, context),
                 p > 0 ? p : kMostParts, context);
  GrowHulls(solid, context, &pieces);

  ConvexDecomposition result;
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.hull_volume > b.hull_volume; });
  for (Piece& piece : pieces) {
    MeasureConcavity(context, &piece);
    ConvexPart part;
    part.concavity = piece.concavity;
    part.hull = SimplifyHull(piece.hull, options.max_hull_vertices);
    result.concavity = std::max(result.concavity, part.concavity);
    result.parts.push_back(std::move(part));
  }
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
  ConvexDecomposition result = DecomposeUnit(welded, options);
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
