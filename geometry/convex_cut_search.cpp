#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/parallel.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_pieces.h"
#include "geometry/mass_properties.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kOnPlane = 1e-6;      // of the solid's diagonal: rounding of a file's coordinates
constexpr double kSameExcess = 1e-4;   // of the piece's excess: cuts that differ by less are equal
constexpr double kSameMoment = 0.02;   // relative difference of moments whose axes are arbitrary
constexpr double kMinFragment = 1e-9;  // of the solid's volume
constexpr double kCutSlab = 5e-3;      // of the solid's diagonal: thinnest slab cut off
constexpr double kWorthAhead = 2e-3;   // of the solid's excess: less is cut greedily
constexpr std::size_t kFlatPlanes = 24;  // a solid with more concave planes is taken as curved
constexpr double kSmallest = 0.02;       // of the solid's diagonal: smaller pieces are not halved
constexpr double kElongated = 0.8;       // ratio of the two least principal moments
constexpr int kFeatures = 8;             // feature heights tried along a direction

// Returns the nearest multiple of `step` (0: the value).
double InSteps(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

// Returns the remaining excess, the objective of the search: the volume that the hulls add, in
// steps of a ten-thousandth of `whole`, the excess before the cut, so that ties do not depend on
// rounding.
double Excess(const std::vector<Piece>& pieces, double whole) {
  double sum = 0.0;
  for (const Piece& piece : pieces) sum += piece.Excess();
  return InSteps(sum, kSameExcess * whole);
}

// Returns the heights along `axis` at which the surface has flat faces perpendicular to it or
// concave creases, by descending weight: a cut there leaves no remainder.
std::vector<double> FeatureHeights(const core::TriangleMesh& mesh, const Vector3d& axis,
                                   double width, int most) {
  std::map<long, double> weight, moment;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const Vector3d area = core::TriangleAreaVector(mesh, t);
    const double along = std::abs(axis.dot(area));
    if (!(along > 0.999 * area.norm()) || along == 0.0) continue;
    const auto& v = mesh.triangles[t];
    const double height =
        axis.dot(mesh.vertices[v[0]] + mesh.vertices[v[1]] + mesh.vertices[v[2]]) / 3.0;
    const long cell = std::lround(height / width);
    weight[cell] += along;
    moment[cell] += along * height;
  }
  std::vector<std::pair<double, double>> by_weight;
  double heaviest = 0.0;
  for (const auto& [cell, w] : weight) heaviest = std::max(heaviest, w);
  for (const auto& [cell, w] : weight) {
    by_weight.emplace_back(-InSteps(w, 1e-4 * heaviest), moment[cell] / w);
  }
  std::sort(by_weight.begin(), by_weight.end());
  std::vector<double> heights;
  for (const auto& [w, height] : by_weight) {
    if (static_cast<int>(heights.size()) == most) break;
    heights.push_back(height);
  }
  return heights;
}

void AddPlanes(const Piece& piece, const Vector3d& axis, int count, const CutContext& context,
               std::vector<CutPlane>* planes) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector3d& p : piece.hull.vertices) {
    low = std::min(low, axis.dot(p));
    high = std::max(high, axis.dot(p));
  }
  const double slab = kCutSlab * context.diagonal;
  if (high - low < 2.0 * slab) return;
  std::vector<double> heights =
      FeatureHeights(piece.mesh, axis, 0.1 * slab, std::min(count, kFeatures));
  for (int i = 0; i < count; ++i) heights.push_back(low + (high - low) * (i + 1) / (count + 1));
  std::vector<double> taken;
  for (const double height : heights) {
    const double margin = 0.2 * slab;
    if (height < low + margin || height > high - margin) continue;
    const bool near = std::any_of(taken.begin(), taken.end(),
                                  [&](double t) { return std::abs(t - height) < margin; });
    if (near) continue;
    taken.push_back(height);
    planes->push_back({axis, height});
  }
}

