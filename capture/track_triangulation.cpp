#include "capture/track_triangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "capture/structure_adjustment.h"

namespace simwright::capture {
namespace {

constexpr double kNominalSide = 1600.0;  // pixels
constexpr std::size_t kSeedsTried = 8;   // observations whose pairs start the search for agreement

struct TrackRay {
  int photo = 0;
  Eigen::Vector2d pixel;
  Eigen::Vector3d origin, direction;
};

std::vector<TrackRay> RaysOf(const Structure& structure, const FeatureTrack& track) {
  std::vector<TrackRay> rays;
  for (std::size_t k = 0; k < track.photos.size(); ++k) {
    const Structure::View& view = structure.views[static_cast<std::size_t>(track.photos[k])];
    if (!view.registered) continue;
    const Eigen::Vector2d at =
        DirectionOf(structure.lenses[static_cast<std::size_t>(view.lens)], track.pixels[k]);
    rays.push_back({track.photos[k], track.pixels[k], view.world_from_camera.translation(),
                    (view.world_from_camera.linear() * at.homogeneous()).normalized()});
  }
  return rays;
}

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double WidestAngle(const std::vector<TrackRay>& rays) {
  double widest = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t j = i + 1; j < rays.size(); ++j) {
      widest = std::max(widest, AngleBetween(rays[i].direction, rays[j].direction));
    }
  }
  return widest;
}

// Returns the point with the least squared distances to the rays.
Eigen::Vector3d NearestPoint(const std::vector<TrackRay>& rays) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const TrackRay& ray : rays) {
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - ray.direction * ray.direction.transpose();
    sum += across;
    right += across * ray.origin;
  }
  return sum.ldlt().solve(right);
}

class TrackSolver {
 public:
  TrackSolver(const Structure& structure, const TriangulationLimits& limits)
      : structure_(structure), limits_(limits) {}

  bool Agrees(const TrackRay& ray, const Eigen::Vector3d& point) const {
    const Structure::View& view = structure_.views[static_cast<std::size_t>(ray.photo)];
    const Lens& lens = structure_.lenses[static_cast<std::size_t>(view.lens)];
    return ReprojectionError(structure_, ray.photo, ray.pixel, point) <=
           ErrorLimit(lens, limits_.pixels);
  }

  std::vector<TrackRay> Agreeing(const std::vector<TrackRay>& rays,
                                 const Eigen::Vector3d& point) const {
    std::vector<TrackRay> agreeing;
    for (const TrackRay& ray : rays) {
      if (Agrees(ray, point)) agreeing.push_back(ray);
    }
    return agreeing;
  }

  // Returns the largest set of rays that agrees with a point of two of them.
  std::vector<TrackRay> LargestAgreement(const std::vector<TrackRay>& rays) const {
    std::vector<TrackRay> best;
    const std::size_t seeds = std::min(rays.size(), kSeedsTried);
    for (std::size_t i = 0; i < seeds; ++i) {
      for (std::size_t j = i + 1; j < seeds; ++j) {
        if (AngleBetween(rays[i].direction, rays[j].direction) < limits_.least_angle) continue;
        std::vector<TrackRay> agreeing = Agreeing(rays, NearestPoint({rays[i], rays[j]}));
        if (agreeing.size() > best.size()) best = std::move(agreeing);
      }
    }
    return best;
  }

 private:
  const Structure& structure_;
  const TriangulationLimits& limits_;
};

// Removes the observations of placed photos that are not among `kept`.
void Restrict(const Structure& structure, const std::vector<TrackRay>& kept, FeatureTrack* track) {
  FeatureTrack restricted;
  for (std::size_t k = 0; k < track->photos.size(); ++k) {
    const int photo = track->photos[k];
    const bool placed = structure.views[static_cast<std::size_t>(photo)].registered;
    if (placed && std::none_of(kept.begin(), kept.end(),
                               [&](const TrackRay& ray) { return ray.photo == photo; })) {
      continue;
    }
    restricted.photos.push_back(photo);
    restricted.pixels.push_back(track->pixels[k]);
  }
  *track = std::move(restricted);
}

}  // namespace

double ErrorLimit(const Lens& lens, double pixels_of_1600) {
  return pixels_of_1600 * std::max(1.0, std::max(lens.width, lens.height) / kNominalSide);
}

double ReprojectionError(const Structure& structure, int photo, const Eigen::Vector2d& pixel,
                         const Eigen::Vector3d& point) {
  const Structure::View& view = structure.views[static_cast<std::size_t>(photo)];
  const Eigen::Vector3d at = view.world_from_camera.inverse() * point;
  if (!(at.z() > 0.0)) return std::numeric_limits<double>::infinity();
  return (structure.lenses[static_cast<std::size_t>(view.lens)].Project(at) - pixel).norm();
}

std::optional<Eigen::Vector3d> TriangulateTrack(const Structure& structure,
                                                const TriangulationLimits& limits,
                                                FeatureTrack* track) {
  const std::vector<TrackRay> rays = RaysOf(structure, *track);
  if (rays.size() < 2 || WidestAngle(rays) < limits.least_angle) return std::nullopt;
  const TrackSolver solver(structure, limits);
  const Eigen::Vector3d all = NearestPoint(rays);
  if (solver.Agreeing(rays, all).size() == rays.size()) return all;
  const std::vector<TrackRay> agreeing = solver.LargestAgreement(rays);
  if (agreeing.size() < 3 || 2 * agreeing.size() <= rays.size()) return std::nullopt;
  const Eigen::Vector3d point = NearestPoint(agreeing);
  if (solver.Agreeing(agreeing, point).size() != agreeing.size()) return std::nullopt;
  Restrict(structure, agreeing, track);
  return point;
}

bool KeepAgreeing(const Structure& structure, const TriangulationLimits& limits,
                  const Eigen::Vector3d& point, FeatureTrack* track) {
  const std::vector<TrackRay> rays = RaysOf(structure, *track);
  const std::vector<TrackRay> agreeing = TrackSolver(structure, limits).Agreeing(rays, point);
  if (agreeing.size() < rays.size() && agreeing.size() < 3) return false;
  if (WidestAngle(agreeing) < limits.least_angle) return false;
  Restrict(structure, agreeing, track);
  return true;
}

}  // namespace simwright::capture
