#include "geometry/surface_fairness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/error.h"

namespace simwright::geometry {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// A cube of side 1 with a grid of `n` x `n` cells a face, its points moved.
core::TriangleMesh CubeOfCells(int n, const std::function<Eigen::Vector3d(Eigen::Vector3d)>& move) {
  core::TriangleMesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double side = face % 2 == 0 ? -0.5 : 0.5;
    const int first = static_cast<int>(mesh.vertices.size());
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        Eigen::Vector3d p;
        p[axis] = side;
        p[(axis + 1) % 3] = static_cast<double>(i) / n - 0.5;
        p[(axis + 2) % 3] = static_cast<double>(j) / n - 0.5;
        mesh.vertices.push_back(move(p));
      }
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const int a = first + i * (n + 1) + j, b = a + n + 1;
        if (side > 0) {
          mesh.triangles.push_back({a, b, a + 1});
          mesh.triangles.push_back({b, b + 1, a + 1});
        } else {
          mesh.triangles.push_back({a, a + 1, b});
          mesh.triangles.push_back({b, a + 1, b + 1});
        }
      }
    }
  }
  return mesh;
}

Eigen::Vector3d Unmoved(const Eigen::Vector3d& p) {
  return p;
}

Eigen::Vector3d OnSphere(const Eigen::Vector3d& p) {
  return 0.5 * p.normalized();
}

TEST(SurfaceFairness, PlanesAndSpheresAreSmooth) {
  const SurfaceFairness cube = MeasureFairness(CubeOfCells(4, Unmoved));
  EXPECT_LT(cube.typical_deviation, 1e-9);
  // A band of 2 radii at 12 edges of length 1 and diagonal sqrt(3) deviates, by at most 45 degrees.
  const double band = 12 * 2 * 0.03 * std::sqrt(3.0) / 6.0;
  EXPECT_GT(cube.mean_deviation, 0.25 * band * 45 * kDegree);
  EXPECT_LT(cube.mean_deviation, band * 45 * kDegree);
  // Normals of a sphere, sampled unevenly within 0.03 diagonals = 0.052 / 0.5 rad.
  EXPECT_LT(MeasureFairness(CubeOfCells(40, OnSphere)).typical_deviation, 1.5 * kDegree);
}

TEST(SurfaceFairness, GrowsWithLumps) {
  double last = 0.0;
  for (const double height : {0.0, 0.005, 0.01, 0.02}) {
    const auto lumpy = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
      const Eigen::Vector3d q = OnSphere(p);
      return q * (1.0 + 2.0 * height * std::sin(60 * q.x()) * std::sin(60 * q.y()) *
                            std::sin(60 * q.z()));
    };
    const double deviation = MeasureFairness(CubeOfCells(60, lumpy)).typical_deviation;
    EXPECT_GT(deviation, last + (height > 0.0 ? 1.0 * kDegree : 0.0)) << height;
    last = deviation;
  }
}

TEST(SurfaceFairness, IsIndependentOfSizeAndTessellation) {
  const auto wavy = [](double scale) {
    return [scale](const Eigen::Vector3d& p) -> Eigen::Vector3d {
      const Eigen::Vector3d q = OnSphere(p);
      return scale * q * (1.0 + 0.02 * std::sin(50 * q.x()));
    };
  };
  const double coarse = MeasureFairness(CubeOfCells(60, wavy(1.0))).typical_deviation;
  EXPECT_NEAR(MeasureFairness(CubeOfCells(60, wavy(0.01))).typical_deviation / coarse, 1.0, 1e-6);
  EXPECT_NEAR(MeasureFairness(CubeOfCells(120, wavy(1.0))).typical_deviation / coarse, 1.0, 0.05);
}

TEST(FlatFaces, OfACubeAreSix) {
  const std::vector<FlatFace> faces = FindFlatFaces(CubeOfCells(4, Unmoved));
  ASSERT_EQ(faces.size(), 6u);
  for (const FlatFace& face : faces) {
    EXPECT_NEAR(face.share, 1.0 / 6.0, 0.02);
    EXPECT_LT(face.deviation, 1e-9);
    EXPECT_NEAR(face.normal.cwiseAbs().maxCoeff(), 1.0, 1e-9);
  }
}

TEST(FlatFaces, MeasureABulge) {
  // z += h (1 - 4x^2)(1 - 4y^2) on top: over its inner square the deviation is known by quadrature.
  const double height = 0.05;
  const auto bulge = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    if (p.z() < 0.499) return p;
    return {p.x(), p.y(), p.z() + height * (1 - 4 * p.x() * p.x()) * (1 - 4 * p.y() * p.y())};
  };
  const std::vector<FlatFace> faces = FindFlatFaces(CubeOfCells(40, bulge));
  ASSERT_EQ(faces.size(), 6u);
  int bulged = 0;
  for (const FlatFace& face : faces) {
    if (face.deviation < 1e-6) continue;
    ++bulged;
    EXPECT_GT(face.normal.z(), 0.999);
    // The deviation of the whole face: h sqrt(E[q^2] - E[q]^2), q the product, = 0.29 h; without
    // its border and the farthest fifth about half.
    EXPECT_GT(face.deviation, 0.10 * height);
    EXPECT_LT(face.deviation, 0.29 * height);
  }
  EXPECT_EQ(bulged, 1);
}

TEST(MirrorSymmetry, FindsThePlaneOfATurnedWedge) {
  // Wider at the front: symmetric about one vertical plane alone.
  const double turn = 33 * kDegree;
  const auto wedge = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const Eigen::Vector3d q(2.0 * p.x(), p.y() * (1.0 + 0.8 * p.x()), p.z());
    return Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * q;
  };
  const MirrorSymmetry found = FindMirrorSymmetry(CubeOfCells(10, wedge));
  EXPECT_NEAR(found.azimuth, turn + 90 * kDegree, 0.5 * kDegree);
  EXPECT_LT(found.difference, 0.01);
  // With one side cut slanted there is none.
  const auto slanted = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const Eigen::Vector3d q = wedge(p);
    return p.y() > 0.0 ? Eigen::Vector3d(q.x(), q.y(), q.z() * (0.6 + 0.5 * p.x())) : q;
  };
  EXPECT_GT(FindMirrorSymmetry(CubeOfCells(10, slanted)).difference, 0.02);
}

TEST(SurfaceFairness, RefusesInvalidInput) {
  SurfaceFairnessOptions options;
  options.radius = 0.0;
  EXPECT_THROW(MeasureFairness(CubeOfCells(2, Unmoved), options), core::Error);
  EXPECT_THROW(MeasureFairness(core::TriangleMesh{}), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
