// Checks alignment and scores against analytic results.
#include <cmath>
#include <cstdio>

#include "lift_quality_measures.h"

namespace simwright::bench {
namespace {

constexpr double kDegree = M_PI / 180.0;

// Returns a solid of revolution with `radius(t)` at height z(t) = -cos(pi t) over t in [0, 1], with
// `sides` sectors.
template <typename Radius>
core::TriangleMesh TurnedBody(int sides, int rings, const Radius& radius) {
  core::TriangleMesh mesh;
  for (int i = 0; i <= rings; ++i) {
    const double t = static_cast<double>(i) / rings;
    for (int j = 0; j < sides; ++j) {
      const double a = 2.0 * M_PI * j / sides;
      mesh.vertices.emplace_back(radius(t) * std::cos(a), radius(t) * std::sin(a),
                                 -std::cos(M_PI * t));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sides; ++j) {
      const int a = i * sides + j, b = i * sides + (j + 1) % sides;
      mesh.triangles.push_back({a, b, b + sides});
      mesh.triangles.push_back({a, b + sides, a + sides});
    }
  }
  return mesh;
}

core::TriangleMesh Ball() {
  return TurnedBody(96, 64, [](double t) { return std::sin(M_PI * t); });
}

// Returns a post as wide as deep; the corners of its four sides are at 45 degrees.
core::TriangleMesh SquarePost() {
  return TurnedBody(4, 16, [](double t) { return t > 0.0 && t < 1.0 ? 0.8 : 0.0; });
}

bool Holds(const char* what, double value, double low, double high) {
  const bool holds = value >= low && value <= high;
  std::printf("%-58s %9.5f  in [%g, %g]  %s\n", what, value, low, high, holds ? "ok" : "FAILS");
  return holds;
}

// Checks that a real mesh, rotated by 47 degrees, tilted, scaled and moved, is aligned with itself.
bool FindsItself(const core::TriangleMesh& sample) {
  core::TriangleMesh other = sample;
  core::Transform(Eigen::Translation3d(3.0, -2.0, 0.5) * Eigen::Scaling(1.7) *
                      Eigen::Affine3d(Eigen::AngleAxisd(8.0 * kDegree, Eigen::Vector3d::UnitX())) *
                      Eigen::AngleAxisd(47.0 * kDegree, Eigen::Vector3d::UnitZ()),
                  &other);
  const ComparableShape truth(sample, 1), turned(other, 2);
  const ShapeScores scores = CompareShapes(truth, turned, Align(truth, turned));
  bool holds = Holds("itself rotated, tilted, scaled: Chamfer", scores.chamfer, 0.0, 0.003);
  holds &= Holds("itself rotated, tilted, scaled: F@0.1", scores.f_score, 0.999, 1.0);
  return holds & Holds("itself rotated, tilted, scaled: volume IoU", scores.volume_iou, 0.85, 1.0);
}

// Checks concentric balls: the distance is the difference of radii, volumes scale with the cube.
bool BallsAgree() {
  const ComparableShape ball(Ball(), 1), other(Ball(), 2);
  const ShapeScores near = CompareShapes(ball, other, Eigen::Affine3d(Eigen::Scaling(1.05)));
  const ShapeScores far = CompareShapes(ball, other, Eigen::Affine3d(Eigen::Scaling(1.2)));
  bool holds = Holds("balls of radius 1 and 1.05: Chamfer 0.05", near.chamfer, 0.048, 0.052);
  holds &= Holds("balls of radius 1 and 1.05: F@0.1 1", near.f_score, 0.999, 1.0);
  holds &= Holds("balls of radius 1 and 1.05: IoU 1/1.05^3 = 0.864", near.volume_iou, 0.845, 0.883);
  holds &= Holds("balls of radius 1 and 1.2: normals 1", far.normal_consistency, 0.998, 1.0);
  // From a point of the ball, the post's nearest face is at 45 degrees at most.
  const ComparableShape post(SquarePost(), 1);
  holds &=
      Holds("ball and square post: normals between cos(45 degrees) and 1",
            CompareShapes(ball, post, Eigen::Affine3d::Identity()).normal_consistency, 0.707, 0.99);
  holds &= Holds("balls: equally rough", near.roughness, 0.8, 1.2);
  holds &= Holds("balls of radius 1 and 1.2: Chamfer 0.2", far.chamfer, 0.197, 0.203);
  return holds & Holds("balls of radius 1 and 1.2: F@0.1 0", far.f_score, 0.0, 0.001);
}

}  // namespace

bool MeasuresHold(const core::TriangleMesh& sample) {
  bool holds = FindsItself(sample);
  holds &= BallsAgree();
  holds &= Holds("turning defect of a ball", TurningDefect(ComparableShape(Ball(), 1)), 0.0, 0.003);
  holds &= Holds("turning defect of a square post", TurningDefect(ComparableShape(SquarePost(), 1)),
                 0.05, 0.3);
  const core::Image dark(8, 8, 3, 100), bright(8, 8, 3, 151);
  return holds & Holds("images 51 levels apart: 20 log10(5) = 13.979 dB",
                       PeakSignalToNoise(dark, bright), 13.97, 13.99);
}

}  // namespace simwright::bench