// Returns true if a principal moment differs clearly from the other two: its axis does not depend
// on rounding.
bool IsDistinct(const Vector3d& moments, int k) {
  const double least = std::min(std::abs(moments[k] - moments[(k + 1) % 3]),
                                std::abs(moments[k] - moments[(k + 2) % 3]));
  return least > kSameMoment * moments.maxCoeff();
}

// Returns the normals of candidate cuts: the axes, and the piece's principal axes if they differ.
std::vector<Vector3d> CutDirections(const Piece& piece, bool own) {
  std::vector<Vector3d> directions{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  if (!own) return directions;
  const MassProperties properties = ShellMassProperties(piece.mesh, 1.0, 1.0);
  const PrincipalInertia principal = PrincipalInertiaOf(properties.inertia);
  const Eigen::Matrix3d axes = principal.axes.toRotationMatrix();
  for (int k = 0; k < 3; ++k) {
    if (!IsDistinct(principal.moments, k)) continue;
    const bool other = std::all_of(directions.begin(), directions.end(), [&](const Vector3d& d) {
      return std::abs(d.dot(axes.col(k))) < std::cos(0.12);
    });
    if (other) directions.push_back(axes.col(k));
  }
  return directions;
}

// Returns the planes of the flat faces at concave edges, with `halving` also the planes that halve
// these edges' angles, by descending weight (an edge's length times the sine of its angle): a cut
// there turns the edges into convex ones. Nearly equal planes count as one.
std::vector<CutPlane> ConcaveEdgePlanes(const core::TriangleMesh& mesh, double width, bool halving,
                                        std::size_t most) {
  constexpr double kConcaveSine = 0.08;
  struct Weighed {
    CutPlane plane;
    double weight;
  };
  std::vector<Weighed> found;
  const auto add = [&](Vector3d normal, const Vector3d& through, double weight) {
    // One orientation, so that opposite normals compare equal.
    int k = 0;
    normal.cwiseAbs().maxCoeff(&k);
    if (normal[k] < 0.0) normal = -normal;
    const double offset = normal.dot(through);
    for (Weighed& known : found) {
      if (known.plane.normal.dot(normal) < 0.9995) continue;
      if (std::abs(known.plane.normal.dot(through) - known.plane.offset) > width) continue;
      known.weight += weight;
      return;
    }
    found.push_back({{normal, offset}, weight});
  };
  const std::vector<EdgeUse> uses = SortedEdgeUses(mesh);
  for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
    if (uses[i].key != uses[i + 1].key || uses[i].forward == uses[i + 1].forward) continue;
    const EdgeUse& first = uses[i].forward ? uses[i] : uses[i + 1];
    const EdgeUse& second = uses[i].forward ? uses[i + 1] : uses[i];
    const Vector3d& from = mesh.vertices[first.key >> 32];
    const Vector3d edge = mesh.vertices[first.key & 0xffffffffu] - from;
    const Vector3d a = core::TriangleAreaVector(mesh, first.triangle).normalized();
    const Vector3d b = core::TriangleAreaVector(mesh, second.triangle).normalized();
    const double sine = -a.cross(b).dot(edge.normalized());
    if (!(sine > kConcaveSine)) continue;
    const double weight = sine * edge.norm();
    add(a, from, weight);
    add(b, from, weight);
    if (halving) add((a - b).normalized(), from, weight);
  }
  double heaviest = 0.0;
  for (const Weighed& each : found) heaviest = std::max(heaviest, each.weight);
  for (Weighed& each : found) each.weight = InSteps(each.weight, 1e-4 * heaviest);
  std::stable_sort(found.begin(), found.end(),
                   [](const Weighed& a, const Weighed& b) { return a.weight > b.weight; });
  std::vector<CutPlane> planes;
  for (std::size_t i = 0; i < found.size() && i < most; ++i) {
    planes.push_back(found[i].plane);
  }
  return planes;
}

