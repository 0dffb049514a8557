#include "library_fit/fit_loss.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <Eigen/Cholesky>

#include "core/error.h"
#include "render/forward.h"

namespace simwright::library_fit {
namespace {

constexpr float kInside = 0.5f;            // opacity from which a pixel shows the object
constexpr double kVarianceFloor = 0.004;   // of colours: noise and light that no part explains
constexpr float kLargestResidual = 0.05f;  // squared, summed over channels: limits outliers
constexpr float kCrease = 0.85f;           // cosine between normals at an edge of the surface
constexpr float kWeakEdge = 0.06f, kStrongEdge = 0.25f;  // differences of colours

// Replaces each value by the distance (pixels, at most kFarEdge) to the nearest zero: a chamfer
// transform in two passes.
void SpreadDistance(int side, std::vector<float>* distance) {
  const auto relax = [&](int x, int y, int dx, int dy, float step) {
    const int nx = x + dx, ny = y + dy;
    if (nx < 0 || ny < 0 || nx >= side || ny >= side) return;
    float& value = (*distance)[static_cast<size_t>(y) * side + x];
    value = std::min(value, (*distance)[static_cast<size_t>(ny) * side + nx] + step);
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      relax(x, y, -1, 0, 1.0f);
      relax(x, y, 0, -1, 1.0f);
      relax(x, y, -1, -1, 1.414f);
      relax(x, y, 1, -1, 1.414f);
    }
  }
  for (int y = side - 1; y >= 0; --y) {
    for (int x = side - 1; x >= 0; --x) {
      relax(x, y, 1, 0, 1.0f);
      relax(x, y, 0, 1, 1.0f);
      relax(x, y, 1, 1, 1.414f);
      relax(x, y, -1, 1, 1.414f);
    }
  }
}

// Indexes the materials by name, so that parts of one look share it.
std::vector<int> LookOfMaterial(const core::TexturedMesh& mesh, int* count) {
  std::map<std::string, int> known;
  std::vector<int> look;
  for (const core::Material& material : mesh.materials) {
    look.push_back(known.emplace(material.name, static_cast<int>(known.size())).first->second);
  }
  *count = std::max(1, static_cast<int>(known.size()));
  return look;
}

// Returns the share of the photo's variance that remains after fitting colour = A (1, normal) per
// look, over the pixels that both show.
double UnexplainedShare(const render::ForwardBuffers& seen, const std::vector<int>& look, int looks,
                        const FitTarget& target) {
  std::vector<Eigen::Matrix4f> products(static_cast<size_t>(looks),
                                        1e-2f * Eigen::Matrix4f::Identity());
  std::vector<Eigen::Matrix<float, 4, 3>> sums(static_cast<size_t>(looks),
                                               Eigen::Matrix<float, 4, 3>::Zero());
  const auto term = [&](size_t i) {
    const Eigen::Vector3f& n = seen.normal[i];
    return Eigen::Vector4f(1.0f, n.x(), n.y(), n.z());
  };
  const auto both = [&](size_t i) { return look[i] >= 0 && target.opacity[i] > kInside; };
  for (size_t i = 0; i < look.size(); ++i) {
    if (!both(i)) continue;
    const Eigen::Vector4f t = term(i);
    products[static_cast<size_t>(look[i])] += t * t.transpose();
    sums[static_cast<size_t>(look[i])] += t * target.color[i].transpose();
  }
  std::vector<Eigen::Matrix<float, 4, 3>> fitted;
  for (size_t k = 0; k < products.size(); ++k) fitted.push_back(products[k].ldlt().solve(sums[k]));
  double rest = 0.0;
  int pixels = 0;
  for (size_t i = 0; i < look.size(); ++i) {
    if (!both(i)) continue;
    const Eigen::Vector3f off =
        target.color[i] - fitted[static_cast<size_t>(look[i])].transpose() * term(i);
    rest += std::min(off.squaredNorm(), kLargestResidual);
    ++pixels;
  }
  if (pixels == 0) return 1.0;
  return std::min(1.0, rest / pixels / (target.color_variance + kVarianceFloor));
}

// Returns the mean distance between the render's edges, where material or normal changes, and the
// photo's, in both directions, over kFarEdge.
double EdgeError(const render::ForwardBuffers& seen, const std::vector<int>& material,
                 const FitTarget& target) {
  const int side = target.side;
  std::vector<float> distance(material.size(), kFarEdge);
  double theirs = 0.0;
  int count = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const size_t i = seen.Index(x, y);
      if (material[i] < 0 || !target.Counts(i)) continue;
      bool edge = false;
      for (const size_t j : {x + 1 < side ? i + 1 : i, y + 1 < side ? i + side : i}) {
        if (material[j] < 0) continue;
        edge = edge || material[i] != material[j] || seen.normal[i].dot(seen.normal[j]) < kCrease;
      }
      if (!edge) continue;
      distance[i] = 0.0f;
      theirs += target.edge_distance[i];
      ++count;
    }
  }
  SpreadDistance(side, &distance);
  double ours = 0.0, weight = 0.0;
  for (size_t i = 0; i < distance.size(); ++i) {
    if (!target.Counts(i)) continue;
    ours += target.edge_strength[i] * distance[i];
    weight += target.edge_strength[i];
  }
  const double one = count > 0 ? theirs / count / kFarEdge : 0.0;
  const double other = weight > 0.0 ? ours / weight / kFarEdge : 0.0;
  return 0.5 * (one + other);
}

}  // namespace

