#include "asset_lift/radiance_field/field_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "asset_lift/radiance_field/field_carving.h"
#include "asset_lift/radiance_field/field_losses.h"
#include "asset_lift/radiance_field/field_surface.h"
#include "asset_lift/radiance_field/field_targets.h"
#include "core/error.h"
#include "geometry/mesh_validity.h"
#include "tests/sanitized.h"

namespace simwright::asset_lift {
namespace {

constexpr double kFieldFitFov = 0.5;

// Renders an unlit ball of radius 0.15 about `center`, red where x > center.x, blue elsewhere, with
// 3 x 3 rays per pixel.
ObservedView BallView(double azimuth, double elevation, int size,
                      const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
  constexpr double kRadius = 0.15;
  ObservedView view;
  view.camera =
      core::OrbitCamera(Eigen::Vector3d::Zero(), 1.0, elevation, azimuth, kFieldFitFov, size, size);
  view.color = core::FloatImage(size, size, 3);
  view.opacity = core::FloatImage(size, size, 1);
  view.depth = core::FloatImage(size, size, 1);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      int hits = 0;
      double red = 0.0, depth = 0.0;
      for (int n = 0; n < 9; ++n) {
        const Eigen::Vector3d ray = view.camera.Ray({x + (n % 3 + 0.5) / 3, y + (n / 3 + 0.5) / 3});
        const Eigen::Vector3d from = view.camera.position() - center;
        const double a = ray.squaredNorm(), b = ray.dot(from);
        const double root = b * b - a * (from.squaredNorm() - kRadius * kRadius);
        if (root < 0.0) continue;
        const double t = (-b - std::sqrt(root)) / a;
        ++hits;
        red += (from + t * ray).x() > 0.0;
        depth += t;
      }
      *view.opacity.At(x, y) = static_cast<float>(hits / 9.0);
      if (hits == 0) continue;
      const double share = red / hits;
      view.color.At(x, y)[0] = static_cast<float>(0.1 + 0.8 * share);
      view.color.At(x, y)[1] = 0.2f;
      view.color.At(x, y)[2] = static_cast<float>(0.9 - 0.8 * share);
      *view.depth.At(x, y) = static_cast<float>(depth / hits);
    }
  }
  return view;
}

std::vector<ObservedView> EightViews(int size) {
  std::vector<ObservedView> views;
  for (int i = 0; i < 8; ++i) {
    views.push_back(BallView(i * M_PI / 4, i % 2 == 0 ? 0.3 : -0.6, size));
    views.back().depth = {};
  }
  return views;
}

FieldFitOptions QuickOptions(int steps, int side) {
  FieldFitOptions options;
  options.field.half_side = 0.25;
  options.stages = {{steps, side}};
  options.rays_per_step = 1536;
  return options;
}

FieldSurface QuickSurface(const FieldFit& fit, const std::vector<ObservedView>& views) {
  FieldSurfaceOptions options;
  options.resolution = 48;
  options.silhouette_side = 64;
  return ExtractSurface(fit, views, options);
}

// Returns the volume IoU of the ball of radius 0.15 about `center` and a closed mesh around it, at
// 40^3 points; a point is inside the mesh if the field's density there is above the surface's
// level.
double BallIou(const FieldFit& fit, double level, const Eigen::Vector3d& center) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 64000; ++i) {
    const Eigen::Vector3d unit(i % 40, i / 40 % 40, i / 1600);
    points.push_back(((unit.array() + 0.5) / 20.0 - 1.0) * 0.25);
  }
  const std::vector<float> density = fit.field.DensityAt(points);
  int both = 0, either = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d unit = points[i] / 0.25;
    const bool field = density[i] > level && fit.occupancy.Allowed(unit.x(), unit.y(), unit.z());
    const bool ball = (points[i] - center).norm() < 0.15;
    both += field && ball;
    either += field || ball;
  }
  return static_cast<double>(both) / either;
}

