#include "importers/link_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/Eigenvalues>

#include "assets/mesh_import.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/convex_decomposition.h"
#include "geometry/convex_hull.h"
#include "geometry/mesh_validity.h"
#include "geometry/solid.h"
#include "geometry/surface_distance.h"
#include "geometry/weld.h"

namespace simwright::importers {
namespace {

using assets::UrdfLink;
using assets::UrdfShape;

constexpr size_t kMostParts = 256;     // per link
constexpr double kSheet = 2e-3;        // m, the thickness given to a flat component
constexpr double kSmall = 0.02;        // of the asset's diagonal: shorter components become hulls
constexpr double kConvexShare = 0.97;  // of its hull's volume, for a convex component
constexpr double kWeld = 1e-6;         // of a mesh's diagonal
constexpr size_t kMostTextureColors = 16;  // with more, a texture is averaged
// Components of half the asset's diagonal are as precise as rigid assets, those of a sixth a third
// as precise.
constexpr double kWholePrecision = 0.5, kCoarsest = 3.0;
constexpr int kFaceBudget = 8000;  // of a component's solid
constexpr int kHullSamples = 2000;

const std::vector<UrdfShape>& ShapesOf(const UrdfLink& link) {
  return link.visuals.empty() ? link.collisions : link.visuals;
}

Eigen::Vector4f MeanColor(const core::Image& image) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  const int count = image.width * image.height;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* pixel = image.At(x, y);
      for (int c = 0; c < 3; ++c) sum[c] += pixel[image.channels >= 3 ? c : 0];
    }
  }
  Eigen::Vector4f mean = (sum / (255.0 * std::max(count, 1))).cast<float>();
  mean.w() = 1.0f;
  return mean;
}

// Quantises a colour to 8 steps per channel, so that nearly equal ones become one.
Eigen::Vector4f Rounded(const Eigen::Vector4f& color) {
  return (color * 7.0f).array().round().matrix() / 7.0f;
}

// Returns the colour of a material's texture at the centre of each of its triangles if these are
// few colours (a colour palette, vertex colours); else returns an empty map.
std::map<size_t, Eigen::Vector4f> PaletteColors(const core::TexturedMesh& mesh, int material) {
  std::map<size_t, Eigen::Vector4f> colors;
  std::set<std::array<int, 3>> distinct;
  const int texture = mesh.materials[static_cast<size_t>(material)].texture;
  if (texture < 0 || mesh.corner_uvs.empty()) return colors;
  for (size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    if (mesh.triangle_material[t] != material) continue;
    const Eigen::Vector2f middle =
        (mesh.corner_uvs[3 * t] + mesh.corner_uvs[3 * t + 1] + mesh.corner_uvs[3 * t + 2]) / 3.0f;
    Eigen::Vector4f color =
        Rounded(core::SampleTexture(mesh.textures[static_cast<size_t>(texture)], middle));
    color.w() = 1.0f;
    distinct.insert({static_cast<int>(std::lround(7.0f * color[0])),
                     static_cast<int>(std::lround(7.0f * color[1])),
                     static_cast<int>(std::lround(7.0f * color[2]))});
    if (distinct.size() > kMostTextureColors) return {};
    colors.emplace(t, color);
  }
  return colors;
}

// Returns the colour of each triangle: its material's, times its texture's if that has few colours,
// or times the texture's mean.
std::vector<Eigen::Vector4f> TriangleColors(const core::TexturedMesh& mesh) {
  std::vector<Eigen::Vector4f> colors(mesh.mesh.triangles.size(), core::Material{}.base_color);
  if (mesh.triangle_material.empty()) return colors;
  for (size_t m = 0; m < mesh.materials.size(); ++m) {
    const core::Material& material = mesh.materials[m];
    const std::map<size_t, Eigen::Vector4f> asset_set = PaletteColors(mesh, static_cast<int>(m));
    Eigen::Vector4f mean = Eigen::Vector4f::Ones();
    if (material.texture >= 0 && asset_set.empty()) {
      mean = MeanColor(mesh.textures[static_cast<size_t>(material.texture)]);
    }
    for (size_t t = 0; t < colors.size(); ++t) {
      if (mesh.triangle_material[t] != static_cast<int>(m)) continue;
      const auto found = asset_set.find(t);
      colors[t] = material.base_color.cwiseProduct(found == asset_set.end() ? mean : found->second);
    }
  }
  return colors;
}

