#include "asset_lift/lift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_validity.h"
#include "render/forward.h"
#include "tests/sanitized.h"

namespace simwright::asset_lift {
namespace {

// A cylinder standing on z = 0, closed.
core::TexturedMesh LiftCylinder(double radius, double height) {
  core::TexturedMesh mesh;
  constexpr int kSides = 96;
  mesh.mesh.vertices = {{0, 0, 0}, {0, 0, height}};
  for (int i = 0; i < kSides; ++i) {
    const double a = 2 * M_PI * i / kSides;
    mesh.mesh.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), 0);
    mesh.mesh.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), height);
  }
  for (int i = 0; i < kSides; ++i) {
    const int a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % kSides);
    mesh.mesh.triangles.insert(mesh.mesh.triangles.end(),
                               {{0, b, a}, {1, a + 1, b + 1}, {a, b, a + 1}, {b, b + 1, a + 1}});
  }
  mesh.materials.push_back({"paint", {0.8f, 0.2f, 0.1f, 1.0f}, -1});
  mesh.triangle_material.assign(mesh.mesh.triangles.size(), 0);
  return mesh;
}

constexpr double kLiftFov = 0.61;

// RGBA photo of a mesh from `elevation`, its background transparent.
core::Image LiftPhotograph(const core::TexturedMesh& mesh, double elevation, int size) {
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  const Eigen::AlignedBox3d box = core::Bounds(mesh.mesh);
  const core::Camera camera = core::OrbitCamera(box.center(), 1.9 * box.diagonal().norm(),
                                                elevation, -M_PI / 2, kLiftFov, size, size);
  render::ForwardOptions options;
  options.shaded = true;
  options.samples_per_side = 3;
  return render::RenderForward(scene, camera, options).color;
}

CategoryPrior PotPrior() {
  CategoryPrior prior;
  prior.length_min = prior.width_min = 0.07;
  prior.length_max = prior.width_max = 0.09;
  prior.height_min = 0.09;
  prior.height_max = 0.11;
  prior.revolved = true;
  return prior;
}

TEST(Lift, ACylinderComesBackAsOne) {
  const double elevation = 0.45;
  const core::Image photo = LiftPhotograph(LiftCylinder(0.04, 0.1), elevation, 300);
  LiftOptions options;
  options.elevation = elevation;
  core::Progress progress;
  const LiftedMesh lifted = LiftPhoto(photo, PotPrior(), {}, options, &progress);
  EXPECT_GE(lifted.silhouette_iou, 0.97);
  EXPECT_EQ(lifted.form, ShapeForm::kUpright);
  const geometry::MeshValidity soundness = geometry::Examine(lifted.mesh.mesh);
  EXPECT_TRUE(soundness.IsSolid()) << geometry::Describe(soundness);
  // Volume over that of the bounding box: pi / 4 for any upright cylinder.
  const Eigen::Vector3d size = core::Bounds(lifted.mesh.mesh).sizes();
  const double volume = geometry::SolidMassProperties(lifted.mesh.mesh, 1.0).volume;
  EXPECT_NEAR(volume / size.prod(), M_PI / 4, 0.03);
  EXPECT_NEAR(size.z() / size.x(), 0.1 / 0.08, 0.08);
}

// The photo of an evenly painted cylinder has its shading only: little of it stays in the texture.
TEST(Lift, DelightingEvensTheTextureOfACylinder) {
  const core::Image photo = LiftPhotograph(LiftCylinder(0.04, 0.1), 0.45, 300);
  LiftOptions options;
  options.elevation = 0.45;
  options.texture_size = 512;
  const auto unevenness = [&](bool delight) {
    options.delight = delight;
    core::Progress progress;
    const LiftedMesh lifted = LiftPhoto(photo, PotPrior(), {}, options, &progress);
    const bool found = std::any_of(lifted.findings.begin(), lifted.findings.end(),
                                   [](const core::Finding& f) { return f.code == "delighting"; });
    EXPECT_EQ(found, delight);
    const core::Image& texture = lifted.mesh.textures.at(0);
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < texture.pixels.size(); i += 3) {
      sum += texture.pixels[i];
      squares += static_cast<double>(texture.pixels[i]) * texture.pixels[i];
    }
    const double mean = 3.0 * sum / static_cast<double>(texture.pixels.size());
    const double square = 3.0 * squares / static_cast<double>(texture.pixels.size());
    return std::sqrt(std::max(0.0, square - mean * mean)) / mean;
  };
  EXPECT_LT(unevenness(true), 0.6 * unevenness(false));
}

TEST(Lift, EstimatesTheElevationOfAPot) {
  SKIP_UNDER_SANITIZERS();
  for (const double elevation : {0.2, 0.4, 0.6}) {
    core::Progress progress;
    const LiftedMesh lifted = LiftPhoto(LiftPhotograph(LiftCylinder(0.04, 0.1), elevation, 300),
                                        PotPrior(), {}, {}, &progress);
    EXPECT_NEAR(lifted.elevation.elevation, elevation, 0.175) << elevation;
  }
}

