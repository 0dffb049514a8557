#include "tests/capture/rendered_views.h"

#include <numbers>
#include <utility>

#include "capture/voting_hull.h"
#include "core/camera.h"
#include "core/random.h"
#include "render/forward.h"

namespace simwright::capture {
namespace {

constexpr double kViewDegree = std::numbers::pi / 180.0;

}  // namespace

RenderedViews RenderViews(const core::TexturedMesh& object, int count) {
  RenderedViews rendered;
  render::Scene scene;
  scene.Add(&object);
  scene.Commit();
  render::ForwardOptions shaded;
  shaded.shaded = true;
  shaded.samples_per_side = 3;
  const Eigen::AlignedBox3d box = core::Bounds(object.mesh);
  rendered.diagonal = box.diagonal().norm();
  core::Rng rng(3);
  for (int i = 0; i < count; ++i) {
    const double elevation = (i % 3 == 0 ? 15.0 : i % 3 == 1 ? 38.0 : 62.0) * kViewDegree;
    asset_lift::ObservedView view;
    view.camera = core::OrbitCamera(box.center(), 4.0 * rendered.diagonal, elevation,
                                    2.0 * std::numbers::pi * i / count, 0.27, 220, 220);
    const render::ForwardBuffers buffers = render::RenderForward(scene, view.camera, shaded);
    view.color = core::FloatImage(220, 220, 3);
    view.opacity = core::FloatImage(220, 220, 1);
    view.opacity.values = buffers.mask;
    for (std::size_t p = 0; p < buffers.mask.size(); ++p) {
      for (std::size_t c = 0; c < 3; ++c) {
        view.color.values[3 * p + c] =
            static_cast<float>((buffers.color.pixels[4 * p + c] + 1.5 * core::Normal(rng)) / 255.0);
      }
    }
    rendered.depths.push_back(buffers.depth);
    rendered.views.push_back(std::move(view));
  }
  HullVote vote;
  vote.views = rendered.views;
  vote.tolerated = 0;
  Eigen::AlignedBox3d grown = box;
  grown.min().array() -= 0.05 * rendered.diagonal;
  grown.max().array() += 0.05 * rendered.diagonal;
  rendered.hull = VotingHull({vote}, grown, {96, 0.0});
  return rendered;
}

}  // namespace simwright::capture