// Returns true if the plane leaves a slab of sufficient thickness on both sides of a hull.
bool CrossesHull(const core::TriangleMesh& hull, const CutPlane& plane, double margin) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector3d& p : hull.vertices) {
    low = std::min(low, plane.normal.dot(p));
    high = std::max(high, plane.normal.dot(p));
  }
  return low + margin < plane.offset && plane.offset < high - margin;
}

std::vector<CutPlane> Candidates(const Piece& piece, int count, bool own,
                                 const CutContext& context) {
  std::vector<CutPlane> planes;
  for (const Vector3d& axis : CutDirections(piece, own)) {
    AddPlanes(piece, axis, count, context, &planes);
  }
  const double slab = kCutSlab * context.diagonal;
  for (const CutPlane& plane :
       ConcaveEdgePlanes(piece.mesh, 0.1 * slab, true, static_cast<std::size_t>(count))) {
    const bool known = std::any_of(planes.begin(), planes.end(), [&](const CutPlane& other) {
      return std::abs(other.normal.dot(plane.normal)) > 0.9995 &&
             std::abs(other.offset - plane.offset) < 0.1 * slab;
    });
    if (!known && CrossesHull(piece.hull, plane, 0.2 * slab)) planes.push_back(plane);
  }
  return planes;
}

struct Trial {
  CutPlane plane;
  double excess = std::numeric_limits<double>::infinity();  // after the cut
  std::vector<Piece> pieces;
};

// Returns the `beam` best trials, excluding nearly equal planes.
std::vector<int> BestTrials(const std::vector<Trial>& trials, double apart, int beam) {
  std::vector<int> order(trials.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return trials[a].excess < trials[b].excess; });
  std::vector<int> best;
  for (const int i : order) {
    if (static_cast<int>(best.size()) == beam || !std::isfinite(trials[i].excess)) break;
    const bool near = std::any_of(best.begin(), best.end(), [&](int j) {
      return trials[j].plane.normal.dot(trials[i].plane.normal) > 0.99 &&
             std::abs(trials[j].plane.offset - trials[i].plane.offset) < apart;
    });
    if (!near) best.push_back(i);
  }
  return best;
}

// Returns the smallest excess that `depth` further cuts can reach for a piece.
double ExcessAhead(const Piece& piece, int depth, double negligible, const CutContext& context) {
  const double now = piece.Excess();
  if (depth == 0 || now <= negligible) return now;
  double best = now;
  // Fewer candidates than for the actual cuts: the estimate only has to rank first cuts.
  const int count = std::max(3, context.options->candidates / 3);
  for (const CutPlane& plane : Candidates(piece, count, false, context)) {
    const std::vector<Piece> pieces = CutPiece(piece, plane, context);
    if (pieces.empty()) continue;
    double sum = 0.0;
    for (const Piece& p : pieces) sum += ExcessAhead(p, depth - 1, negligible, context);
    best = std::min(best, sum);
  }
  return best;
}

}  // namespace

Piece MakePiece(core::TriangleMesh mesh, const CutContext& context) {
  Piece piece;
  piece.mesh = std::move(mesh);
  piece.volume = SignedVolume(piece.mesh);
  piece.hull =
      ThickenedConvexHull(piece.mesh.vertices, context.options->min_thickness * context.diagonal);
  piece.hull_volume = SignedVolume(piece.hull);
  piece.concavity = -1.0;
  return piece;
}

std::vector<Piece> CutPiece(const Piece& piece, const CutPlane& plane, const CutContext& context) {
  std::vector<Piece> pieces;
  for (core::TriangleMesh& mesh : SplitByPlane(piece.mesh, plane, kOnPlane * context.diagonal)) {
    if (SignedVolume(mesh) < kMinFragment * context.solid_volume &&
        core::Bounds(mesh).diagonal().norm() <
            10 * context.options->min_thickness * context.diagonal) {
      continue;
    }
    pieces.push_back(MakePiece(std::move(mesh), context));
  }
  if (pieces.size() < 2) pieces.clear();
  return pieces;
}

