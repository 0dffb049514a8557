#include "geometry/convex_hull_2d.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector2d;

double Area(const std::vector<Vector2d>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

std::vector<Vector2d> RegularPolygon(int corners) {
  std::vector<Vector2d> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    polygon.emplace_back(std::cos(angle), std::sin(angle));
  }
  return polygon;
}

TEST(ConvexHull2d, OfASquareFullOfPointsIsItsCorners) {
  core::Rng rng(1);
  std::vector<Vector2d> points{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0}, {1, 0.3}};
  for (int i = 0; i < 200; ++i) points.emplace_back(core::Uniform(rng), core::Uniform(rng));
  const std::vector<Vector2d> hull = ConvexHull2d(points);
  EXPECT_EQ(hull.size(), 4u);
  EXPECT_NEAR(Area(hull), 1.0, 1e-15);
}

TEST(ConvexHull2d, OfALineHasNoArea) {
  EXPECT_LT(ConvexHull2d({{0, 0}, {1, 1}, {2, 2}, {0.5, 0.5}}).size(), 3u);
  EXPECT_EQ(ConvexHull2d({{3, 4}, {3, 4}}).size(), 1u);
}

TEST(SimplifyConvexPolygon, DropsWhatCostsLeastArea) {
  // A square with two corners cut by 1 %: four corners keep its area within 5 %.
  const std::vector<Vector2d> cut{{0.1, 0}, {0.9, 0}, {1, 0.1}, {1, 1}, {0, 1}, {0, 0.1}};
  EXPECT_EQ(SimplifyConvexPolygon(cut, 8, 0.0).size(), 6u);
  const std::vector<Vector2d> few = SimplifyConvexPolygon(cut, 8, 0.2);
  EXPECT_EQ(few.size(), 4u);
  EXPECT_GT(Area(few), 0.8 * Area(cut));
}

TEST(SimplifyConvexPolygon, KeepsToTheNumberWhateverTheLoss) {
  const std::vector<Vector2d> disc = RegularPolygon(64);
  const std::vector<Vector2d> few = SimplifyConvexPolygon(disc, 8, 0.05);
  EXPECT_EQ(few.size(), 8u);
  // No octagon in a disc has more area than the regular one.
  EXPECT_LE(Area(few), Area(RegularPolygon(8)) + 1e-12);
  EXPECT_GT(Area(few), 0.9 * Area(RegularPolygon(8)));
}

}  // namespace
}  // namespace simwright::geometry