TEST(Lift, TwoReadingsOfAnElevationWeighTheirPrecision) {
  const ElevationEstimate joint = Combined({0.2, 0.1, "a"}, {0.5, 0.2, "b"});
  // Precisions 100 and 25: shares 0.8 and 0.2; variance 1 / 125 + 0.16 * 0.3^2.
  EXPECT_NEAR(joint.elevation, 0.26, 1e-12);
  EXPECT_NEAR(joint.deviation, std::sqrt(0.008 + 0.0144), 1e-12);
  EXPECT_NE(joint.sentence.find("a; b"), std::string::npos) << joint.sentence;
}

TEST(Lift, AHoleInTheOutlineGoesThroughTheMesh) {
  core::Image photo(200, 200, 4);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const double r = std::hypot(x - 100.0, y - 100.0);
      if (r > 35 && r < 80) {
        photo.At(x, y)[1] = 180;
        photo.At(x, y)[3] = 255;
      }
    }
  }
  LiftOptions options;
  options.elevation = 0.3;
  core::Progress progress;
  const LiftedMesh lifted = LiftPhoto(photo, {}, {}, options, &progress);
  EXPECT_GE(lifted.silhouette_iou, 0.97);
  EXPECT_TRUE(geometry::Examine(lifted.mesh.mesh).IsSolid());
  // A ring has Euler characteristic 0, a ball 2.
  const long v = static_cast<long>(lifted.mesh.mesh.vertices.size());
  const long f = static_cast<long>(lifted.mesh.mesh.triangles.size());
  EXPECT_EQ(v - 3 * f / 2 + f, 0);
}

TEST(Segmentation, FindsABrightDiscOnATexturedGround) {
  core::Image photo(240, 200, 3);
  core::Rng rng(3);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 240; ++x) {
      const bool in = std::hypot(x - 125.0, y - 95.0) < 55;
      const int noise = static_cast<int>(core::UniformIndex(rng, 30));
      photo.At(x, y)[0] = static_cast<uint8_t>(in ? 190 + noise : 60 + noise);
      photo.At(x, y)[1] = static_cast<uint8_t>(in ? 60 + noise : 90 + noise);
      photo.At(x, y)[2] = static_cast<uint8_t>(in ? 40 + noise : 70 + noise);
    }
  }
  const Matte matte = SegmentObject(photo, {});
  double both = 0, either = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 240; ++x) {
      const bool truth = std::hypot(x - 125.0, y - 95.0)<55, found = matte.alpha.At(x, y)[0]> 127;
      both += truth && found;
      either += truth || found;
    }
  }
  EXPECT_GT(both / either, 0.95);
}

// The apple is red, the wall behind it green: an ellipse about the apple's flat top must exclude
// the wall beside the stem and include all of the red.
TEST(Segmentation, ARoundThingMayBeFlatOnTop) {
  const core::Image photo = core::ReadImage(SIMWRIGHT_SOURCE_DIR "/examples/apple.jpg");
  SegmentationOptions options;
  options.round_object = true;
  const Matte matte = SegmentObject(photo, {}, options);
  int inside = 0, green = 0, red = 0, red_left_out = 0;
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      const std::uint8_t* p = photo.At(x, y);
      const bool found = matte.alpha.At(x, y)[0] > 127;
      inside += found;
      green += found && p[1] > p[0] && p[1] > 80;
      red += p[0] > p[1] + 40;
      red_left_out += p[0] > p[1] + 40 && !found;
    }
  }
  EXPECT_GT(inside, 0);
  EXPECT_LT(green, 0.02 * inside);
  EXPECT_LT(red_left_out, 0.02 * red);
}

TEST(Segmentation, SaysWhyThereIsNoObject) {
  EXPECT_THROW(SegmentObject(core::Image(1, 1, 3), {}), core::Error);
  EXPECT_THROW(SegmentObject(core::Image(100, 100, 4), {}), core::Error);       // transparent
  EXPECT_THROW(SegmentObject(core::Image(100, 100, 3, 128), {}), core::Error);  // uniform
  core::Image two(200, 100, 4);
  for (int y = 20; y < 80; ++y) {
    for (int x : {30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 150, 151, 152, 153, 154, 155, 156, 157}) {
      two.At(x, y)[3] = 255;
    }
  }
  try {
    SegmentObject(two, {});
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("two objects"), std::string::npos);
  }
  EXPECT_THROW(SegmentObject(core::Image(100, 100, 3), core::Image(50, 100, 1, 255)), core::Error);
}

}  // namespace
}  // namespace simwright::asset_lift
