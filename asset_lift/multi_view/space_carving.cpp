#include "asset_lift/multi_view/space_carving.h"

#include <algorithm>
#include <cmath>

#include "core/mesh.h"
#include "core/parallel.h"
#include "render/scene.h"

namespace simwright::asset_lift {
namespace {

// A view whose colours count only where the pixel and its neighbours belong to the object.
struct ColorView {
  const ObservedView* view;
  Eigen::Isometry3d camera_from_world;
  Eigen::Vector3f eye;

  // Interpolates bilinearly. Returns false where the point is not safely inside the mask.
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

// Returns the inside nodes with a neighbour outside.
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

// Returns the standard deviation of the colours, all channels together; -1 for fewer than two.
double Deviation(const std::vector<Eigen::Vector3f>& colors) {
  if (colors.size() < 2) return -1.0;
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& color : colors) mean += color;
  mean /= static_cast<float>(colors.size());
  double sum = 0.0;
  for (const Eigen::Vector3f& color : colors) sum += (color - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(colors.size() - 1));
}

// Returns the nodes near carved ones that are a minority of their 5 x 5 x 5 neighbourhood:
// protrusions whose colours agree by chance.
std::vector<std::size_t> Protrusions(const geometry::ScalarGrid& field,
                                     const std::vector<char>& carved) {
  std::vector<std::size_t> rubble;
  for (const Eigen::Vector3i& node : SurfaceNodes(field)) {
    int air = 0, made = 0, all = 0;
    for (int k = std::max(0, node.z() - 2); k <= std::min(field.nz - 1, node.z() + 2); ++k) {
      for (int j = std::max(0, node.y() - 2); j <= std::min(field.ny - 1, node.y() + 2); ++j) {
        for (int i = std::max(0, node.x() - 2); i <= std::min(field.nx - 1, node.x() + 2); ++i) {
          const std::size_t at = field.Index(i, j, k);
          ++all;
          air += !(field.values[at] < 0.0f);
          made += carved[at];
        }
      }
    }
    if (made * 2 > air && air * 100 > all * 58) {
      rubble.push_back(field.Index(node.x(), node.y(), node.z()));
    }
  }
  return rubble;
}

// Returns true if at least 97% of the pixels of each mask have the surface behind them.
bool Explains(const std::vector<ObservedView>& views, const geometry::ScalarGrid& field) {
  core::TexturedMesh surface;
  surface.mesh = geometry::ExtractIsosurface(field, 0.0f);
  if (surface.mesh.empty()) return false;
  render::Scene scene;
  scene.Add(&surface);
  scene.Commit();
  std::vector<char> explained(views.size(), 0);
  core::ParallelFor(static_cast<int>(views.size()), [&](int v) {
    const core::Camera& camera = views[v].camera;
    const Eigen::Vector3f eye = camera.position().cast<float>();
    int pixels = 0, empty = 0;
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        if (*views[v].opacity.At(x, y) < 0.98f) continue;
        ++pixels;
        const Eigen::Vector3f ray = camera.Ray({x + 0.5, y + 0.5}).cast<float>();
        empty += scene.Intersect(eye, ray).instance < 0;
      }
    }
    explained[v] = empty * 100 <= pixels * 3;
  });
  return std::find(explained.begin(), explained.end(), 0) == explained.end();
}

class Carver {
 public:
  Carver(const std::vector<ObservedView>& views, double tolerance, geometry::ScalarGrid* field)
      : tolerance_(tolerance), field_(*field), carved_(field->values.size(), 0) {
    for (const ObservedView& view : views) {
      if (view.color.empty()) continue;
      looking_.push_back(
          {&view, view.camera.world_from_camera.inverse(), view.camera.position().cast<float>()});
    }
  }

  // Carves one layer and returns the number of its nodes.
  std::size_t CarveLayer() {
    core::TexturedMesh surface;
    surface.mesh = geometry::ExtractIsosurface(field_, 0.0f);
    if (surface.mesh.empty()) return 0;
    render::Scene scene;
    scene.Add(&surface);
    scene.Commit();
    const std::vector<Eigen::Vector3i> nodes = SurfaceNodes(field_);
    std::vector<char> differs(nodes.size(), 0);
    constexpr std::size_t kChunk = 512;
    core::ParallelFor(static_cast<int>((nodes.size() + kChunk - 1) / kChunk), [&](int chunk) {
      std::vector<Eigen::Vector3f> colors;
      const std::size_t first = static_cast<std::size_t>(chunk) * kChunk;
      for (std::size_t n = first; n < std::min(nodes.size(), first + kChunk); ++n) {
        CollectColors(scene, field_.origin + field_.cell * nodes[n].cast<double>(), &colors);
        differs[n] = Deviation(colors) > tolerance_;
      }
    });
    std::size_t count = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!differs[n]) continue;
      ++count;
      TakeAway(field_.Index(nodes[n].x(), nodes[n].y(), nodes[n].z()));
    }
    return count;
  }

  std::size_t ClearRubble() {
    std::size_t count = 0;
    for (;;) {
      core::CheckCancelled();
      const std::vector<std::size_t> rubble = Protrusions(field_, carved_);
      for (const std::size_t at : rubble) TakeAway(at);
      count += rubble.size();
      if (rubble.empty()) return count;
    }
  }

 private:
  void TakeAway(std::size_t at) {
    carved_[at] = 1;
    field_.values[at] = 0.5f * static_cast<float>(field_.cell);
  }

  // Collects the point's colours in the views that see it.
  void CollectColors(const render::Scene& scene, const Eigen::Vector3d& place,
                     std::vector<Eigen::Vector3f>* colors) const {
    colors->clear();
    for (const ColorView& view : looking_) {
      Eigen::Vector3f color;
      if (!view.At(place, &color)) continue;
      // The node lies up to a cell below the surface that the ray hits.
      const Eigen::Vector3f to_eye = view.eye - place.cast<float>();
      const float skip = 1.5f * static_cast<float>(field_.cell) / to_eye.norm();
      if (!scene.Occluded(place.cast<float>(), to_eye, skip, 1.0f)) colors->push_back(color);
    }
  }

  double tolerance_;
  geometry::ScalarGrid& field_;
  std::vector<char> carved_;
  std::vector<ColorView> looking_;
};

}  // namespace

bool CarveByColor(const std::vector<ObservedView>& views, double tolerance,
                  geometry::ScalarGrid* field, core::Progress* progress) {
  if (progress != nullptr) progress->Stage("carving by colour");
  const std::vector<float> before = field->values;
  Carver carver(views, tolerance, field);
  for (int layer = 0; layer < field->nx + field->ny + field->nz; ++layer) {
    core::CheckCancelled();
    if (progress != nullptr) progress->Advance();
    if (carver.CarveLayer() + carver.ClearRubble() == 0) break;
  }
  if (Explains(views, *field)) return true;
  field->values = before;
  return false;
}

}  // namespace simwright::asset_lift
