#include "asset_lift/radiance_field/field_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "asset_lift/radiance_field/field_targets.h"
#include "core/error.h"
#include "core/parallel.h"
#include "geometry/isosurface.h"
#include "geometry/nested_components.h"
#include "geometry/weld.h"
#include "render/forward.h"

namespace simwright::asset_lift {
namespace {

// The silhouette IoU difference within which levels tie; the middle one of them is used.
constexpr double kTie = 0.004;

// Returns the negated densities (per half side) at the grid nodes: inside is below the level.
geometry::ScalarGrid SampleDensity(const FieldFit& fit, int resolution) {
  const RadianceFieldOptions& cube = fit.field.options();
  geometry::ScalarGrid grid;
  grid.nx = grid.ny = grid.nz = resolution + 1;
  grid.cell = 2.0 * cube.half_side / resolution;
  grid.origin = cube.center - Eigen::Vector3d::Constant(cube.half_side);
  grid.values.assign(static_cast<std::size_t>(grid.nx) * grid.ny * grid.nz, 0.0f);
  const auto unit = [&](int i) { return static_cast<float>(2.0 * i / resolution - 1.0); };
  core::ParallelFor(grid.nz, [&](int k) {
    core::CheckCancelled();
    FieldBatch<float> batch = {};
    std::vector<std::size_t> where;
    const auto flush = [&] {
      fit.field.Evaluate(&batch);
      for (std::size_t s = 0; s < where.size(); ++s) grid.values[where[s]] = -batch.density[s];
      where.clear();
    };
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        if (!fit.occupancy.Allowed(unit(i), unit(j), unit(k))) continue;
        const std::size_t s = where.size();
        batch.position[0][s] = unit(i);
        batch.position[1][s] = unit(j);
        batch.position[2][s] = unit(k);
        where.push_back(grid.Index(i, j, k));
        if (where.size() == kFieldBatch) flush();
      }
    }
    if (!where.empty()) flush();
  });
  return grid;
}

// Renders silhouettes from the views' cameras and compares them with the masks.
class SilhouetteScore {
 public:
  SilhouetteScore(const std::vector<ObservedView>& views, int side) {
    for (const ObservedView& view : views) views_.push_back(ScaledView(view, side));
  }

  // Returns the sum of the minima over the sum of the maxima of coverage and opacity, mean over the
  // views.
  double Iou(const core::TriangleMesh& mesh) const {
    if (mesh.empty()) return 0.0;
    core::TexturedMesh textured;
    textured.mesh = mesh;
    render::Scene scene;
    scene.Add(&textured);
    scene.Commit();
    render::ForwardOptions options;
    options.samples_per_side = 2;
    double sum = 0.0;
    for (const ObservedView& view : views_) {
      core::CheckCancelled();
      const std::vector<float> mask = render::RenderForward(scene, view.camera, options).mask;
      double both = 0.0, either = 0.0;
      for (std::size_t i = 0; i < mask.size(); ++i) {
        both += std::min(mask[i], view.opacity.values[i]);
        either += std::max(mask[i], view.opacity.values[i]);
      }
      sum += both / either;
    }
    return sum / static_cast<double>(views_.size());
  }

 private:
  std::vector<ObservedView> views_;
};

core::TriangleMesh WithComponents(const core::TriangleMesh& mesh, const std::vector<int>& component,
                                  const std::vector<bool>& kept) {
  core::TriangleMesh chosen;
  chosen.vertices = mesh.vertices;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (kept[component[t]]) chosen.triangles.push_back(mesh.triangles[t]);
  }
  return geometry::WithoutUnusedVertices(chosen);
}

// Returns the largest component and the components that the masks require, with cavities filled.
core::TriangleMesh Chosen(const core::TriangleMesh& mesh, const SilhouetteScore& score,
                          double gain) {
  int count = 0;
  const std::vector<int> component = geometry::EdgeComponents(mesh, &count);
  const std::vector<double> volume = geometry::ComponentVolumes(mesh, component, count);
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return volume[a] > volume[b]; });
  std::vector<bool> kept(count, false);
  kept[order[0]] = true;
  // Only a few components can affect a silhouette; those below a thousandth of the largest do not.
  constexpr int kMostTried = 8;
  core::TriangleMesh chosen = WithComponents(mesh, component, kept);
  double iou = count > 1 ? score.Iou(chosen) : 0.0;
  for (int n = 1; n < std::min(count, kMostTried); ++n) {
    if (volume[order[n]] < 1e-3 * volume[order[0]]) break;
    kept[order[n]] = true;
    core::TriangleMesh more = WithComponents(mesh, component, kept);
    const double with = score.Iou(more);
    if (with > iou + gain) {
      iou = with;
      chosen = std::move(more);
    } else {
      kept[order[n]] = false;
    }
  }
  // A component inside another's filled cavity bounds no volume any more.
  geometry::RemoveBuriedComponents(&chosen);
  return chosen;
}

struct Candidate {
  double level = 0.0;  // per half side
  core::TriangleMesh mesh;
  double iou = 0.0;
};

std::vector<Candidate> Candidates(const geometry::ScalarGrid& grid,
                                  const std::vector<double>& levels, const SilhouetteScore& score) {
  std::vector<Candidate> candidates;
  for (const double level : levels) {
    Candidate candidate;
    candidate.level = level;
    candidate.mesh = geometry::ExtractIsosurface(grid, static_cast<float>(-level));
    if (candidate.mesh.empty()) continue;
    candidate.iou = score.Iou(candidate.mesh);
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

// Returns the best candidate, or the middle one of neighbours that tie.
const Candidate& Best(const std::vector<Candidate>& candidates) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    if (candidates[i].iou > candidates[best].iou) best = i;
  }
  std::size_t first = best, last = best;
  const double enough = candidates[best].iou - kTie;
  while (first > 0 && candidates[first - 1].iou >= enough) --first;
  while (last + 1 < candidates.size() && candidates[last + 1].iou >= enough) ++last;
  return candidates[(first + last) / 2];
}

