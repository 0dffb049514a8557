#include "asset_lift/space_carving.h"

#include <algorithm>
#include <cmath>

#include "core/mesh.h"
#include "core/parallel.h"
#include "render/scene.h"

namespace simwright::asset_lift {
namespace {

// A view whose colours count only where the pixel and its neighbours are the object's.
struct ColorView {
  const ObservedView* view;
  Eigen::Isometry3d camera_from_world;
  Eigen::Vector3f eye;

  // Bilinear; false where the point is not safely within the mask.
  bool At(const Eigen::Vector3d& point, Eigen::Vector3f* color) const {
    const core::Camera& camera = view->camera;
    const Eigen::Vector3d p = camera_from_world * point;
    if (!(p.z() > 0.0)) return false;
    const double x = camera.fx * p.x() / p.z() + camera.cx - 0.5;
    const double y = camera.fy * p.y() / p.z() + camera.cy - 0.5;
    if (!(x >= 0.0 && y >= 0.0 && x < camera.width - 1.0 && y < camera.height - 1.0)) return false;
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const float fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    color->setZero();
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 2; ++i) {
        if (*view->opacity.At(x0 + i, y0 + j) < 0.98f) return false;
        *color += (i ? fx : 1.0f - fx) * (j ? fy : 1.0f - fy) *
                  Eigen::Map<const Eigen::Vector3f>(view->color.At(x0 + i, y0 + j));
      }
    }
    return true;
  }
};

// Nodes inside with a neighbour outside.
std::vector<Eigen::Vector3i> SurfaceNodes(const geometry::ScalarGrid& field) {
  std::vector<Eigen::Vector3i> nodes;
  const auto outside = [&](int i, int j, int k) {
    return i < 0 || j < 0 || k < 0 || i >= field.nx || j >= field.ny || k >= field.nz ||
           !(field.values[field.Index(i, j, k)] < 0.0f);
  };
  for (int k = 0; k < field.nz; ++k) {
    for (int j = 0; j < field.ny; ++j) {
      for (int i = 0; i < field.nx; ++i) {
        if (outside(i, j, k)) continue;
        if (outside(i - 1, j, k) || outside(i + 1, j, k) || outside(i, j - 1, k) ||
            outside(i, j + 1, k) || outside(i, j, k - 1) || outside(i, j, k + 1)) {
          nodes.emplace_back(i, j, k);
        }
      }
    }
  }
  return nodes;
}

// Standard deviation of the colours, the worst channel; -1 for fewer than two.
double Deviation(const std::vector<Eigen::Vector3f>& colors) {
  if (colors.size() < 2) return -1.0;
  Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
  for (const Eigen::Vector3f& color : colors) {
    const Eigen::Array3d c = color.cast<double>().array();
    sum += c;
    squares += c.square();
  }
  const double n = static_cast<double>(colors.size());
  const Eigen::Array3d variance = squares / n - (sum / n).square();
  return std::sqrt(std::max(0.0, variance.maxCoeff()));
}

}  // namespace

void CarveByColor(const std::vector<ObservedView>& views, double tolerance,
                  geometry::ScalarGrid* field, core::Progress* progress) {
  std::vector<ColorView> looking;
  for (const ObservedView& view : views) {
    if (view.color.empty()) continue;
    looking.push_back(
        {&view, view.camera.world_from_camera.inverse(), view.camera.position().cast<float>()});
  }
  if (progress != nullptr) progress->Stage("carving by colour");
  const int most = field->nx + field->ny + field->nz;
  for (int layer = 0; layer < most; ++layer) {
    core::CheckCancelled();
    core::TexturedMesh surface;
    surface.mesh = geometry::ExtractIsosurface(*field, 0.0f);
    if (surface.mesh.empty()) return;
    render::Scene scene;
    scene.Add(&surface);
    scene.Commit();
    const std::vector<Eigen::Vector3i> nodes = SurfaceNodes(*field);
    std::vector<char> carved(nodes.size(), 0);
    constexpr int kChunk = 512;
    const int chunks = static_cast<int>((nodes.size() + kChunk - 1) / kChunk);
    core::ParallelFor(chunks, [&](int chunk) {
      std::vector<Eigen::Vector3f> colors;
      const std::size_t last = std::min(nodes.size(), static_cast<std::size_t>(chunk + 1) * kChunk);
      for (std::size_t n = static_cast<std::size_t>(chunk) * kChunk; n < last; ++n) {
        const Eigen::Vector3d p = field->origin + field->cell * nodes[n].cast<double>();
        colors.clear();
        for (const ColorView& view : looking) {
          Eigen::Vector3f color;
          if (!view.At(p, &color)) continue;
          // The node lies up to a cell below the surface that the ray is stopped by.
          const Eigen::Vector3f to_eye = view.eye - p.cast<float>();
          const float skip = 1.5f * static_cast<float>(field->cell) / to_eye.norm();
          if (!scene.Occluded(p.cast<float>(), to_eye, skip, 1.0f)) colors.push_back(color);
        }
        carved[n] = Deviation(colors) > tolerance;
      }
    });
    bool any = false;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!carved[n]) continue;
      any = true;
      field->values[field->Index(nodes[n].x(), nodes[n].y(), nodes[n].z())] =
          0.5f * static_cast<float>(field->cell);
    }
    if (progress != nullptr) progress->Advance();
    if (!any) return;
  }
}

}  // namespace simwright::asset_lift
