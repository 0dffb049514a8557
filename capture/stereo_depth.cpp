#include "capture/stereo_depth.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "render/scene.h"

namespace simwright::capture {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kMostVoters = 64;  // views that are distinguished at a pixel
constexpr double kConfirmAngle = 70.0;   // deg, between a view and those that may confirm it

double ViewAngle(const core::Camera& a, const core::Camera& b, const Eigen::Vector3d& object) {
  const Eigen::Vector3d to_a = (a.position() - object).normalized();
  const Eigen::Vector3d to_b = (b.position() - object).normalized();
  return std::acos(std::clamp(to_a.dot(to_b), -1.0, 1.0)) / kDegree;
}

// Returns the depths at which the pixels' rays enter and leave the hull.
std::vector<HullInterval> HullIntervals(const render::Scene& scene, const core::Camera& camera) {
  std::vector<HullInterval> intervals(static_cast<std::size_t>(camera.width) * camera.height);
  const Eigen::Matrix3f turn = camera.world_from_camera.linear().transpose().cast<float>();
  const Eigen::Vector3f eye = camera.position().cast<float>();
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3f ray = camera.Ray({x + 0.5, y + 0.5}).cast<float>();
      render::Hit hit = scene.Intersect(eye, ray);
      if (hit.instance < 0) continue;
      HullInterval& interval = intervals[static_cast<std::size_t>(y) * camera.width + x];
      interval.enter = interval.leave = hit.depth;
      const Eigen::Vector3f normal = turn * scene.ShadingNormal(hit);
      interval.normal = normal.dot(turn * ray) < 0.0f ? normal : Eigen::Vector3f(-normal);
      // The last surface, behind holes of the hull.
      for (int surfaces = 0; surfaces < 32 && hit.instance >= 0; ++surfaces) {
        interval.leave = hit.depth;
        hit = scene.Intersect(eye, ray, hit.depth * 1.0001f);
      }
    }
  }
  return intervals;
}

class Stereo {
 public:
  Stereo(const std::vector<asset_lift::ObservedView>& views, const core::TriangleMesh& hull,
         const StereoOptions& options, core::Progress* progress)
      : views_(views), options_(options), progress_(progress) {
    if (hull.empty()) throw core::Error("the hull is empty", "stereo");
    const Eigen::AlignedBox3d box = core::Bounds(hull);
    center_ = box.center();
    diagonal_ = box.diagonal().norm();
    surface_.mesh = hull;
    scene_.Add(&surface_);
    scene_.Commit();
  }

  StereoDepths Run() {
    progress_->Stage("stereo", static_cast<int>(views_.size()));
    for (const asset_lift::ObservedView& view : views_) {
      matched_.emplace_back(view, options_.blur_radius);
    }
    planes_.resize(views_.size());
    core::ParallelFor(static_cast<int>(views_.size()), [&](int i) {
      core::CheckCancelled();
      Match(i);
      progress_->Advance();
    });
    StereoDepths found;
    found.depths.resize(views_.size());
    core::ParallelFor(static_cast<int>(views_.size()), [&](int i) {
      found.depths[static_cast<std::size_t>(i)] = Confirmed(static_cast<std::size_t>(i));
    });
    double known = 0.0, all = 0.0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      for (std::size_t k = 0; k < found.depths[i].values.size(); ++k) {
        known += found.depths[i].values[k] > 0.0f;
        all += views_[i].opacity.values[k] >= 0.5f;
      }
    }
    found.share = all > 0.0 ? known / all : 0.0;
    return found;
  }

 private:
  void Match(int index);
  // The views whose surface lies at a pixel's depth, or before it.
  struct Votes {
    std::bitset<kMostVoters> agreeing, hiding;
  };

  // Notes at the pixels of a view where the surface that another view finds lies.
  void Judge(std::size_t view, std::size_t by, std::vector<Votes>* votes) const;
  // Returns true if a view finds the surface at a point; or it sees through it.
  bool Agrees(std::size_t view, const Eigen::Vector3d& point, bool* sees_through) const;
  core::FloatImage Confirmed(std::size_t index) const;
  bool Supported(std::size_t index, int x, int y) const;
  float DepthAt(std::size_t view, int x, int y) const {
    return planes_[view][static_cast<std::size_t>(y) * views_[view].camera.width + x].depth;
  }

  const std::vector<asset_lift::ObservedView>& views_;
  const StereoOptions& options_;
  core::Progress* progress_;
  core::TexturedMesh surface_;
  render::Scene scene_;
  Eigen::Vector3d center_;
  double diagonal_ = 0.0;
  std::vector<MatchView> matched_;
  std::vector<std::vector<PatchPlane>> planes_;  // per view
};