// Returns the part of the cube that the masks allow, or the cube.
Candidate Carved(const FieldFit& fit, geometry::ScalarGrid grid, const SilhouetteScore& score) {
  const int last = grid.nx - 1;
  for (int k = 0; k <= last; ++k) {
    for (int j = 0; j <= last; ++j) {
      for (int i = 0; i <= last; ++i) {
        const bool allowed =
            fit.occupancy.Allowed(2.0 * i / last - 1.0, 2.0 * j / last - 1.0, 2.0 * k / last - 1.0);
        grid.values[grid.Index(i, j, k)] = allowed ? -1.0f : 1.0f;
      }
    }
  }
  Candidate candidate;
  candidate.mesh = geometry::ExtractIsosurface(grid, 0.0f);
  if (candidate.mesh.empty()) {
    std::fill(grid.values.begin(), grid.values.end(), -1.0f);
    candidate.mesh = geometry::ExtractIsosurface(grid, 0.0f);
  }
  candidate.iou = score.Iou(candidate.mesh);
  return candidate;
}

Candidate FaintSurface(const FieldFit& fit, const geometry::ScalarGrid& grid,
                       const SilhouetteScore& score, core::Findings* findings) {
  float largest = 0.0f;
  for (const float value : grid.values) largest = std::max(largest, -value);
  std::vector<Candidate> candidates;
  if (largest > 0.0f) {
    candidates =
        Candidates(grid, {0.05 * largest, 0.1 * largest, 0.25 * largest, 0.5 * largest}, score);
  }
  const bool nothing = candidates.empty();
  findings->push_back(
      {"field-surface-faint", core::Severity::kWarning, "radiance field",
       nothing ? "the field is empty: the surface is the intersection of the masks' cones"
               : "the field is nearly empty: the surface is at a fraction of its "
                 "maximum density",
       largest});
  return nothing ? Carved(fit, grid, score) : Best(candidates);
}

}  // namespace

bool FieldSurfaceOptions::IsValid(std::string* error) const {
  const char* fault = nullptr;
  if (resolution < 8 || resolution > 512) fault = "the resolution must be 8 to 512 cells per side";
  if (levels.empty()) fault = "levels must not be empty";
  for (const double level : levels) {
    if (!(level > 0.0) || !std::isfinite(level)) fault = "levels must be positive";
  }
  if (silhouette_side < 8) fault = "silhouette_side must be at least 8";
  if (fault != nullptr && error != nullptr) *error = fault;
  return fault == nullptr;
}

FieldSurface ExtractSurface(const FieldFit& fit, const std::vector<ObservedView>& views,
                            const FieldSurfaceOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "field surface");
  RequireValidViews(views);
  const SilhouetteScore score(views, options.silhouette_side);
  const geometry::ScalarGrid grid = SampleDensity(fit, options.resolution);
  std::vector<double> levels = options.levels;
  std::sort(levels.begin(), levels.end());
  const std::vector<Candidate> candidates = Candidates(grid, levels, score);
  FieldSurface surface;
  const Candidate chosen =
      candidates.empty() ? FaintSurface(fit, grid, score, &surface.findings) : Best(candidates);
  const double half_side = fit.field.options().half_side;
  surface.level = chosen.level / half_side;
  surface.mesh = Chosen(chosen.mesh, score, options.component_gain);
  surface.iou = score.Iou(surface.mesh);
  if (surface.iou < options.good_iou) {
    surface.findings.push_back({"field-surface-silhouette", core::Severity::kWarning,
                                "radiance field",
                                "the surface's silhouette disagrees with the mask", surface.iou});
  }
  surface.colors = SurfaceColors(fit.field, surface.mesh.vertices,
                                 core::VertexNormals(surface.mesh), 2.0 * grid.cell);
  return surface;
}

std::vector<Eigen::Vector3f> SurfaceColors(const RadianceField& field,
                                           const std::vector<Eigen::Vector3d>& points,
                                           const std::vector<Eigen::Vector3d>& normals,
                                           double depth) {
  if (points.size() != normals.size()) {
    throw core::Error("points and normals must be equal in number", "surface colours");
  }
  constexpr int kSteps = 9;
  const double step = 2.0 * depth / (kSteps - 1);
  std::vector<Eigen::Vector3d> along;
  along.reserve(kSteps * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < kSteps; ++k) along.push_back(points[i] + (depth - k * step) * normals[i]);
  }
  const std::vector<float> density = field.DensityAt(along);
  const std::vector<Eigen::Vector3f> color = field.ColorAt(along);
  std::vector<Eigen::Vector3f> colors(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    // The last step takes the remaining transmittance, so that the weights sum to one.
    float left = 1.0f;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int k = 0; k < kSteps; ++k) {
      const std::size_t at = kSteps * i + k;
      const float through = std::exp(-density[at] * static_cast<float>(step));
      const float weight = k + 1 < kSteps ? left * (1.0f - through) : left;
      sum += weight * color[at];
      left -= weight;
    }
    colors[i] = sum;
  }
  return colors;
}

}  // namespace simwright::asset_lift