TEST(FieldFit, EightViewsOfABallGiveItsShapeAndColours) {
  const std::vector<ObservedView> views = EightViews(48);
  const FieldFit fit = FitField(views, nullptr, QuickOptions(80, 48), nullptr);
  EXPECT_EQ(fit.losses.size(), 80u);
  EXPECT_TRUE(fit.findings.empty());
  EXPECT_LT(fit.color_error, 0.08);
  const FieldSurface surface = QuickSurface(fit, views);
  EXPECT_TRUE(surface.findings.empty());
  EXPECT_GT(surface.iou, 0.93);  // 2.5 pixels of 48 off the radius would give 0.7
  EXPECT_GT(BallIou(fit, surface.level, Eigen::Vector3d::Zero()), 0.85);
  EXPECT_TRUE(geometry::Examine(surface.mesh).IsSolid());
  ASSERT_EQ(surface.colors.size(), surface.mesh.vertices.size());
  double error = 0.0;
  int counted = 0;
  for (std::size_t i = 0; i < surface.colors.size(); ++i) {
    const double x = surface.mesh.vertices[i].x();
    if (std::abs(x) < 0.02) continue;
    const Eigen::Vector3f truth =
        x > 0 ? Eigen::Vector3f(0.9f, 0.2f, 0.1f) : Eigen::Vector3f(0.1f, 0.2f, 0.9f);
    error += (surface.colors[i] - truth).cwiseAbs().mean();
    ++counted;
  }
  EXPECT_LT(error / counted, 0.1);
}

// An objective whose target is the ball's image; non-finite from step `nan_from` on, `nan_count`
// times.
class BallObjective : public ImageObjective {
 public:
  core::Camera NextCamera(double progress, core::Rng* rng) override {
    EXPECT_GE(progress, 0.0);
    EXPECT_LT(progress, 1.0);
    azimuth_ = core::Uniform(*rng, -M_PI, M_PI);
    elevation_ = core::Uniform(*rng, -0.5, 0.8);
    return core::OrbitCamera(Eigen::Vector3d::Zero(), 1.0, elevation_, azimuth_, kFieldFitFov, 32,
                             32);
  }

  double Evaluate(const core::Camera& camera, const ObjectImage& picture, double, core::Rng*,
                  ObjectImage* gradient) override {
    EXPECT_EQ(camera.width, 32);
    const ObservedView truth = BallView(azimuth_, elevation_, 32, center);
    *gradient = picture;
    double loss = 0.0;
    for (int i = 0; i < 32 * 32; ++i) {
      const float opacity = truth.opacity.values[i];
      float* of_opacity = &gradient->opacity.values[i];
      loss += std::pow(picture.opacity.values[i] - opacity, 2);
      *of_opacity = 2.0f * (picture.opacity.values[i] - opacity);
      for (int c = 0; c < 3; ++c) {
        const float error =
            picture.color.values[3 * i + c] - opacity * truth.color.values[3 * i + c];
        loss += error * error;
        gradient->color.values[3 * i + c] = 2.0f * error;
      }
    }
    ++calls;
    if (calls > nan_from && nan_count-- > 0) gradient->opacity.values[32 * 16 + 16] = NAN;
    if (wrong_size) gradient->color.values.pop_back();
    return loss;
  }

  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  int calls = 0;
  int nan_from = 0, nan_count = 0;
  bool wrong_size = false;

 private:
  double azimuth_ = 0.0, elevation_ = 0.0;
};

TEST(FieldFit, OneViewAndAnObjectiveGiveTheBackToo) {
  SKIP_UNDER_SANITIZERS();
  // The ball is farther away than the initial blob, which one view alone cannot determine.
  const Eigen::Vector3d center(0.0, 0.07, 0.0);
  const std::vector<ObservedView> views = {BallView(-M_PI / 2, 0.3, 32, center)};
  FieldFitOptions options = QuickOptions(70, 32);
  const FieldFit alone = FitField(views, nullptr, options, nullptr);
  BallObjective objective;
  objective.center = center;
  options.weights.objective = 0.3;
  const FieldFit fit = FitField(views, &objective, options, nullptr);
  EXPECT_EQ(objective.calls, 70);
  const FieldSurface without = QuickSurface(alone, views);
  const FieldSurface with = QuickSurface(fit, views);
  EXPECT_FALSE(without.mesh.empty());
  EXPECT_TRUE(geometry::Examine(without.mesh).IsSolid());
  const double iou = BallIou(fit, with.level, center);
  EXPECT_GT(iou, 0.8);
  EXPECT_GT(iou, BallIou(alone, without.level, center) + 0.1);
}

TEST(FieldFit, SameSeedGivesTheSameField) {
  const std::vector<ObservedView> views = {BallView(-M_PI / 2, 0.3, 24)};
  const FieldFitOptions options = QuickOptions(12, 24);
  const FieldFit a = FitField(views, nullptr, options, nullptr);
  const FieldFit b = FitField(views, nullptr, options, nullptr);
  EXPECT_EQ(a.losses, b.losses);
  EXPECT_EQ(a.field.parameters(), b.field.parameters());
}

