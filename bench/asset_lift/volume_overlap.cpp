#include "volume_overlap.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/random.h"
#include "render/scene.h"

namespace simwright::bench {
namespace {

// Moves the mesh to the camera's frame, with the middle of its depths at `depth`.
core::TexturedMesh InCamera(const core::TriangleMesh& mesh, const core::Camera& camera,
                            double depth) {
  core::TexturedMesh placed;
  placed.mesh = mesh;
  core::Transform(Eigen::Affine3d(camera.world_from_camera.inverse()), &placed.mesh);
  const double now = core::Bounds(placed.mesh).center().z();
  core::Transform(Eigen::Affine3d(Eigen::Scaling(depth / now)), &placed.mesh);
  return placed;
}

class ClosedMesh {
 public:
  explicit ClosedMesh(core::TexturedMesh mesh) : mesh_(std::move(mesh)) {
    scene_.Add(&mesh_);
    scene_.Commit();
    step_ = static_cast<float>(1e-6 * bounds().diagonal().norm());
  }

  Eigen::AlignedBox3d bounds() const { return core::Bounds(mesh_.mesh); }

  bool Contains(const Eigen::Vector3d& point) const {
    const Eigen::Vector3f origin = point.cast<float>();
    const Eigen::Vector3f direction = Eigen::Vector3f(0.312f, 0.541f, 0.781f).normalized();
    bool inside = false;
    float from = 0.0f;
    for (int crossings = 0; crossings < 1000; ++crossings) {
      const render::Hit hit = scene_.Intersect(origin, direction, from);
      if (hit.instance < 0) break;
      inside = !inside;
      from = hit.depth + step_;
    }
    return inside;
  }

 private:
  core::TexturedMesh mesh_;
  render::Scene scene_;
  float step_ = 0.0f;
};

// The mask's centre and its ellipse of equal second moments, in pixels.
struct MaskEllipse {
  Eigen::Vector2d center{0, 0};
  Eigen::Matrix2d axes;        // columns, unit
  Eigen::Vector2d half{0, 0};  // ascending
};

MaskEllipse FitEllipse(const asset_lift::Matte& matte) {
  double mass = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (int y = 0; y < matte.alpha.height; ++y) {
    for (int x = 0; x < matte.alpha.width; ++x) {
      const double weight = matte.alpha.At(x, y)[0] / 255.0;
      const Eigen::Vector2d p(x + 0.5, y + 0.5);
      mass += weight;
      first += weight * p;
      second += weight * p * p.transpose();
    }
  }
  MaskEllipse ellipse;
  ellipse.center = first / mass;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
      second / mass - ellipse.center * ellipse.center.transpose());
  ellipse.axes = solver.eigenvectors();
  ellipse.half = 2.0 * solver.eigenvalues().cwiseMax(1e-9).cwiseSqrt();
  return ellipse;
}

}  // namespace

VolumeOverlaps CompareVolumes(const core::TriangleMesh& truth, const core::TriangleMesh& ours,
                              const core::Camera& camera, const asset_lift::Matte& matte,
                              double depth, int points, std::uint64_t seed) {
  const ClosedMesh true_solid(InCamera(truth, camera, depth));
  const ClosedMesh our_solid(InCamera(ours, camera, depth));
  const MaskEllipse ellipse = FitEllipse(matte);
  const double metre = depth / camera.fx;  // m per pixel at `depth`
  const double half_depth = ellipse.half[0] * metre;
  Eigen::AlignedBox3d box = true_solid.bounds().merged(our_solid.bounds());
  for (const double z : {depth - half_depth, depth + half_depth}) {
    for (const int x : {matte.left, matte.right}) {
      for (const int y : {matte.top, matte.bottom}) {
        box.extend(Eigen::Vector3d((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1) *
                   z);
      }
    }
  }
  core::Rng rng = core::StreamRng(seed, 7);
  double both[3] = {0, 0, 0}, either[3] = {0, 0, 0};
  for (int i = 0; i < points; ++i) {
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = core::Uniform(rng, box.min()[k], box.max()[k]);
    const Eigen::Vector2d pixel(camera.fx * p.x() / p.z() + camera.cx,
                                camera.fy * p.y() / p.z() + camera.cy);
    const Eigen::Vector2d across =
        (ellipse.axes.transpose() * (pixel - ellipse.center)).cwiseQuotient(ellipse.half);
    const double along = (p.z() - depth) / half_depth;
    const int x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(pixel.y());
    const bool on_mask = x >= 0 && y >= 0 && x < matte.alpha.width && y < matte.alpha.height &&
                         matte.alpha.At(x, y)[0] > 127;
    const bool in_truth = true_solid.Contains(p);
    const bool in_shape[3] = {our_solid.Contains(p), across.squaredNorm() + along * along < 1.0,
                              on_mask && std::abs(along) < 1.0};
    for (int s = 0; s < 3; ++s) {
      both[s] += in_truth && in_shape[s] ? 1 : 0;
      either[s] += in_truth || in_shape[s] ? 1 : 0;
    }
  }
  const auto ratio = [&](int s) { return either[s] > 0 ? both[s] / either[s] : 0.0; };
  return {ratio(0), ratio(1), ratio(2)};
}

}  // namespace simwright::bench