// Appends triangles by colour.
class Painter {
 public:
  void Add(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector4f>& colors) {
    core::Append(mesh, &visual_.mesh);
    for (const Eigen::Vector4f& color : colors) visual_.triangle_material.push_back(Index(color));
  }
  core::TexturedMesh Take() { return std::move(visual_); }

 private:
  int Index(const Eigen::Vector4f& color) {
    std::array<int, 4> key;
    for (int c = 0; c < 4; ++c) key[c] = static_cast<int>(std::lround(255.0f * color[c]));
    const auto [found, is_new] = index_of_.emplace(key, visual_.materials.size());
    if (is_new) {
      visual_.materials.push_back({"color_" + std::to_string(found->second), color, -1});
    }
    return static_cast<int>(found->second);
  }
  core::TexturedMesh visual_;
  std::map<std::array<int, 4>, size_t> index_of_;
};

// Splits a mesh into components connected by edges, each with its own vertices.
std::vector<core::TriangleMesh> ConnectedPieces(const core::TriangleMesh& mesh) {
  int count = 0;
  const std::vector<int> piece_of = geometry::EdgeComponents(mesh, &count);
  std::vector<core::TriangleMesh> pieces(static_cast<size_t>(count));
  std::vector<std::map<int, int>> index_of(pieces.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const size_t at = static_cast<size_t>(piece_of[t]);
    Eigen::Vector3i triangle = mesh.triangles[t];
    for (int& corner : triangle) {
      const auto [found, is_new] =
          index_of[at].emplace(corner, static_cast<int>(pieces[at].vertices.size()));
      if (is_new) pieces[at].vertices.push_back(mesh.vertices[static_cast<size_t>(corner)]);
      corner = found->second;
    }
    pieces[at].triangles.push_back(triangle);
  }
  return pieces;
}

// Splits a shape into connected components. Boards that touch share corners once they are welded:
// components that are closed by the file's own vertices stay separate, and only the rest is welded.
std::vector<core::TriangleMesh> PiecesOf(const core::TriangleMesh& shape) {
  const double tolerance = kWeld * core::Bounds(shape).diagonal().norm();
  std::vector<core::TriangleMesh> pieces;
  core::TriangleMesh rest;
  for (const core::TriangleMesh& piece : ConnectedPieces(shape)) {
    const core::TriangleMesh welded = geometry::Weld(piece, tolerance);
    if (!welded.empty() && geometry::Examine(welded, 1).closed) {
      pieces.push_back(welded);
    } else {
      core::Append(piece, &rest);
    }
  }
  if (rest.empty()) return pieces;
  for (core::TriangleMesh& piece : ConnectedPieces(geometry::Weld(rest, tolerance))) {
    if (core::Bounds(piece).diagonal().norm() > 0.0) pieces.push_back(std::move(piece));
  }
  return pieces;
}

// Returns true if a component is flat, so that its hull has almost no volume.
bool IsFlat(const core::TriangleMesh& piece) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& v : piece.vertices) mean += v;
  mean /= static_cast<double>(piece.vertices.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& v : piece.vertices) scatter += (v - mean) * (v - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const Eigen::Vector3d thinnest = solver.eigenvectors().col(0);
  double low = 0.0, high = 0.0;
  for (const Eigen::Vector3d& v : piece.vertices) {
    low = std::min(low, thinnest.dot(v - mean));
    high = std::max(high, thinnest.dot(v - mean));
  }
  return high - low < 0.5 * kSheet;
}

bool FillsItsHull(core::TriangleMesh piece, const core::TriangleMesh& hull) {
  if (!geometry::OrientConsistently(&piece) || !geometry::Examine(piece, 1).closed) return false;
  return std::abs(geometry::SignedVolume(piece)) > kConvexShare * geometry::SignedVolume(hull);
}

