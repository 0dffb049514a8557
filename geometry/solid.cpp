#include "geometry/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/progress.h"
#include "geometry/alpha_wrap.h"
#include "geometry/cluster_vertices.h"
#include "geometry/manifold_split.h"
#include "geometry/mesh_validity.h"
#include "geometry/nested_components.h"
#include "geometry/occlusion_sampling.h"
#include "geometry/self_intersection_smoothing.h"
#include "geometry/simplify.h"
#include "geometry/surface_distance.h"
#include "geometry/surface_wrap.h"
#include "geometry/weld.h"
#include "geometry/weld_components.h"

namespace simwright::geometry {
namespace {

using core::Severity;
using core::TriangleMesh;
using Eigen::Vector3d;

void Add(Solid* solid, const char* code, Severity severity, const std::string& sentence,
         double figure) {
  solid->findings.push_back({code, severity, "solid", sentence, figure});
}

// Keeps the faces of the outermost shells; returns false if some shell is not closed or shells
// intersect.
bool KeepOuterShells(TriangleMesh* mesh, int* dropped) {
  *dropped = 0;
  TriangleMesh oriented = *mesh;
  if (!OrientConsistently(&oriented)) return false;
  const MeshValidity state = Examine(oriented, 1);
  if (!state.closed || !state.manifold || state.self_intersections > 0 ||
      state.degenerate_triangles > 0) {
    return false;
  }
  int count = 0;
  const std::vector<int> component = EdgeComponents(oriented, &count);
  const std::vector<int> winding = EnclosingWindingNumbers(oriented, component, count);
  TriangleMesh kept;
  kept.vertices = oriented.vertices;
  for (std::size_t t = 0; t < component.size(); ++t) {
    if (winding[component[t]] == 0) kept.triangles.push_back(oriented.triangles[t]);
  }
  for (const int w : winding) *dropped += w != 0;
  *mesh = *dropped > 0 ? Weld(kept, 0.0) : kept;
  return Examine(*mesh, 1).IsSolid();
}

// Flat closed shells enclose no real volume, only rounding errors.
bool EnclosesVolume(const TriangleMesh& mesh, double diagonal) {
  return SignedVolume(mesh) > 1e-9 * diagonal * diagonal * diagonal;
}

bool TryUnchanged(const TriangleMesh& visual, const TriangleMesh& welded, double diagonal,
                  const SolidOptions& options, Solid* solid) {
  for (const double tolerance : {0.0, 1e-6, 1e-4}) {
    TriangleMesh mesh = tolerance > 0.0 ? Weld(welded, tolerance * diagonal) : welded;
    if (mesh.empty() || static_cast<double>(mesh.triangles.size()) > 10.0 * options.face_budget) {
      return false;
    }
    int shells = 0;
    if (!KeepOuterShells(&mesh, &shells) || !EnclosesVolume(mesh, diagonal)) continue;
    const int repeated =
        static_cast<int>(visual.triangles.size()) - static_cast<int>(welded.triangles.size());
    if (repeated > 0) {
      Add(solid, "solid-faces-dropped", Severity::kInfo,
          std::to_string(repeated) + " repeated or collapsed faces were dropped", repeated);
    }
    if (shells > 0) {
      Add(solid, "solid-inner-shells", Severity::kInfo,
          std::to_string(shells) + " inner shells were dropped", shells);
    }
    if (tolerance > 0.0) {
      Add(solid, "solid-stitched", Severity::kInfo,
          "vertices closer than " + std::to_string(tolerance * 100.0) +
              "% of the diagonal were joined to close cracks",
          tolerance * diagonal);
    }
    solid->mesh = std::move(mesh);
    solid->method = repeated > 0 || shells > 0 || tolerance > 0.0 ? SolidMethod::kRepaired
                                                                  : SolidMethod::kAsItIs;
    return true;
  }
  return false;
}

// Joins closed components that intersect.
bool TryUnion(const TriangleMesh& welded, double diagonal, const SolidOptions& options,
              Solid* solid) {
  if (static_cast<double>(welded.triangles.size()) > 10.0 * options.face_budget) return false;
  for (const double tolerance : {0.0, 1e-6, 1e-4}) {
    int count = 0;
    TriangleMesh mesh =
        UnionOfComponents(tolerance > 0.0 ? Weld(welded, tolerance * diagonal) : welded, &count);
    if (mesh.empty() || !EnclosesVolume(mesh, diagonal)) continue;
    Add(solid, "solid-parts-joined", Severity::kInfo,
        std::to_string(count) + " closed parts that intersect were joined into one surface", count);
    solid->mesh = std::move(mesh);
    solid->method = SolidMethod::kRepaired;
    return true;
  }
  return false;
}

// Lengths of repairs, as shares of the tolerance: how far smoothing moves a vertex, and the error
// of simplification, root mean square and at most. Walls may be as thin as the tolerance.
constexpr double kSmoothedShare = 0.3, kThinnedShare = 0.06, kThinnedMost = 0.2;
constexpr double kRepairedMost = 0.9;  // share of the tolerance, of a repaired solid's distance
constexpr int kSmoothingRounds = 6;
constexpr std::size_t kMostRepaired = 300000;  // faces: more take longer than a grid

// Mends closed components where they intersect or touch themselves, as noise and voxels leave them:
// parts what touches along edges, smooths what intersects. Returns false if a component is open or
// is not mended.
bool MendClosed(double move, TriangleMesh* mesh, int* intersections) {
  if (mesh->empty() || !OrientConsistently(mesh)) return false;
  MeshValidity state = Examine(*mesh, 1);
  if (!state.closed) return false;
  // Components that touch are parted; others may intersect each other, and are united.
  const bool touching = !state.manifold;
  if (touching) {
    *mesh = SplitNonManifold(*mesh);
    state = Examine(*mesh, 1);
    if (!state.closed || !state.manifold) return false;
  }
  *intersections = state.self_intersections;
  SelfIntersectionSmoothing smoothing;
  smoothing.rounds = kSmoothingRounds;
  smoothing.max_move = move;
  smoothing.within_components = !touching;
  smoothing.replaces_faces = true;
  if (!SmoothSelfIntersections(mesh, smoothing)) return false;
  *mesh = WithoutUnusedVertices(*mesh);
  return true;
}

// Repairs a closed surface without a grid, which keeps thin walls: mends it, joins its components,
// and simplifies it if it has too many faces.
bool TryRepair(const TriangleMesh& welded, double diagonal, const SolidOptions& options,
               Solid* solid) {
  if (welded.triangles.size() > kMostRepaired) return false;
  const double tolerated = options.tolerance_ratio * diagonal;
  for (const double tolerance : {0.0, 1e-6, 1e-4}) {
    TriangleMesh mesh = tolerance > 0.0 ? Weld(welded, tolerance * diagonal) : welded;
    int intersections = 0, shells = 0;
    if (!MendClosed(kSmoothedShare * tolerated, &mesh, &intersections)) continue;
    TriangleMesh whole = mesh;
    if (!KeepOuterShells(&whole, &shells)) whole = UnionOfComponents(mesh, &shells);
    if (whole.empty() || !EnclosesVolume(whole, diagonal)) continue;
    const std::size_t faces = whole.triangles.size();
    if (static_cast<double>(faces) > 10.0 * options.face_budget) {
      whole = Simplify(whole,
                       {options.face_budget, kThinnedShare * tolerated, kThinnedMost * tolerated});
      if (static_cast<double>(whole.triangles.size()) > 10.0 * options.face_budget ||
          !Examine(whole, 1).IsSolid()) {
        return false;
      }
      Add(solid, "solid-simplified", Severity::kInfo,
          std::to_string(faces) + " faces were simplified to " +
              std::to_string(whole.triangles.size()),
          static_cast<double>(whole.triangles.size()));
    }
    if (intersections > 0) {
      SurfaceDistanceOptions check;
      check.seed = 11;
      check.rays = 200000;
      check.solid_samples = 100000;
      const double distance = OuterSurfaceDistance(welded, whole, check).MaxRatio();
      if (distance > kRepairedMost * options.tolerance_ratio) return false;
      Add(solid, "solid-smoothed", Severity::kInfo,
          "the surface was smoothed where it intersects itself, by at most " +
              std::to_string(1000.0 * kSmoothedShare * tolerated) + " mm",
          kSmoothedShare * tolerated);
    }
    solid->mesh = std::move(whole);
    solid->method = SolidMethod::kRepaired;
    return true;
  }
  return false;
}

TriangleMesh Normalized(const TriangleMesh& mesh, const Vector3d& center, double scale) {
  TriangleMesh unit = mesh;
  for (Vector3d& v : unit.vertices) v = (v - center) / scale;
  return unit;
}

constexpr int kThinFirst = 300000;  // larger meshes are clustered before the grid
// The error allowed in simplification as a share of the tolerance, root mean square: half of the
// tolerance is left for the grid's own steps.
constexpr double kSimplifyShare = 0.15;
constexpr double kSimplifyMost = 0.35;  // and its maximum

struct Wrapped {
  TriangleMesh mesh;  // in the unit box
  double sheet_share = 0.0;
  double wall = 0.0;      // given to sheets, share of the diagonal
  double distance = 0.0;  // the larger of both directions, share of the diagonal
  int beyond = 0;         // random hits of SampleOccludedHits beyond the tolerance
};

// Compares by the number of hits beyond the tolerance, which a check is likely to find; the
// distance of the farthest single hit is a matter of chance.
bool Closer(const Wrapped& a, const Wrapped& b) {
  return a.beyond != b.beyond ? a.beyond < b.beyond : a.distance < b.distance;
}

// The settings of one wrap attempt. Each attempt also uses the slits in which the previous one
// failed.
struct Effort {
  double fineness;  // divisor of the cell, the wall (which would close gaps between sheets) and the
                    // simplification error
  int rays;         // lines of sight: more find hollows that few rays enter
  bool carves;      // also opens lines of sight through the walls given to sheets
};
constexpr Effort kEfforts[] = {
    {1.0, 100000, false}, {1.6, 200000, false}, {1.6, 500000, true}, {2.0, 500000, true}};
// The share of the tolerance at which a wrap is accepted: other rays find somewhat larger
// distances.
constexpr double kGoodEnough = 0.9;
constexpr double kProbeFrom = 0.7;  // share of the tolerance from which a region is probed
constexpr double kSlitDepth = 0.3;  // share of the diagonal along which a line of sight is followed

// Wraps `unit`, a mesh of diagonal 1. `sights` are lines of sight besides the random ones.
Wrapped WrapOnce(const TriangleMesh& unit, const Effort& effort,
                 const std::vector<OuterHit>& sights, const SolidOptions& options) {
  const double fineness = effort.fineness;
  SurfaceWrapOptions wrap_options;
  wrap_options.wall = options.sheet_thickness_ratio / fineness;
  wrap_options.cell = options.cell_ratio / fineness;
  while (WrapGridNodes(unit, wrap_options) > options.max_nodes) wrap_options.cell *= 1.1;
  wrap_options.closing = wrap_options.cell;
  wrap_options.visible_hits = SampleOuterHits(unit, effort.rays, 7);
  wrap_options.visible_hits.insert(wrap_options.visible_hits.end(), sights.begin(), sights.end());
  if (effort.carves) wrap_options.reach = 0.7 * options.tolerance_ratio;
  const SurfaceWrap wrap = WrapSurface(unit, wrap_options);
  if (wrap.mesh.empty()) {
    throw core::Error("no surface could be wrapped around the mesh", "solid");
  }
  Wrapped wrapped;
  wrapped.mesh =
      Simplify(wrap.mesh, {options.face_budget, kSimplifyShare * options.tolerance_ratio / fineness,
                           kSimplifyMost * options.tolerance_ratio / fineness});
  // Removes specks that simplification moved into a neighbour.
  RemoveBuriedComponents(&wrapped.mesh);
  wrapped.sheet_share = wrap.sheet_share;
  wrapped.wall = wrap_options.wall;
  SurfaceDistanceOptions check;
  check.seed = 11;  // rays that differ from those used for the wrap
  check.rays = 400000;
  check.solid_samples = 200000;
  wrapped.distance = OuterSurfaceDistance(unit, wrapped.mesh, check).MaxRatio();
  return wrapped;
}

// Returns lines of sight into the regions where a wrap is barely within the tolerance: points
// beyond it are often nearby, in slits too narrow for random rays. Updates the distances of
// `wrapped`.
std::vector<OuterHit> ProbeDoubtfulRegions(const TriangleMesh& unit, std::uint64_t seed,
                                           const SolidOptions& options, Wrapped* wrapped) {
  // The solid's largest distance from the visible surface is usually at one of its corners.
  for (const double d : DistancesToSurface(wrapped->mesh.vertices, unit)) {
    wrapped->distance = std::max(wrapped->distance, d);
  }
  OcclusionSamplingOptions hidden;
  hidden.reach = kProbeFrom * options.tolerance_ratio;
  if (wrapped->distance <= hidden.reach) return {};
  hidden.radius = kSlitDepth;
  hidden.seed = seed;
  int random_count = 0;
  const std::vector<OuterHit> sights =
      SampleOccludedHits(unit, wrapped->mesh, hidden, &random_count);
  std::vector<Vector3d> ends;
  for (const OuterHit& hit : sights) ends.push_back(hit.point);
  const std::vector<double> distances = DistancesToSurface(ends, wrapped->mesh);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    wrapped->distance = std::max(wrapped->distance, distances[i]);
    wrapped->beyond += static_cast<int>(i) < random_count && distances[i] > options.tolerance_ratio;
  }
  return sights;
}

void WrapSolid(const TriangleMesh& welded, const Vector3d& center, double diagonal,
               const SolidOptions& options, Solid* solid) {
  TriangleMesh unit = Normalized(welded, center, diagonal);
  if (static_cast<int>(unit.triangles.size()) > kThinFirst) {
    unit = ClusterVertices(unit, options.cell_ratio / 3.0);
  }
  Wrapped wrapped;
  wrapped.beyond = std::numeric_limits<int>::max();
  std::vector<OuterHit> sights;
  for (const Effort& effort : kEfforts) {
    Wrapped next = WrapOnce(unit, effort, sights, options);
    const std::vector<OuterHit> more =
        ProbeDoubtfulRegions(unit, 100 + sights.size(), options, &next);
    sights.insert(sights.end(), more.begin(), more.end());
    if (Closer(next, wrapped)) wrapped = std::move(next);
    if (wrapped.distance <= kGoodEnough * options.tolerance_ratio) break;
  }
  TriangleMesh mesh = std::move(wrapped.mesh);
  for (Vector3d& v : mesh.vertices) v = center + diagonal * v;
  solid->method = SolidMethod::kWrapped;
  if (!Examine(mesh, 1).IsSolid()) {
    Add(solid, "solid-alpha-wrap", Severity::kWarning,
        "the wrapped surface was not a valid solid; alpha wrapping replaced it", 0.0);
    mesh = AlphaWrap(welded);
    if (!Examine(mesh, 1).IsSolid()) {
      throw core::Error("no closed surface free of self-intersections could be made", "solid",
                        "simplify or repair the mesh in a modeller");
    }
  }
  if (wrapped.sheet_share > 0.001) {
    solid->sheet_thickness = wrapped.wall * diagonal;
    Add(solid, "solid-sheets", Severity::kInfo,
        "thin sheets and open surfaces were given a wall of " +
            std::to_string(solid->sheet_thickness * 1000.0) + " mm",
        solid->sheet_thickness);
  }
  if (static_cast<int>(mesh.triangles.size()) > options.face_budget) {
    Add(solid, "solid-over-budget", Severity::kInfo,
        "the shape needs " + std::to_string(mesh.triangles.size()) +
            " faces to stay within the tolerance",
        static_cast<double>(mesh.triangles.size()));
  }
  if (wrapped.distance > options.tolerance_ratio) {
    Add(solid, "solid-off-tolerance", Severity::kWarning,
        "the solid deviates by up to " + std::to_string(100.0 * wrapped.distance) +
            "% of the diagonal from the visible surface",
        wrapped.distance);
  }
  solid->mesh = std::move(mesh);
}

}  // namespace