std::vector<Piece> Halved(const Piece& piece, const CutContext& context) {
  const Eigen::AlignedBox3d box = core::Bounds(piece.hull);
  int axis = 0;
  if (box.sizes().maxCoeff(&axis) < kSmallest * context.diagonal) return {};
  CutPlane plane{Vector3d::Unit(axis), box.center()[axis]};
  const MassProperties mass = ShellMassProperties(piece.mesh, 1.0, 1.0);
  const PrincipalInertia principal = PrincipalInertiaOf(mass.inertia);  // moments ascend
  if (principal.moments[0] < kElongated * principal.moments[1]) {
    plane.normal = principal.axes.toRotationMatrix().col(0);
    plane.offset = plane.normal.dot(mass.center_of_mass);
  }
  return CutPiece(piece, plane, context);
}

std::vector<Piece> FlatCut(const Piece& piece, const CutContext& context) {
  const double slab = kCutSlab * context.diagonal;
  const std::vector<CutPlane> planes =
      ConcaveEdgePlanes(piece.mesh, 0.1 * slab, false, kFlatPlanes + 1);
  if (planes.size() > kFlatPlanes) return {};
  std::vector<Trial> trials(planes.size());
  core::ParallelFor(static_cast<int>(planes.size()), [&](int i) {
    trials[i].plane = planes[i];
    if (!CrossesHull(piece.hull, planes[i], 0.2 * slab)) return;
    trials[i].pieces = CutPiece(piece, planes[i], context);
    if (!trials[i].pieces.empty()) trials[i].excess = Excess(trials[i].pieces, piece.Excess());
  });
  const std::vector<int> best = BestTrials(trials, 0.0, 1);
  if (best.empty()) return {};
  return std::move(trials[best[0]].pieces);
}

std::vector<Piece> BestCut(const Piece& piece, const CutContext& context) {
  const DecompositionOptions& options = *context.options;
  const std::vector<CutPlane> planes =
      Candidates(piece, options.candidates, options.principal_axes, context);
  std::vector<Trial> trials(planes.size());
  core::ParallelFor(static_cast<int>(planes.size()), [&](int i) {
    trials[i].plane = planes[i];
    trials[i].pieces = CutPiece(piece, planes[i], context);
    if (!trials[i].pieces.empty()) trials[i].excess = Excess(trials[i].pieces, piece.Excess());
  });
  const bool ahead = options.depth > 1 && piece.Excess() > kWorthAhead * context.excess;
  const double apart = 0.02 * core::Bounds(piece.hull).diagonal().norm();
  const std::vector<int> best = BestTrials(trials, apart, ahead ? options.beam : 1);
  if (best.empty()) return {};
  if (best.size() == 1) return std::move(trials[best[0]].pieces);

  struct Item {
    int trial;
    const Piece* piece;
    double ahead = 0.0;
  };
  std::vector<Item> items;
  for (const int t : best) {
    for (const Piece& p : trials[t].pieces) items.push_back({t, &p});
  }
  const double negligible = 0.02 * piece.Excess();
  core::ParallelFor(static_cast<int>(items.size()), [&](int i) {
    items[i].ahead = ExcessAhead(*items[i].piece, options.depth - 1, negligible, context);
  });
  int chosen = best[0];
  double least = std::numeric_limits<double>::infinity();
  for (const int t : best) {
    // Tie-breaker: the cut with the larger immediate gain.
    double sum = 0.05 * trials[t].excess;
    for (const Item& item : items) sum += item.trial == t ? item.ahead : 0.0;
    sum = InSteps(sum, kSameExcess * piece.Excess());
    if (sum < least) {
      least = sum;
      chosen = t;
    }
  }
  return std::move(trials[chosen].pieces);
}

}  // namespace simwright::geometry