// Returns true if `hull` stays within the tolerance that the budget states, if any, of `piece`, and
// `thickness` (m) that it was given.
bool IsWithinTolerance(const core::TriangleMesh& hull, const core::TriangleMesh& piece,
                       double thickness, const asset_build::PartBudget& budget) {
  if (budget.tolerance == 0.0) return true;
  const auto farthest = [](const core::TriangleMesh& from, const core::TriangleMesh& to) {
    std::vector<Eigen::Vector3d> points = geometry::SampleSurface(from, kHullSamples, 1);
    points.insert(points.end(), from.vertices.begin(), from.vertices.end());  // also thin tips
    const std::vector<double> distances = geometry::DistancesToSurface(points, to);
    return *std::max_element(distances.begin(), distances.end());
  };
  return std::max(farthest(hull, piece), farthest(piece, hull)) <= budget.tolerance + thickness;
}

std::vector<core::TriangleMesh> PartsOfPiece(const core::TriangleMesh& piece, double whole,
                                             const asset_build::PartBudget& budget,
                                             const std::string& link, core::Findings* findings) {
  const int most_vertices = asset_build::MostVertices(budget);
  const double size = core::Bounds(piece).diagonal().norm();
  if (IsFlat(piece)) {
    core::TriangleMesh sheet = geometry::ThickenedConvexHull(piece.vertices, kSheet, most_vertices);
    if (IsWithinTolerance(sheet, piece, kSheet, budget)) return {std::move(sheet)};
  } else {
    const core::TriangleMesh hull = geometry::ConvexHull(piece.vertices);
    if (size < kSmall * whole || FillsItsHull(piece, hull)) {
      core::TriangleMesh one = geometry::ConvexHull(piece.vertices, most_vertices);
      if (IsWithinTolerance(one, piece, 0.0, budget)) return {std::move(one)};
    }
  }
  // Errors are relative to the whole asset: a small component may be coarser relative to its own
  // size.
  const double coarser = std::clamp(kWholePrecision * whole / size, 1.0, kCoarsest);
  geometry::SolidOptions solid;
  solid.face_budget = kFaceBudget;
  solid.cell_ratio *= coarser;
  solid.tolerance_ratio *= coarser;
  solid.sheet_thickness_ratio *= coarser;
  geometry::DecompositionOptions options;
  options.threshold *= coarser;
  options = asset_build::Limited(options, budget);
  const core::TriangleMesh closed = geometry::MakeSolid(piece, solid).mesh;
  const geometry::ConvexDecomposition decomposition = geometry::Decompose(closed, options);
  asset_build::ReportBinding(closed, options, budget, decomposition, link, findings);
  return geometry::Hulls(decomposition);
}

bool LiesInside(const core::TriangleMesh& inner, const core::TriangleMesh& outer) {
  const double tolerance = 1e-6 * core::Bounds(outer).diagonal().norm();
  for (size_t t = 0; t < outer.triangles.size(); ++t) {
    const Eigen::Vector3d normal =
        core::TriangleAreaVector(outer, static_cast<int>(t)).normalized();
    const Eigen::Vector3d& corner = outer.vertices[static_cast<size_t>(outer.triangles[t][0])];
    for (const Eigen::Vector3d& v : inner.vertices) {
      if (normal.dot(v - corner) > tolerance) return false;
    }
  }
  return true;
}

// Sorts parts by size, largest first, and removes those inside a larger one.
void KeepOutermost(std::vector<core::TriangleMesh>* parts) {
  std::stable_sort(parts->begin(), parts->end(), [](const auto& a, const auto& b) {
    return geometry::SignedVolume(a) > geometry::SignedVolume(b);
  });
  std::vector<core::TriangleMesh> kept;
  for (core::TriangleMesh& part : *parts) {
    const Eigen::AlignedBox3d box = core::Bounds(part);
    const bool inside = std::any_of(kept.begin(), kept.end(), [&](const auto& larger) {
      return core::Bounds(larger).intersects(box) && LiesInside(part, larger);
    });
    if (!inside) kept.push_back(std::move(part));
  }
  *parts = std::move(kept);
}