TEST(FieldFit, StepsBackFromNanAndGoesOn) {
  const std::vector<ObservedView> views = {BallView(-M_PI / 2, 0.3, 24)};
  BallObjective once;
  once.nan_from = 15;
  once.nan_count = 1;
  const FieldFit fit = FitField(views, &once, QuickOptions(30, 24), nullptr);
  EXPECT_EQ(fit.losses.size(), 30u);
  EXPECT_TRUE(fit.findings.empty());
  EXPECT_LT(fit.losses.back(), fit.losses[0]);

  BallObjective always;
  always.nan_from = 12;
  always.nan_count = 1000;
  const FieldFit stopped = FitField(views, &always, QuickOptions(30, 24), nullptr);
  EXPECT_EQ(stopped.losses.size(), 15u);
  ASSERT_EQ(stopped.findings.size(), 1u);
  EXPECT_EQ(stopped.findings[0].code, "field-fit-unstable");
  EXPECT_TRUE(std::all_of(stopped.field.parameters().begin(), stopped.field.parameters().end(),
                          [](float p) { return std::isfinite(p); }));
  EXPECT_FALSE(QuickSurface(stopped, views).mesh.empty());
}

TEST(FieldFit, NamesTheViewThatContradictsTheOthers) {
  std::vector<ObservedView> views;
  for (int i = 0; i < 5; ++i) views.push_back(BallView(i * 1.2, 0.2, 32, {0.03, 0.0, 0.02}));
  FieldFitOptions options = QuickOptions(2, 32);
  EXPECT_TRUE(FitField(views, nullptr, options, nullptr).findings.empty());
  views[3].camera = core::OrbitCamera({-0.08, 0.15, 0.16}, 1.0, 0.2, 3.6, kFieldFitFov, 32, 32);
  const FieldFit fit = FitField(views, nullptr, options, nullptr);
  ASSERT_EQ(fit.findings.size(), 1u);
  EXPECT_EQ(fit.findings[0].code, "view-contradicts");
  EXPECT_EQ(fit.findings[0].place, "view 3");
  // With two views it is undecidable which is wrong.
  const Carving two = CarveByMasks({views[0], views[3]}, Eigen::Vector3d::Zero(), 0.25, 1.0);
  EXPECT_EQ(two.findings.size(), 2u);
  EXPECT_TRUE(two.contradicting.empty());
  EXPECT_EQ(std::count(two.allowed.begin(), two.allowed.end(), 0), 0);
}

TEST(FieldCarving, LeavesTheConesAndAllOfTheObject) {
  const std::vector<ObservedView> views = EightViews(64);
  const Carving carving = CarveByMasks(views, Eigen::Vector3d::Zero(), 0.25, 1.0);
  EXPECT_TRUE(carving.findings.empty());
  int inside = 0, lost = 0, left = 0;
  for (int c = 0; c < 64 * 64 * 64; ++c) {
    const Eigen::Vector3d cell(c % 64, c / 64 % 64, c / 4096);
    const Eigen::Vector3d at = ((cell.array() + 0.5) / 32.0 - 1.0) * 0.25;
    left += carving.allowed[c];
    if (at.norm() > 0.15) continue;
    ++inside;
    lost += carving.allowed[c] == 0;
  }
  EXPECT_EQ(lost, 0);
  EXPECT_LT(left, 2.0 * inside);  // the hull of eight cones, a cell and a pixel wider
  const Carving beside = CarveByMasks({views[0]}, {0.6, 0.6, 0.6}, 0.25, 1.0);
  ASSERT_EQ(beside.findings.size(), 1u);
  EXPECT_EQ(beside.findings[0].code, "field-beside-object");
}

// Returns an untrained fit whose density is that of `bias` everywhere.
FieldFit Bare(double bias) {
  RadianceFieldOptions options;
  options.half_side = 0.25;
  options.density_bias = [bias](const Eigen::Vector3d&) { return bias; };
  FieldFit fit{RadianceField(options, 1), {}, {}, 0.0, {}};
  for (float& p : fit.field.parameters()) p = 0.0f;
  return fit;
}

TEST(FieldSurface, HasFacesHoweverEmptyTheField) {
  const std::vector<ObservedView> views = {BallView(-M_PI / 2, 0.3, 32)};
  for (const double bias : {-6.0, -1000.0}) {
    FieldFit fit = Bare(bias);
    const Carving carving = CarveByMasks(views, Eigen::Vector3d::Zero(), 0.25, 1.0);
    fit.occupancy.Restrict(carving.allowed);
    const FieldSurface surface = QuickSurface(fit, views);
    EXPECT_GT(surface.mesh.triangles.size(), 100u);
    EXPECT_TRUE(geometry::Examine(surface.mesh).IsSolid());
    EXPECT_GT(surface.iou, 0.5);  // a cell and a pixel wider than the ball of 19 pixels
    ASSERT_FALSE(surface.findings.empty());
    EXPECT_EQ(surface.findings[0].code, "field-surface-faint");
  }
  // No cell is allowed and none is occupied: the cube replaces the surface.
  FieldFit nothing = Bare(-1000.0);
  nothing.occupancy.Restrict(std::vector<std::uint8_t>(64 * 64 * 64, 0));
  EXPECT_FALSE(QuickSurface(nothing, views).mesh.empty());
}

