// Delighting on photos whose albedo is known, of objects and lights that no setting was chosen on.
#include "texture/delighting.h"

#include <gtest/gtest.h>

#include "ball.h"
#include "core/error.h"
#include "lit_photos.h"

namespace simwright::texture {
namespace {

TEST(Delighting, LowersTheErrorOnHeldOutPhotos) {
  double photo = 0.0, delit = 0.0, lumpy = 0.0;
  for (const std::string& kind : kHeldOutKinds) {
    for (std::uint64_t seed = 11; seed <= 13; ++seed) {
      const LitPhoto lit = TakeLitPhoto(kind, seed);
      photo += AlbedoError(lit, lit.view.photo);
      delit += AlbedoError(lit, DelightPhoto(lit.mesh, lit.view).albedo);
      lumpy += AlbedoError(lit, DelightPhoto(LumpyMesh(lit.mesh), lit.view).albedo);
    }
  }
  // Compilers differ by a tenth: g++ leaves less than 0.6, clang 0.61.
  EXPECT_LT(delit, 0.66 * photo);
  EXPECT_LT(lumpy, 0.9 * photo);  // of a shape that is known roughly
}

// A photo of a ball of even colour (sRGB) under one spherical-harmonics light.
class BallPhoto {
 public:
  explicit BallPhoto(const Eigen::Vector4f& color) {
    ball.mesh = Ball(48);
    ball.materials = {{"even", color, -1}};
    ball.triangle_material.assign(ball.mesh.triangles.size(), 0);
    const core::Camera camera = core::OrbitCamera({0, 0, 0}, 8.0, 0.3, 0.2, 0.35, 200, 200);
    render::Scene scene;
    scene.Add(&ball);
    scene.Commit();
    render::ForwardOptions options;
    options.shaded = true;
    light = render::SphericalHarmonicsLight::Studio({0.7f, -0.2f, 0.6f});
    light.radiance *= 0.5f;
    options.light = light;
    buffers = render::RenderForward(scene, camera, options);
    view = {camera, buffers.color, core::Image(200, 200, 1)};
    for (std::size_t i = 0; i < buffers.label.size(); ++i) {
      view.alpha.pixels[i] = buffers.label[i] >= 0 ? 255 : 0;
    }
  }

  // Returns the pixels whose normal is within an angle (rad) of the one that mirrors the light.
  std::vector<std::size_t> Mirroring(double angle) const {
    const Eigen::Vector3f camera = view.camera.position().cast<float>().normalized();
    const Eigen::Vector3f half = (camera + Eigen::Vector3f(0.7f, -0.2f, 0.6f).normalized());
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < buffers.label.size(); ++i) {
      if (buffers.label[i] < 0) continue;
      if (buffers.normal[i].dot(half.normalized()) > std::cos(angle)) found.push_back(i);
    }
    return found;
  }

  core::TexturedMesh ball;
  render::SphericalHarmonicsLight light;
  render::ForwardBuffers buffers;
  PhotoView view;
};

TEST(Delighting, FindsTheLightOfAnEvenBall) {
  const BallPhoto photo(Eigen::Vector4f::Ones());
  DelightingOptions exact;
  exact.band1_ridge = exact.band2_ridge = 1e-6;
  const DelitPhoto delit = DelightPhoto(photo.ball.mesh, photo.view, exact);
  double error = 0.0, truth_sum = 0.0, found_sum = 0.0;
  const auto for_pixels = [&](const auto& body) {
    for (std::size_t i = 0; i < photo.buffers.label.size(); ++i) {
      if (photo.buffers.label[i] < 0) continue;
      const Eigen::Vector3f& normal = photo.buffers.normal[i];
      body(photo.light.Shade(normal).x(), delit.light.Shade(normal).x());
    }
  };
  for_pixels([&](double truth, double found) {
    truth_sum += truth;
    found_sum += found;
  });
  for_pixels([&](double truth, double found) {
    error = std::max(error, std::abs(found / found_sum * truth_sum / truth - 1.0));
  });
  EXPECT_LT(error, 0.08);
  EXPECT_GT(delit.contrast, 1.3);
}

// A highlight that fades out is replaced by the colour about it, a white label is not.
TEST(Delighting, ReplacesHighlightsAndKeepsPrint) {
  BallPhoto glossy({0.7f, 0.2f, 0.15f, 1.0f});
  BallPhoto printed = glossy;
  const Eigen::Vector3f camera = glossy.view.camera.position().cast<float>().normalized();
  const Eigen::Vector3f half = (camera + Eigen::Vector3f(0.7f, -0.2f, 0.6f).normalized());
  for (const std::size_t i : glossy.Mirroring(0.5)) {
    const double h = glossy.buffers.normal[i].dot(half.normalized());
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& value = glossy.view.photo.pixels[4 * i + c];
      value = static_cast<std::uint8_t>(std::min(250.0, value + 170.0 * std::pow(h, 120.0)));
    }
  }
  for (const std::size_t i : printed.Mirroring(0.2)) {
    for (std::size_t c = 0; c < 3; ++c) printed.view.photo.pixels[4 * i + c] = 220;
  }
  const DelitPhoto delit = DelightPhoto(glossy.ball.mesh, glossy.view);
  EXPECT_GT(delit.highlights, 0.005);
  EXPECT_LT(delit.highlights, 0.12);
  const auto mean_green = [](const core::Image& image, const std::vector<std::size_t>& pixels) {
    double sum = 0.0;
    for (const std::size_t i : pixels) sum += image.pixels[3 * i + 1];
    return sum / static_cast<double>(pixels.size());
  };
  const std::vector<std::size_t> core = glossy.Mirroring(0.08);
  // 0.2 of 255 before light; about 220 in the highlight.
  EXPECT_LT(mean_green(delit.albedo, core), 80.0);
  const DelitPhoto kept = DelightPhoto(printed.ball.mesh, printed.view);
  EXPECT_EQ(kept.highlights, 0.0);
  EXPECT_GT(mean_green(kept.albedo, printed.Mirroring(0.15)), 150.0);
}

TEST(Delighting, IsRepeatableAndRefusesWhatDoesNotFit) {
  const LitPhoto lit = TakeLitPhoto("mug", 9);
  EXPECT_EQ(DelightPhoto(lit.mesh, lit.view).albedo.pixels,
            DelightPhoto(lit.mesh, lit.view).albedo.pixels);
  PhotoView wrong = lit.view;
  wrong.alpha = core::Image(10, 10, 1);
  EXPECT_THROW(DelightPhoto(lit.mesh, wrong), core::Error);
  wrong = lit.view;
  std::fill(wrong.alpha.pixels.begin(), wrong.alpha.pixels.end(), 0);
  EXPECT_THROW(DelightPhoto(lit.mesh, wrong), core::Error);
  EXPECT_THROW(DelightPhoto({}, lit.view), core::Error);
  DelightingOptions options;
  options.pairs = 0;
  EXPECT_THROW(DelightPhoto(lit.mesh, lit.view, options), core::Error);
}

}  // namespace
}  // namespace simwright::texture
