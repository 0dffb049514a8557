#include "geometry/occlusion_sampling.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kHalvings = 8.0;    // down to 0.4 % of a radius or of a radian
constexpr int kRaysAtOnce = 500000;  // at most 72 MB of hits

void AppendOcclusionSamplingDistant(const std::vector<OuterHit>& hits, const TriangleTree& solid,
                                    double reach, std::vector<OuterHit>* far) {
  constexpr int kBlock = 1024;
  const int count = static_cast<int>(hits.size());
  std::vector<char> near(hits.size());
  core::ParallelFor((count + kBlock - 1) / kBlock, [&](int block) {
    core::CheckCancelled();
    for (int i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
      near[i] = solid.Within(hits[i].point, reach);
    }
  });
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!near[i]) far->push_back(hits[i]);
  }
}

std::vector<OuterHit> Spread(const std::vector<OuterHit>& all, int most) {
  const std::size_t count = static_cast<std::size_t>(most);
  if (all.size() <= count) return all;
  std::vector<OuterHit> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

// Traces rays close to a known line of sight. Each passes through a point on that line, which is
// known to be free. The slit's width and the angle from which it is visible are unknown, so scales
// are sampled log-uniformly, independently along the wall that was hit and away from it.
std::vector<OuterHit> TraceNear(const OuterHit& known, const TriangleTree& visual, double outside,
                                const OcclusionSamplingOptions& options, core::Rng* rng) {
  std::vector<OuterHit> found;
  const auto scale = [&] { return std::exp2(-kHalvings * core::Uniform(*rng)); };
  for (int i = 0; i < options.rays_per_hit; ++i) {
    const Vector3d through = known.point + options.radius * scale() * known.to_eye;
    const Vector3d any = core::UniformDirection(*rng);
    const double out = any.dot(known.normal);
    const Vector3d to_eye =
        (known.to_eye + scale() * (any - out * known.normal) + scale() * out * known.normal)
            .normalized();
    if (!to_eye.allFinite() || visual.FirstHit(through, to_eye, outside)) continue;
    const auto hit = visual.FirstHit(through, -to_eye, outside);
    if (!hit) continue;
    Vector3d normal = visual.Normal(hit->triangle);
    if (normal.dot(to_eye) < 0.0) normal = -normal;
    found.push_back({hit->point, to_eye, normal});
  }
  return found;
}

}  // namespace

std::vector<OuterHit> SampleOccludedHits(const core::TriangleMesh& visual,
                                         const core::TriangleMesh& solid,
                                         const OcclusionSamplingOptions& options,
                                         int* random_count) {
  if (!(options.reach > 0.0) || !(options.radius > 0.0)) {
    throw core::Error("reach and radius must be positive", "hidden sights");
  }
  if (std::min({options.rays, options.places, options.rays_per_hit, options.generations}) < 0) {
    throw core::Error("the number of rays, places, sights or generations is negative",
                      "hidden sights");
  }
  const TriangleTree solid_tree(solid);
  std::vector<OuterHit> all;
  for (int done = 0; done < options.rays; done += kRaysAtOnce) {
    AppendOcclusionSamplingDistant(
        SampleOuterHits(visual, std::min(kRaysAtOnce, options.rays - done),
                        options.seed + static_cast<std::uint64_t>(done)),
        solid_tree, options.reach, &all);
  }
  if (random_count != nullptr) *random_count = static_cast<int>(all.size());
  const TriangleTree tree(visual);
  const double outside = 2.0 * core::Bounds(visual).diagonal().norm();
  std::vector<OuterHit> known = all;
  for (int generation = 0; generation < options.generations; ++generation) {
    known = Spread(known, options.places);
    std::vector<std::vector<OuterHit>> found(known.size());
    core::ParallelFor(static_cast<int>(known.size()), [&](int k) {
      core::CheckCancelled();
      core::Rng rng = core::StreamRng(options.seed + 1 + static_cast<std::uint64_t>(generation),
                                      static_cast<std::uint64_t>(k));
      found[k] = TraceNear(known[k], tree, outside, options, &rng);
    });
    known.clear();
    for (const auto& some : found)
      AppendOcclusionSamplingDistant(some, solid_tree, options.reach, &known);
    all.insert(all.end(), known.begin(), known.end());
  }
  return all;
}

}  // namespace simwright::geometry