// Returns two balls, of which the mask shows one or both.
TEST(FieldSurface, KeepsTheComponentsThatTheMaskWants) {
  RadianceFieldOptions options;
  options.half_side = 0.3;
  options.density_bias = [](const Eigen::Vector3d& p) {
    const double large = 0.12 - (p - Eigen::Vector3d(-0.12, 0, 0)).norm();
    const double small = 0.06 - (p - Eigen::Vector3d(0.2, 0, 0)).norm();
    const double hollow = 0.05 - (p - Eigen::Vector3d(-0.12, 0, 0)).norm();
    return 500.0 * std::min(std::max(large, small), -hollow) + 10.0;
  };
  FieldFit fit{RadianceField(options, 1), {}, {}, 0.0, {}};
  for (float& p : fit.field.parameters()) p = 0.0f;
  ObservedView view = BallView(-M_PI / 2, 0.0, 64);
  const auto show = [&](bool both) {
    for (int i = 0; i < 64 * 64; ++i) {
      const Eigen::Vector3d ray = view.camera.Ray({i % 64 + 0.5, i / 64 + 0.5});
      const Eigen::Vector3d at = view.camera.position() + ray * (1.0 / ray.y());
      const bool large = (at - Eigen::Vector3d(-0.12, 0, 0)).norm() < 0.12;
      const bool small = (at - Eigen::Vector3d(0.2, 0, 0)).norm() < 0.06;
      view.opacity.values[i] = large || (both && small) ? 1.0f : 0.0f;
    }
    return QuickSurface(fit, {view});
  };
  const FieldSurface one = show(false), two = show(true);
  EXPECT_EQ(geometry::Examine(one.mesh).components, 1);  // and the hollow is filled
  EXPECT_EQ(geometry::Examine(two.mesh).components, 2);
  EXPECT_GT(one.iou, 0.9);
  EXPECT_GT(two.iou, 0.9);
  const Eigen::AlignedBox3d box = core::Bounds(one.mesh);
  EXPECT_NEAR(box.min().x(), -0.24, 0.01);
  EXPECT_NEAR(box.max().x(), 0.0, 0.01);
}

// Compares central differences of `loss` in each number of `values` with the gradient that it adds
// to `gradient`.
template <typename Loss>
void ExpectSlopes(std::vector<float>* values, const std::vector<float>& gradient,
                  const Loss& loss) {
  double largest = 0.0;
  for (const float g : gradient) largest = std::max<double>(largest, std::abs(g));
  ASSERT_GT(largest, 0.0);
  for (std::size_t i = 0; i < values->size(); ++i) {
    const float start = (*values)[i];
    const float high = start + 1e-3f, low = start - 1e-3f;
    (*values)[i] = high;
    const double above = loss();
    (*values)[i] = low;
    const double below = loss();
    (*values)[i] = start;
    EXPECT_NEAR((above - below) / (high - low), gradient[i], 4e-3 * largest) << i;
  }
}

TEST(FieldLosses, GradientsAreThoseOfFiniteDifferences) {
  PatchSampler deck({BallView(0.5, 0.3, 16)}, true);
  RayTargets targets;
  core::Rng rng(3);
  deck.NextBatch(64, &rng, &targets);
  const std::size_t count = targets.opacity.size();
  ASSERT_EQ(count, 64u);
  RayRenderings<float> seen, gradient;
  seen.Resize(count);
  for (float& x : seen.color) x = static_cast<float>(core::Uniform(rng));
  for (float& x : seen.depth) x = static_cast<float>(core::Uniform(rng));
  for (std::size_t r = 0; r < count; ++r) {
    seen.opacity[r] = static_cast<float>(core::Uniform(rng, 0.1, 0.9));
    const Eigen::Vector3d normal = core::UniformDirection(rng);
    for (int a = 0; a < 3; ++a) seen.normal[3 * r + a] = static_cast<float>(normal[a]);
  }
  FieldLossWeights weights;
  const auto observation = [&] {
    gradient.Resize(count);
    return AddObservationLoss(targets, seen, {0.2f, 0.5f, 0.8f}, 0.25, weights, &gradient);
  };
  observation();
  RayRenderings<float> expected = gradient;
  ExpectSlopes(&seen.color, expected.color, observation);
  ExpectSlopes(&seen.opacity, expected.opacity, observation);
  ExpectSlopes(&seen.depth, expected.depth, observation);
  const auto shape = [&] {
    gradient.Resize(count);
    return AddShapeLoss(targets.pixels, seen, weights, &gradient);
  };
  shape();
  expected = gradient;
  ExpectSlopes(&seen.normal, expected.normal, shape);
  // The opacity is a constant weight in the losses of the normals.
  weights.orientation = weights.normal_smoothness = 0.0;
  shape();
  expected = gradient;
  ExpectSlopes(&seen.opacity, expected.opacity, shape);
}

