// The training examples of the shape prior, and the evaluation of its predictions at points, as
// images and as surfaces.
#include "asset_lift/priors/shape_prior.h"

#include <gtest/gtest.h>

#include <cmath>

#include "asset_lift/priors/initial_shape.h"
#include "asset_lift/priors/shape_example.h"
#include "asset_lift/priors/silhouette_consistency.h"
#include "asset_lift/priors/training_shapes.h"
#include "core/error.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_validity.h"

namespace simwright::asset_lift {
namespace {

constexpr size_t kPixels = static_cast<size_t>(kCropSide) * kCropSide;

// A ball of radius 0.5 at the origin, from ten radii away: the prediction of a perfect prior. The
// front is red, the hidden side blue.
ShapePrediction BallPrediction() {
  ShapePrediction ball;
  ball.frame.camera = core::OrbitCamera(Eigen::Vector3d::Zero(), 5.0, 0.3, -1.2, 0.3, 128, 128);
  ball.frame.center_x = ball.frame.center_y = 64;
  ball.frame.half = 0.65 * ball.frame.camera.fx / 5.0;
  ball.frame.depth = 5.0;
  ball.crop = core::Image(kCropSide, kCropSide, 4);
  ball.back = core::Image(kCropSide, kCropSide, 3);
  ball.logits.resize(kPixels * kDepthCells);
  ball.front_w.assign(kPixels, 0.0f);
  ball.back_w.assign(kPixels, 0.0f);
  const double unit = ball.frame.Radius();
  for (int y = 0; y < kCropSide; ++y) {
    for (int x = 0; x < kCropSide; ++x) {
      const size_t at = static_cast<size_t>(y) * kCropSide + x;
      const Eigen::Vector2d uv((x + 0.5) * 2 / kCropSide - 1, (y + 0.5) * 2 / kCropSide - 1);
      ball.crop.pixels[4 * at] = 255;
      ball.back.pixels[3 * at + 2] = 255;
      double most = -8.0;
      for (int k = 0; k < kDepthCells; ++k) {
        const double w = kDepthReach * ((k + 0.5) * 2.0 / kDepthCells - 1.0);
        const double r = ball.frame.PointAt({uv.x(), uv.y(), w}).norm();
        const double logit = std::clamp(30.0 * (0.5 - r) / unit, -8.0, 8.0);
        ball.logits[static_cast<size_t>(k) * kPixels + at] = static_cast<float>(logit);
        most = std::max(most, logit);
      }
      ball.crop.pixels[4 * at + 3] = most > 0.0 ? 255 : 0;
      const double left = 0.25 - std::pow(0.65 * uv.norm(), 2);
      const double half = left > 0.0 ? std::sqrt(left) / unit : 0.0;
      ball.front_w[at] = static_cast<float>(-half);
      ball.back_w[at] = static_cast<float>(half);
    }
  }
  ball.box = FilledBox(ball);
  return ball;
}

TEST(ShapePrediction, ABallIsABallInOddsSurfaceAndPicture) {
  const ShapePrediction ball = BallPrediction();
  EXPECT_GT(ball.Logit({0, 0, 0}), 4.0f);
  EXPECT_GT(ball.Logit({0, 0, 0.4}), 1.0f);
  EXPECT_LT(ball.Logit({0, 0, 0.6}), -1.0f);
  EXPECT_LT(ball.Logit({9, 0, 0}), -7.0f);  // outside the block

  const core::TriangleMesh surface = PredictedSurface(ball, 64);
  EXPECT_TRUE(geometry::Examine(surface).IsSolid());
  EXPECT_NEAR(geometry::SolidMassProperties(surface, 1.0).mass, M_PI / 6, 0.03);

  // From the side: half of it red, half blue, and as large as the ball's outline.
  const core::Camera side =
      core::OrbitCamera(Eigen::Vector3d::Zero(), 5.0, 0.0, -1.2 + M_PI / 2, 0.3, 48, 48);
  const RenderedPrediction drawn = RenderPrediction(ball, side);
  double area = 0.0, red = 0.0, blue = 0.0;
  for (int i = 0; i < 48 * 48; ++i) {
    area += drawn.picture.opacity.values[static_cast<size_t>(i)];
    red += drawn.picture.color.values[static_cast<size_t>(3 * i)];
    blue += drawn.picture.color.values[static_cast<size_t>(3 * i + 2)];
  }
  // A ball's outline from 5: tan of its half angle.
  const double radius = side.fx * std::tan(std::asin(0.1));
  EXPECT_NEAR(area, M_PI * radius * radius, 0.04 * area);
  EXPECT_NEAR(red / (red + blue), 0.5, 0.08);
  EXPECT_NEAR(drawn.depth.At(24, 24)[0], 4.5, 0.05);
}

// Returns the first and the last filled cell of a pixel's column, and the count.
Eigen::Vector3i FilledCells(const ShapePrediction& prediction, int x, int y) {
  Eigen::Vector3i cells(-1, -1, 0);
  for (int k = 0; k < kDepthCells; ++k) {
    const size_t at = static_cast<size_t>(k) * kPixels + static_cast<size_t>(y) * kCropSide +
                      static_cast<size_t>(x);
    if (prediction.logits[at] <= 0.0f) continue;
    if (cells[0] < 0) cells[0] = k;
    cells[1] = k;
    ++cells[2];
  }
  return cells;
}

// Every pixel of a band is in the mask; the network is certain of its left half, and about its
// right half knows only an approximate depth, different in each row.
TEST(OutlineHold, UnsureColumnsGetASmoothSheetAndSureOnesKeepTheirWord) {
  constexpr int kTop = 20, kBottom = 44, kLeft = 10, kMiddle = 32, kRight = 54;
  ShapePrediction held;
  held.crop = core::Image(kCropSide, kCropSide, 4);
  held.logits.assign(kPixels * kDepthCells, -6.0f);
  const auto logit = [&](int x, int y, int k) -> float& {
    return held.logits[static_cast<size_t>(k) * kPixels + static_cast<size_t>(y) * kCropSide +
                       static_cast<size_t>(x)];
  };
  for (int y = kTop; y < kBottom; ++y) {
    for (int x = kLeft; x < kRight; ++x) {
      held.crop.At(x, y)[3] = 255;
      const int wanders = 30 + (y % 2 == 0 ? 3 : -3);
      for (int k = 0; k < kDepthCells; ++k) {
        if (x < kMiddle) {
          logit(x, y, k) = k >= 28 && k <= 31 ? 3.0f : -6.0f;
        } else {
          logit(x, y, k) = std::abs(k - wanders) < 5 ? -1.0f : -6.0f;
        }
      }
    }
  }
  EnforceSilhouetteConsistency(&held);
  EXPECT_EQ(FilledCells(held, 20, 30), Eigen::Vector3i(28, 31, 4));
  EXPECT_EQ(FilledCells(held, 4, 30), Eigen::Vector3i(-1, -1, 0));  // beside the outline
  // The sheet is one piece, near the mean of the rows' readings, although they alternate.
  for (int y = kTop + 4; y < kBottom - 4; ++y) {
    const Eigen::Vector3i cells = FilledCells(held, 44, y);
    ASSERT_GT(cells[2], 0) << y;
    EXPECT_EQ(cells[1] - cells[0] + 1, cells[2]) << y;
    EXPECT_NEAR(0.5 * (cells[0] + cells[1]), 30.0, 1.5) << y;
  }
  // The sheet is as thick as the band is wide there: more in its middle than at its edge.
  EXPECT_GT(FilledCells(held, 44, 32)[2], FilledCells(held, 44, kTop)[2] + 2);
  const size_t at = 32 * kCropSide + 44;
  EXPECT_LT(held.front_w[at], held.back_w[at]);
}

TEST(InitialShape, OddsOfAMeshFollowItsSurface) {
  const InitialShape guess = InitialEllipsoid(BallPrediction().frame, {0.8, 0.4});
  const double unit = BallPrediction().frame.Radius();
  EXPECT_TRUE(geometry::Examine(guess.surface).IsSolid());
  EXPECT_NEAR(geometry::SolidMassProperties(guess.surface, 1.0).mass,
              4.0 / 3 * M_PI * 0.8 * 0.4 * 0.4 * unit * unit * unit, 0.03 * unit * unit * unit);
  EXPECT_NEAR(guess.odds({0, 0, 0}), 4.0, 1e-9);
  EXPECT_NEAR(guess.odds({0, 0, 3}), -4.0, 1e-9);
  EXPECT_NEAR(guess.odds(guess.surface.vertices[40]), 0.0, 0.2);
}

TEST(TrainingShapes, AreSeenWholeAndFillTheirTruth) {
  for (int i = 0; i < 12; ++i) {
    core::Rng rng = core::StreamRng(7, static_cast<std::uint64_t>(i));
    const TrainingObject object(MakeTrainingShape(&rng), {1.1, 0.9, 1.0});
    const ShapeExample example = MakeShapeExample(object, &rng);
    // The silhouette touches the inside of the margin, and each of its pixels has occupied cells
    // behind it.
    int covered = 0, explained = 0;
    for (size_t p = 0; p < kPixels; ++p) {
      if (example.picture[4 * p + 3] < 255) continue;
      ++covered;
      int most = 0;
      for (int k = 0; k < kDepthCells; ++k) {
        most = std::max<int>(most, example.occupancy[static_cast<size_t>(k) * kPixels + p]);
      }
      explained += most > 127;
    }
    EXPECT_GT(covered, 60) << i;
    EXPECT_GT(explained, 0.9 * covered) << i;
    EXPECT_EQ(example.picture[3], 0) << i;  // the corner is free
    // The frame and the mesh agree: the mesh's vertices lie in the block.
    for (const Eigen::Vector3d& v : object.mesh().mesh.vertices) {
      EXPECT_LT(example.frame.Locate(v).head<2>().cwiseAbs().maxCoeff(), 1.0) << i;
    }
    EXPECT_EQ(MakeTrainingShape(&(rng = core::StreamRng(7, static_cast<std::uint64_t>(i))))
                  .mesh.vertices.size(),
              object.mesh().mesh.vertices.size());
  }
}

TEST(ShapePrior, RefusesWeightsThatAreNone) {
  EXPECT_THROW(ShapePrior("/nowhere/shape_prior.pt"), core::Error);
}

}  // namespace
}  // namespace simwright::asset_lift