void Stereo::Match(int index) {
  const auto at = static_cast<std::size_t>(index);
  const core::Camera& camera = views_[at].camera;
  std::vector<std::pair<double, const MatchView*>> candidates;
  for (std::size_t j = 0; j < views_.size(); ++j) {
    const double angle = ViewAngle(camera, views_[j].camera, center_);
    if (j == at || angle < options_.least_angle || angle > options_.most_angle) continue;
    candidates.emplace_back(std::abs(angle - options_.best_angle), &matched_[j]);
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<const MatchView*> neighbors;
  for (const auto& [difference, view] : candidates) {
    if (static_cast<int>(neighbors.size()) < options_.neighbors) neighbors.push_back(view);
  }
  const std::vector<HullInterval> hull = HullIntervals(scene_, camera);
  if (neighbors.empty()) {
    planes_[at].assign(hull.size(), {});
    return;
  }
  const Eigen::Vector3f up =
      (camera.world_from_camera.linear().transpose() * Eigen::Vector3d::UnitZ()).cast<float>();
  core::Rng rng = core::StreamRng(options_.seed, static_cast<std::uint64_t>(index));
  planes_[at] = PatchMatch(matched_[at], neighbors, hull, up, diagonal_, options_.match).Run(&rng);
}

void Stereo::Judge(std::size_t view, std::size_t by, std::vector<Votes>* votes) const {
  const core::Camera &camera = views_[view].camera, &other = views_[by].camera;
  const Eigen::Isometry3d to_view = camera.world_from_camera.inverse() * other.world_from_camera;
  const double near = options_.agreement * diagonal_;
  for (int y = 0; y < other.height; ++y) {
    for (int x = 0; x < other.width; ++x) {
      const float measured = DepthAt(by, x, y);
      if (!(measured > 0.0f)) continue;
      const Eigen::Vector3d at =
          to_view * Eigen::Vector3d(measured * (x + 0.5 - other.cx) / other.fx,
                                    measured * (y + 0.5 - other.cy) / other.fy, measured);
      const int u = static_cast<int>(std::floor(camera.fx * at.x() / at.z() + camera.cx));
      const int v = static_cast<int>(std::floor(camera.fy * at.y() / at.z() + camera.cy));
      if (!(at.z() > 0.0) || u < 0 || v < 0 || u >= camera.width || v >= camera.height) continue;
      const float depth = DepthAt(view, u, v);
      if (!(depth > 0.0f)) continue;
      Votes& of = (*votes)[static_cast<std::size_t>(v) * camera.width + u];
      if (std::abs(depth - at.z()) < near) {
        of.agreeing.set(by % kMostVoters);
      } else if (depth > at.z() + 2.0 * near) {
        of.hiding.set(by % kMostVoters);
      }
    }
  }
}

bool Stereo::Agrees(std::size_t view, const Eigen::Vector3d& point, bool* sees_through) const {
  const core::Camera& camera = views_[view].camera;
  const Eigen::Vector3d at = camera.Project(point);
  const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
  *sees_through = false;
  if (!(at.z() > 0.0) || x < 0 || y < 0 || x >= camera.width || y >= camera.height) return false;
  const float depth = DepthAt(view, x, y);
  *sees_through = depth > at.z() + 2.0 * options_.agreement * diagonal_;
  return depth > 0.0f && std::abs(depth - at.z()) < options_.agreement * diagonal_;
}

bool Stereo::Supported(std::size_t index, int x, int y) const {
  const core::Camera& camera = views_[index].camera;
  const float depth = DepthAt(index, x, y);
  int supporters = 0;
  for (int v = std::max(0, y - 1); v <= std::min(camera.height - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(camera.width - 1, x + 1); ++u) {
      const float other = DepthAt(index, u, v);
      supporters += (u != x || v != y) && other > 0.0f &&
                    std::abs(other - depth) < 2.0 * options_.agreement * diagonal_;
    }
  }
  return supporters >= options_.least_supporters;
}

core::FloatImage Stereo::Confirmed(std::size_t index) const {
  const core::Camera& camera = views_[index].camera;
  std::vector<std::size_t> others;
  for (std::size_t j = 0; j < views_.size(); ++j) {
    if (j == index) continue;
    if (ViewAngle(camera, views_[j].camera, center_) < kConfirmAngle) others.push_back(j);
  }
  core::FloatImage depths(camera.width, camera.height, 1);
  std::vector<Votes> votes(depths.values.size());
  for (const std::size_t j : others) Judge(index, j, &votes);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const float depth = DepthAt(index, x, y);
      if (!(depth > 0.0f) || !Supported(index, x, y)) continue;
      const Eigen::Vector3d point = camera.position() + depth * camera.Ray({x + 0.5, y + 0.5});
      const Votes& of = votes[static_cast<std::size_t>(y) * camera.width + x];
      int agreeing = 0, against = static_cast<int>((of.hiding & ~of.agreeing).count());
      for (const std::size_t j : others) {
        bool sees_through = false;
        agreeing += Agrees(j, point, &sees_through);
        against += sees_through;
      }
      if (agreeing >= options_.least_agreeing && against < agreeing) *depths.At(x, y) = depth;
    }
  }
  return depths;
}

}  // namespace

StereoDepths FindStereoDepths(const std::vector<asset_lift::ObservedView>& views,
                              const core::TriangleMesh& hull, const StereoOptions& options,
                              core::Progress* progress) {
  return Stereo(views, hull, options, progress).Run();
}

}  // namespace simwright::capture