TEST(FieldTargets, ScaledViewsKeepWhatTheySee) {
  const ObservedView view = BallView(0.5, 0.3, 60);
  const ObservedView small = ScaledView(view, 16);
  EXPECT_EQ(small.camera.width, 16);
  EXPECT_EQ(ScaledView(view, 100).camera.width, 60);
  double before = 0.0, after = 0.0, red_before = 0.0, red_after = 0.0;
  for (int i = 0; i < 3600; ++i) {
    before += view.opacity.values[i] / 3600.0;
    red_before += view.opacity.values[i] * view.color.values[3 * i] / 3600.0;
  }
  for (int i = 0; i < 256; ++i) {
    after += small.opacity.values[i] / 256.0;
    red_after += small.opacity.values[i] * small.color.values[3 * i] / 256.0;
  }
  EXPECT_NEAR(before, after, 1e-5);
  EXPECT_NEAR(red_before, red_after, 1e-5);
  const Eigen::Vector3d point(0.05, -0.02, 0.1);
  const Eigen::Vector3d full = view.camera.Project(point), scaled = small.camera.Project(point);
  EXPECT_NEAR(full.x() / 60.0, scaled.x() / 16.0, 1e-9);
  EXPECT_NEAR(*small.depth.At(8, 8), 0.85, 0.02);  // the ball's near side
}

TEST(FieldTargets, DeckDealsEachPatchOnceBeforeAnyTwice) {
  PatchSampler deck({BallView(0.5, 0.3, 32)}, true);
  ASSERT_EQ(deck.size(), 32 * 32);
  core::Rng rng(3);
  RayTargets hand;
  std::vector<int> seen(32 * 32, 0);
  for (int n = 0; n < 4; ++n) {
    deck.NextBatch(256, &rng, &hand);
    for (const int pixel : hand.pixels.pixel) ++seen[pixel];
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 32 * 32);
  for (int n = 0; n < 5; ++n) {
    deck.NextBatch(3 * 256, &rng, &hand);
    std::fill(seen.begin(), seen.end(), 0);
    for (const int pixel : hand.pixels.pixel) ++seen[pixel];
    EXPECT_EQ(*std::max_element(seen.begin(), seen.end()), 1);
  }
}

TEST(FieldFit, RefusesViewsAndOptionsThatCannotBe) {
  const FieldFitOptions options = QuickOptions(2, 24);
  EXPECT_THROW(FitField({}, nullptr, options, nullptr), core::Error);
  const ObservedView good = BallView(0.0, 0.3, 24);
  ObservedView view = good;
  view.color.values[5] = NAN;
  EXPECT_THROW(FitField({good, view}, nullptr, options, nullptr), core::Error);
  view = good;
  view.opacity = core::FloatImage(24, 24, 1, 0.0f);
  EXPECT_THROW(FitField({view}, nullptr, options, nullptr), core::Error);
  view = good;
  view.opacity = core::FloatImage(23, 24, 1, 1.0f);
  EXPECT_THROW(FitField({view}, nullptr, options, nullptr), core::Error);
  view = good;
  view.camera.fx = 0.0;
  try {
    FitField({good, view}, nullptr, options, nullptr);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_EQ(error.where(), "view 2");
  }
  BallObjective objective;
  objective.wrong_size = true;
  EXPECT_THROW(FitField({good}, &objective, options, nullptr), core::Error);
  FieldFitOptions wrong = options;
  wrong.stages.clear();
  EXPECT_THROW(FitField({good}, nullptr, wrong, nullptr), core::Error);
  wrong = options;
  wrong.weights.mask = -1.0;
  EXPECT_THROW(FitField({good}, nullptr, wrong, nullptr), core::Error);
  FieldSurfaceOptions surface;
  surface.levels = {NAN};
  EXPECT_THROW(ExtractSurface(Bare(1.0), {good}, surface), core::Error);
}

}  // namespace
}  // namespace simwright::asset_lift