// Merges a link's parts to the number that the budget allows, and reports it.
void MergeToBudget(const asset_build::PartBudget& budget, const std::string& link,
                   std::vector<core::TriangleMesh>* parts, core::Findings* findings) {
  const size_t count = parts->size();
  if (budget.max_parts == 0 || count <= static_cast<size_t>(budget.max_parts)) return;
  double before = 0.0, after = 0.0;
  for (const core::TriangleMesh& part : *parts) before += geometry::SignedVolume(part);
  *parts =
      geometry::MergeHulls(std::move(*parts), budget.max_parts, asset_build::MostVertices(budget));
  for (const core::TriangleMesh& part : *parts) after += geometry::SignedVolume(part);
  char text[160];
  std::snprintf(text, sizeof text,
                "%zu collision parts were merged to %d, whose volumes add up to %.2f times theirs",
                count, budget.max_parts, after / before);
  findings->push_back({"part-budget", core::Severity::kWarning, link, text, after / before,
                       "allow more with --max-parts"});
}

}  // namespace

bool HasOwnCollisions(const UrdfLink& link) {
  return std::any_of(
      link.collisions.begin(), link.collisions.end(), [&](const UrdfShape& collision) {
        return collision.file.empty() ||
               std::none_of(link.visuals.begin(), link.visuals.end(),
                            [&](const UrdfShape& visual) { return visual.file == collision.file; });
      });
}

core::TexturedMesh ColoredVisual(const UrdfLink& link) {
  Painter painter;
  for (const UrdfShape& shape : ShapesOf(link)) {
    const Eigen::Vector4f plain = shape.color.value_or(core::Material{}.base_color);
    if (shape.color || shape.file.empty()) {
      painter.Add(shape.mesh, std::vector(shape.mesh.triangles.size(), plain));
      continue;
    }
    core::TexturedMesh file = assets::ReadMesh(shape.file);
    core::Transform(shape.link_from_file, &file.mesh);
    painter.Add(file.mesh, TriangleColors(file));
  }
  return painter.Take();
}

std::vector<std::vector<core::TriangleMesh>> ConvexPartsOf(const std::vector<UrdfLink>& links,
                                                           double whole, bool hulls,
                                                           const asset_build::PartBudget& budget,
                                                           core::Findings* findings) {
  struct Job {
    size_t link = 0;
    core::TriangleMesh piece;
    std::vector<core::TriangleMesh> parts;
    core::Findings findings;
  };
  std::vector<Job> jobs;
  for (size_t i = 0; i < links.size(); ++i) {
    const bool own = hulls ? !links[i].collisions.empty() : HasOwnCollisions(links[i]);
    for (const UrdfShape& shape : own ? links[i].collisions : ShapesOf(links[i])) {
      if (own && hulls && !shape.mesh.empty() && !IsFlat(shape.mesh)) {
        jobs.push_back({i, geometry::ConvexHull(shape.mesh.vertices), {}, {}});
        continue;
      }
      for (core::TriangleMesh& piece : PiecesOf(shape.mesh))
        jobs.push_back({i, std::move(piece), {}, {}});
    }
  }
  // The longest jobs run first, so that no thread waits for them at the end.
  std::vector<size_t> order(jobs.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return jobs[a].piece.triangles.size() > jobs[b].piece.triangles.size();
  });
  core::ParallelFor(static_cast<int>(jobs.size()), [&](int i) {
    core::CheckCancelled();
    Job& job = jobs[order[static_cast<size_t>(i)]];
    job.parts = PartsOfPiece(job.piece, whole, budget, links[job.link].name, &job.findings);
  });
  std::vector<std::vector<core::TriangleMesh>> parts(links.size());
  for (Job& job : jobs) {
    for (core::TriangleMesh& part : job.parts) parts[job.link].push_back(std::move(part));
    findings->insert(findings->end(), job.findings.begin(), job.findings.end());
  }
  for (size_t i = 0; i < links.size(); ++i) {
    KeepOutermost(&parts[i]);
    MergeToBudget(budget, links[i].name, &parts[i], findings);
    if (parts[i].size() <= kMostParts) continue;
    findings->push_back({"parts-left-out", core::Severity::kWarning, links[i].name,
                         "its smallest collision parts were omitted",
                         static_cast<double>(parts[i].size() - kMostParts)});
    parts[i].resize(kMostParts);
  }
  return parts;
}

}  // namespace simwright::importers