FitTarget MakeFitTarget(const asset_lift::ObservedView& crop) {
  FitTarget target;
  target.side = crop.opacity.width;
  target.opacity = crop.opacity.values;
  const size_t pixels = target.opacity.size();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double squares = 0.0;
  int inside = 0;
  for (size_t i = 0; i < pixels; ++i) {
    target.color.emplace_back(crop.color.values[3 * i], crop.color.values[3 * i + 1],
                              crop.color.values[3 * i + 2]);
    if (target.opacity[i] <= kInside) continue;
    const int x = static_cast<int>(i) % target.side, y = static_cast<int>(i) / target.side;
    target.box.extend(Eigen::Vector2d(x, y));
    target.box.extend(Eigen::Vector2d(x + 1, y + 1));
    mean += target.color[i].cast<double>();
    squares += target.color[i].squaredNorm();
    ++inside;
  }
  if (inside < 16) throw core::Error("the crop shows no object");
  target.color_variance = std::max(0.0, squares / inside - (mean / inside).squaredNorm());
  target.edge_strength.assign(pixels, 0.0f);
  target.edge_distance.assign(pixels, kFarEdge);
  for (int y = 0; y + 1 < target.side; ++y) {
    for (int x = 0; x + 1 < target.side; ++x) {
      const size_t i = static_cast<size_t>(y) * target.side + x;
      float difference = 0.0f;
      for (const size_t j : {i + 1, i + static_cast<size_t>(target.side)}) {
        if (target.opacity[i] < 0.9f || target.opacity[j] < 0.9f) continue;
        difference = std::max(difference, (target.color[i] - target.color[j]).norm());
      }
      if (difference < kWeakEdge) continue;
      target.edge_strength[i] = std::min(1.0f, difference / kStrongEdge);
      target.edge_distance[i] = 0.0f;
    }
  }
  SpreadDistance(target.side, &target.edge_distance);
  return target;
}

FitAgreement CompareWithPhoto(const core::TexturedMesh& mesh, const FitView& view,
                              const FitTarget& target) {
  return CompareWithPhoto(mesh, CameraOf(view, mesh.mesh, target.box, target.side), target);
}

FitAgreement CompareWithPhoto(const core::TexturedMesh& mesh, const core::Camera& camera,
                              const FitTarget& target) {
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  const render::ForwardBuffers seen = render::RenderForward(scene, camera);
  int looks = 0;
  const std::vector<int> look_of = LookOfMaterial(mesh, &looks);
  std::vector<int> material(seen.triangle.size(), -1), look(seen.triangle.size(), -1);
  double shared = 0.0, joint = 0.0;
  for (size_t i = 0; i < seen.triangle.size(); ++i) {
    if (!target.Counts(i)) continue;
    const double theirs = target.opacity[i];
    if (seen.triangle[i] < 0) {
      joint += theirs;
      continue;
    }
    material[i] = mesh.triangle_material.empty()
                      ? 0
                      : mesh.triangle_material[static_cast<size_t>(seen.triangle[i])];
    look[i] = look_of.empty() ? 0 : look_of[static_cast<size_t>(material[i])];
    shared += theirs;
    joint += 1.0;
  }
  FitAgreement agreement;
  agreement.iou = joint > 0.0 ? shared / joint : 0.0;
  agreement.unexplained = UnexplainedShare(seen, look, looks, target);
  agreement.edge_error = EdgeError(seen, material, target);
  return agreement;
}

}  // namespace simwright::library_fit
