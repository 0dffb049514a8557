#include "twin/table_crops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "library_fit/fit_kinds.h"
#include "library_fit/fit_view.h"
#include "render/forward.h"

namespace simwright::twin {
namespace {

using library_fit::kPriorSide;
using library_fit::PriorExample;

// Returns the instance that the labels describe.
library_fit::Instance InstanceOf(const PriorExample& example) {
  library_fit::Instance instance = library_fit::SampleInstance(example.kind, 1);
  for (size_t i = 0; i < example.log_size.size(); ++i) {
    instance.size[static_cast<Eigen::Index>(i)] = std::exp(example.log_size[i]);
  }
  for (size_t i = 0; i < std::min(instance.draws.size(), size_t{library_fit::kPriorDraws}); ++i) {
    if (example.choices[i] >= 0.0f) instance.draws[i] = example.choices[i];
  }
  instance.opening = std::max(0.0f, example.choices[library_fit::kPriorDraws]);
  return instance;
}

// Returns the share of pixels in which a render of the labels agrees with the crop's mask.
double Agreement(const PriorExample& example) {
  const core::TexturedMesh mesh = library_fit::InstanceMesh(InstanceOf(example));
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  const double half = 0.5 * kPriorSide / library_fit::kPriorMargin;
  const core::Camera camera = library_fit::CropCameraOf(
      example.view, mesh.mesh, Eigen::Vector2d::Constant(0.5 * kPriorSide), half, kPriorSide);
  render::ForwardOptions options;
  options.shaded = true;
  const core::Image seen = render::RenderForward(scene, camera, options).color;
  int both = 0, either = 0;
  for (int y = 0; y < kPriorSide; ++y) {
    for (int x = 0; x < kPriorSide; ++x) {
      const bool labels = seen.At(x, y)[3] > 127;
      const bool crop = example.picture[4 * (static_cast<size_t>(y) * kPriorSide + x) + 3] > 127;
      both += labels && crop ? 1 : 0;
      either += labels || crop ? 1 : 0;
    }
  }
  return static_cast<double>(both) / std::max(1, either);
}

TEST(TableCrop, ShowsTheInstanceOfItsLabels) {
  std::vector<double> agreements;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    const PriorExample example = TableCrop({}, seed);
    ASSERT_EQ(example.picture.size(), size_t{4} * kPriorSide * kPriorSide);
    agreements.push_back(Agreement(example));
  }
  std::sort(agreements.begin(), agreements.end());
  // Some objects are partly hidden, and so their crop is another; most are whole.
  EXPECT_GT(agreements[agreements.size() / 2], 0.85);
  EXPECT_GT(agreements[agreements.size() / 4], 0.7);
}

TEST(TableCrop, IsTheSameForASeed) {
  const PriorExample one = TableCrop({}, 9);
  EXPECT_EQ(one.picture, TableCrop({}, 9).picture);
  EXPECT_NE(one.picture, TableCrop({}, 10).picture);
}

}  // namespace
}  // namespace simwright::twin
