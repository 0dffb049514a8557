#include "geometry/hidden_sights.h"

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kHalvings = 8.0;  // down to 0.4 % of a radius, or of a radian

// Where to look, from where it was seen, and the normal of what was seen; zero: not known.
struct Place {
  Vector3d point;
  Vector3d to_eye = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
};

std::vector<Place> Spread(const std::vector<Place>& all, int most) {
  const std::size_t count = static_cast<std::size_t>(most);
  if (all.size() <= count) return all;
  std::vector<Place> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

std::vector<Place> FarApart(const core::TriangleMesh& visual, const core::TriangleMesh& solid,
                            const HiddenSightOptions& options) {
  std::vector<Place> hidden, excess;
  const std::vector<OuterHit> hits = SampleOuterHits(visual, options.rays, options.seed);
  std::vector<Vector3d> points;
  for (const OuterHit& hit : hits) points.push_back(hit.point);
  const std::vector<double> buried = DistancesToSurface(points, solid);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (buried[i] > options.reach)
      hidden.push_back({hits[i].point, hits[i].to_eye, hits[i].normal});
  }
  const std::vector<Vector3d> on_solid =
      SampleSurface(solid, options.solid_samples, options.seed + 1);
  const std::vector<double> apart = DistancesToSurface(on_solid, visual);
  for (std::size_t i = 0; i < on_solid.size(); ++i) {
    if (apart[i] > options.reach) excess.push_back({on_solid[i]});
  }
  std::vector<Place> places = Spread(hidden, options.places);
  for (const Place& place : Spread(excess, options.places)) places.push_back(place);
  return places;
}

}  // namespace

std::vector<OuterHit> HiddenSights(const core::TriangleMesh& visual,
                                   const core::TriangleMesh& solid,
                                   const HiddenSightOptions& options) {
  if (!(options.reach > 0.0) || !(options.radius > 0.0)) {
    throw core::Error("reach and radius must be positive", "hidden sights");
  }
  if (options.places < 0 || options.sights < 0) {
    throw core::Error("the number of places or sights is negative", "hidden sights");
  }
  const std::vector<Place> places = FarApart(visual, solid, options);
  const TriangleTree tree(visual);
  const double outside = 2.0 * core::Bounds(visual).diagonal().norm();
  std::vector<std::vector<OuterHit>> found(places.size());
  core::ParallelFor(static_cast<int>(places.size()), [&](int p) {
    core::CheckCancelled();
    const Place& place = places[static_cast<std::size_t>(p)];
    core::Rng rng = core::StreamRng(options.seed + 2, static_cast<std::uint64_t>(p));
    for (int i = 0; i < options.sights; ++i) {
      // Each line goes through a point that is known to be free: one on the line that got in. How
      // wide the slit is, and from how far round one sees in, is not known: scales are drawn
      // log-uniformly, along the wall that was seen and away from it on their own.
      const auto scale = [&] { return std::exp2(-kHalvings * core::Uniform(rng)); };
      const Vector3d through = place.point + options.radius * scale() * place.to_eye;
      const Vector3d any = core::UniformDirection(rng);
      const double out = any.dot(place.normal);
      const Vector3d to_eye =
          (place.to_eye + scale() * (any - out * place.normal) + scale() * out * place.normal)
              .normalized();
      if (!to_eye.allFinite() || tree.FirstHit(through, to_eye, outside)) continue;
      const auto hit = tree.FirstHit(through, -to_eye, outside);
      if (!hit || (hit->point - place.point).norm() > options.radius) continue;
      Vector3d normal = tree.Normal(hit->triangle);
      if (normal.dot(to_eye) < 0.0) normal = -normal;
      found[static_cast<std::size_t>(p)].push_back({hit->point, to_eye, normal});
    }
  });
  std::vector<OuterHit> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace simwright::geometry