const char* Name(SolidMethod method) {
  switch (method) {
    case SolidMethod::kAsItIs:
      return "as it is";
    case SolidMethod::kRepaired:
      return "repaired";
    case SolidMethod::kWrapped:
      return "wrapped";
  }
  return "unknown";
}

Solid MakeSolid(const TriangleMesh& visual, const SolidOptions& options) {
  core::RequireValid(visual, "solid");
  if (visual.empty()) {
    throw core::Error("the mesh has no faces", "solid", "give a mesh with triangles");
  }
  const TriangleMesh welded = Weld(visual, 0.0);
  if (welded.empty()) {
    throw core::Error("every face of the mesh is a line or a point", "solid",
                      "give a mesh with an extent");
  }
  const Eigen::AlignedBox3d bounds = core::Bounds(welded);
  const double diagonal = bounds.diagonal().norm();
  if (!(diagonal > 1e-100) || !(diagonal < 1e100)) {
    throw core::Error("the mesh's extent is out of range", "solid",
                      "check its unit and its vertices");
  }
  Solid solid;
  if (!TryUnchanged(visual, welded, diagonal, options, &solid) &&
      !TryUnion(welded, diagonal, options, &solid) &&
      !TryRepair(welded, diagonal, options, &solid)) {
    WrapSolid(welded, bounds.center(), diagonal, options, &solid);
  }
  return solid;
}

}  // namespace simwright::geometry
