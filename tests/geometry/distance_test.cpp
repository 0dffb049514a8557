#include "geometry/distance.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "geometry/convex_hull.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

ConvexShape BoxShape(const Vector3d& half) {
  ConvexShape box;
  for (int c = 0; c < 8; ++c) {
    box.vertices.push_back(
        half.cwiseProduct(Vector3d(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1)));
  }
  return box;
}

// Returns the signed distance of two axis-aligned boxes in closed form.
double BoxDistance(const Vector3d& half_a, const Vector3d& half_b, const Vector3d& apart) {
  const Vector3d gap = apart.cwiseAbs() - half_a - half_b;
  return gap.maxCoeff() > 0.0 ? gap.cwiseMax(0.0).norm() : gap.maxCoeff();
}

TEST(SignedDistance, AxisAlignedBoxesApartAndOverlapping) {
  core::Rng rng(1);
  int overlapping = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d a(core::Uniform(rng, .2, 2), core::Uniform(rng, .2, 2),
                     core::Uniform(rng, .2, 2));
    const Vector3d b(core::Uniform(rng, .2, 2), core::Uniform(rng, .2, 2),
                     core::Uniform(rng, .2, 2));
    const Vector3d apart = 4.0 * core::Uniform(rng) * core::UniformDirection(rng);
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.rotate(Eigen::AngleAxisd(core::Uniform(rng, 0.0, 3.0), core::UniformDirection(rng)));
    frame.pretranslate(Vector3d(10, -20, 30));
    const ConvexDistance d =
        SignedDistance(BoxShape(a), frame, BoxShape(b), frame * Eigen::Translation3d(apart));
    ASSERT_NEAR(d.distance, BoxDistance(a, b, apart), 1e-9) << i;
    ASSERT_NEAR(d.normal.norm(), 1.0, 1e-12);
    ASSERT_LT((d.point_b - d.point_a - d.distance * d.normal).norm(), 1e-9);
    overlapping += d.distance < 0.0;
  }
  EXPECT_GT(overlapping, 300);
}

TEST(SignedDistance, BallAgainstBox) {
  const ConvexShape box = BoxShape({1, 1, 1});
  const auto ball = [](double x, double y, double z) {
    return ConvexShape{{Vector3d(x, y, z)}, 0.25};
  };
  EXPECT_NEAR(SignedDistance(box, ball(3, 0, 0)).distance, 1.75, 1e-12);
  EXPECT_NEAR(SignedDistance(box, ball(2, 2, 2)).distance, std::sqrt(3.0) - 0.25, 1e-12);
  EXPECT_NEAR(SignedDistance(box, ball(1.1, 0, 0)).distance, -0.15, 1e-12);
  const ConvexDistance deep = SignedDistance(box, ball(0.2, 0.7, 0.1));
  EXPECT_NEAR(deep.distance, -0.55, 1e-9);  // 0.3 to the face, and the radius
  EXPECT_LT((deep.normal - Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_NEAR(SignedDistance(box, ball(1.0, 0, 0)).distance, -0.25, 1e-9);  // centre on the face
}

TEST(SignedDistance, BallsCapsulesAndPoints) {
  const ConvexShape a{{Vector3d::Zero()}, 1.0}, b{{Vector3d(0, 3, 4)}, 2.0};
  EXPECT_NEAR(SignedDistance(a, b).distance, 2.0, 1e-12);
  EXPECT_NEAR(SignedDistance(a, a).distance, -2.0, 1e-12);  // one within the other
  const ConvexShape x{{Vector3d(-1, 0, 0), Vector3d(1, 0, 0)}, 0.1};
  const ConvexShape y{{Vector3d(0, -1, 0.5), Vector3d(0, 1, 0.5)}, 0.1};
  EXPECT_NEAR(SignedDistance(x, y).distance, 0.3, 1e-12);
  const ConvexShape crossing{{Vector3d(0, -1, 0), Vector3d(0, 1, 0)}, 0.1};
  const ConvexDistance d = SignedDistance(x, crossing);  // axes meet
  EXPECT_NEAR(d.distance, -0.2, 1e-9);
  EXPECT_NEAR(std::abs(d.normal.z()), 1.0, 1e-9);
}

// Moving b by the distance along the normal makes them touch. The distance is the maximum
// separation over all directions, which random directions never exceed.
TEST(SignedDistance, IsTheSupportBoundForRandomHulls) {
  core::Rng rng(9);
  for (int i = 0; i < 300; ++i) {
    ConvexShape shape[2];
    const Vector3d apart = 2.0 * core::Uniform(rng) * core::UniformDirection(rng);
    for (int s = 0; s < 2; ++s) {
      for (int k = 0; k < 40; ++k)
        shape[s].vertices.push_back(core::UniformDirection(rng) + s * apart);
    }
    const auto separation = [&](const Vector3d& n) {
      double a = -1e300, b = 1e300;
      for (const Vector3d& v : shape[0].vertices) a = std::max(a, n.dot(v));
      for (const Vector3d& v : shape[1].vertices) b = std::min(b, n.dot(v));
      return b - a;
    };
    const ConvexDistance d = SignedDistance(shape[0], shape[1]);
    ASSERT_NEAR(separation(d.normal), d.distance, 1e-8);
    for (int k = 0; k < 200; ++k) {
      ASSERT_LE(separation(core::UniformDirection(rng)), d.distance + 1e-8);
    }
    ConvexShape moved = shape[1];
    for (Vector3d& v : moved.vertices) v -= d.distance * d.normal;
    ASSERT_NEAR(SignedDistance(shape[0], moved).distance, 0.0, 1e-7);
    ASSERT_NEAR(SignedDistance(shape[1], shape[0]).distance, d.distance, 1e-8);
  }
}

TEST(SignedDistance, PartsAndErrors) {
  core::TriangleMesh near = shapes::Box(1, 1, 1), far = near;
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(5, 0, 0)), &far);
  int part = -1;
  const ConvexShape ball{{Vector3d(4.5, 0.5, 0.5)}, 0.1};
  EXPECT_NEAR(SignedDistanceToParts({near, far}, ball, &part).distance, 0.4, 1e-12);
  EXPECT_EQ(part, 1);
  EXPECT_THROW(SignedDistanceToParts({}, ball), core::Error);
  EXPECT_THROW(SignedDistance(ConvexShape{}, ball), core::Error);
  EXPECT_THROW(SignedDistance({{Vector3d(std::nan(""), 0, 0)}, 0}, ball), core::Error);
}

TEST(AreApart, AgreesWithTheSignedDistance) {
  core::Rng rng(11);
  int apart = 0;
  for (int i = 0; i < 4000; ++i) {
    ConvexShape shapes[2];
    for (ConvexShape& shape : shapes) {
      const Vector3d at = 1.5 * core::UniformDirection(rng);
      const auto count = 1 + core::UniformIndex(rng, 12);
      for (int k = 0; k < count; ++k) {
        shape.vertices.push_back(at + core::Uniform(rng) * core::UniformDirection(rng));
      }
      if (i % 3 == 0) shape.radius = core::Uniform(rng, 0.0, 0.5);
    }
    const double distance = SignedDistance(shapes[0], shapes[1]).distance;
    for (const double margin : {0.0, 0.1, 0.5}) {
      if (std::abs(distance - margin) < 1e-7) continue;
      EXPECT_EQ(AreApart(shapes[0], shapes[1], margin), distance > margin) << distance;
      apart += distance > margin;
    }
  }
  EXPECT_GT(apart, 1000);
  EXPECT_LT(apart, 11000);
}

}  // namespace
}  // namespace simwright::geometry
