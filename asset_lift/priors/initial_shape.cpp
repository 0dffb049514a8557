#include "asset_lift/priors/initial_shape.h"

#include <algorithm>
#include <memory>

#include "asset_lift/multi_view/visual_hull.h"
#include "asset_lift/outline/missing_parts.h"
#include "core/error.h"
#include "core/parallel.h"
#include "geometry/isosurface.h"
#include "geometry/triangle_tree.h"
#include "geometry/voxel_solid.h"

namespace simwright::asset_lift {
namespace {

constexpr double kCertainLogOdds = 4.0;
constexpr int kSurfaceCells = 80;
constexpr int kSignCells = 96;

}  // namespace

InitialShape InitialShapeFrom(const ShapePrediction& prediction) {
  InitialShape guess;
  guess.surface = PredictedSurface(prediction, kSurfaceCells);
  guess.box = core::Bounds(guess.surface);
  guess.odds = [prediction](const Eigen::Vector3d& point) -> double {
    return std::clamp<double>(prediction.Logit(point), -kCertainLogOdds, kCertainLogOdds);
  };
  return guess;
}

InitialShape InitialShapeFrom(const core::TriangleMesh& mesh) {
  InitialShape guess;
  guess.surface = mesh;
  guess.box = core::Bounds(mesh);
  const auto tree = std::make_shared<geometry::TriangleTree>(mesh);
  const auto solid = std::make_shared<geometry::VoxelSolid>(
      mesh, geometry::VoxelSolidOptions{.resolution = kSignCells, .sheet_cells = 0.0});
  const double sure_at = guess.box.diagonal().norm() / 40.0;
  guess.odds = [tree, solid, sure_at](const Eigen::Vector3d& point) {
    const double distance = std::min(tree->Closest(point).distance / sure_at, 1.0);
    return solid->Occupancy(point) > 0.5f ? kCertainLogOdds * distance
                                          : -kCertainLogOdds * distance;
  };
  return guess;
}

InitialShape WithMissingParts(InitialShape shape, const Matte& matte, const core::Camera& camera) {
  constexpr int kCells = 104;
  const OutlineField parts = MissingParts(shape.surface, matte, camera);
  if (parts.empty()) return shape;
  const double sure_at = shape.box.diagonal().norm() / 40.0;
  shape.box.extend(parts.box());
  shape.odds = [before = shape.odds, parts, sure_at](const Eigen::Vector3d& point) {
    const double part = std::clamp(-parts.Value(point) / sure_at, -1.0, 1.0) * kCertainLogOdds;
    return std::max(before(point), part);
  };
  geometry::ScalarGrid grid;
  grid.cell = shape.box.sizes().maxCoeff() / kCells;
  grid.origin = shape.box.min() - Eigen::Vector3d::Constant(2.5 * grid.cell);
  const Eigen::Vector3i nodes = (shape.box.sizes() / grid.cell).array().ceil().cast<int>() + 6;
  grid.nx = nodes.x();
  grid.ny = nodes.y();
  grid.nz = nodes.z();
  grid.values.resize(static_cast<size_t>(grid.nx) * grid.ny * grid.nz);
  core::ParallelFor(grid.nz, [&](int k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        grid.values[grid.Index(i, j, k)] =
            static_cast<float>(-shape.odds(grid.origin + grid.cell * Eigen::Vector3d(i, j, k)));
      }
    }
  });
  shape.surface = LargeComponents(geometry::ExtractIsosurface(grid, 0.0f));
  shape.box = core::Bounds(shape.surface);
  return shape;
}

InitialShape InitialEllipsoid(const ViewFrame& frame, const Eigen::Vector2d& half_axes_uv) {
  if (!(half_axes_uv.minCoeff() > 0.0)) throw core::Error("an ellipsoid needs half axes");
  // The ellipsoid is as deep as its smaller half axis in the image.
  const Eigen::Vector3d axes(half_axes_uv.x(), half_axes_uv.y(), half_axes_uv.minCoeff());
  constexpr int kLatitudes = 24, kLongitudes = 48;
  core::TriangleMesh ball;
  for (int i = 1; i < kLatitudes; ++i) {
    for (int j = 0; j < kLongitudes; ++j) {
      const double a = M_PI * i / kLatitudes, b = 2.0 * M_PI * j / kLongitudes;
      ball.vertices.push_back(frame.PointAt(axes.cwiseProduct(
          Eigen::Vector3d(std::sin(a) * std::cos(b), -std::cos(a), std::sin(a) * std::sin(b)))));
    }
  }
  const int top = static_cast<int>(ball.vertices.size()), low = top + 1;
  ball.vertices.push_back(frame.PointAt({0, -axes.y(), 0}));
  ball.vertices.push_back(frame.PointAt({0, axes.y(), 0}));
  const int last = (kLatitudes - 2) * kLongitudes;
  for (int j = 0; j < kLongitudes; ++j) {
    const int next = (j + 1) % kLongitudes;
    ball.triangles.push_back({top, j, next});
    ball.triangles.push_back({low, last + next, last + j});
    for (int i = 0; i + 2 < kLatitudes; ++i) {
      const int a = i * kLongitudes + j, b = i * kLongitudes + next;
      ball.triangles.push_back({a, a + kLongitudes, b + kLongitudes});
      ball.triangles.push_back({a, b + kLongitudes, b});
    }
  }
  return InitialShapeFrom(ball);
}

}  // namespace simwright::asset_lift
