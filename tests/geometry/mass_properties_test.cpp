#include "geometry/mass_properties.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::geometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using shapes::kPi;

void ExpectNear(const Matrix3d& a, const Matrix3d& b, double relative) {
  EXPECT_LT((a - b).norm(), relative * b.norm()) << a << "\n\n" << b;
}

Matrix3d Diagonal(double x, double y, double z) {
  return Vector3d(x, y, z).asDiagonal();
}

TEST(SolidMassProperties, BoxIsExact) {
  const MassProperties p = SolidMassProperties(shapes::Box(1.0, 2.0, 3.0), 500.0);
  EXPECT_NEAR(p.volume, 6.0, 1e-12);
  EXPECT_NEAR(p.mass, 3000.0, 1e-9);
  EXPECT_LT((p.center_of_mass - Vector3d(0.5, 1.0, 1.5)).norm(), 1e-12);
  ExpectNear(p.inertia, 250.0 * Diagonal(4 + 9, 1 + 9, 1 + 4), 1e-12);
}

// An extruded regular n-gon: area n/2 r^2 sin(2 pi/n), polar second moment of area n/12 r^4 sin(2
// pi/n) (2 + cos(2 pi/n)).
TEST(SolidMassProperties, PrismOfTheTessellatedCylinderIsExact) {
  const int n = 24;
  const double r = 0.3, h = 0.8, a = 2.0 * kPi / n;
  const double area = 0.5 * n * r * r * std::sin(a);
  const double polar = n / 12.0 * std::pow(r, 4) * std::sin(a) * (2.0 + std::cos(a));
  const MassProperties p = SolidMassProperties(shapes::Cylinder(r, h, n), 1.0);
  EXPECT_NEAR(p.volume / (area * h), 1.0, 1e-12);
  const double across = 0.5 * polar * h + area * h * h * h / 12.0;
  ExpectNear(p.inertia, Diagonal(across, across, polar * h), 1e-12);
}

struct Truth {
  double volume;
  Vector3d inertia;  // density 1
};

// Halving the facets divides the error by four: second-order convergence to the closed form.
void ExpectConverges(const std::function<core::TriangleMesh(int)>& mesh, const Truth& truth) {
  double last = 0.0;
  for (const int n : {32, 64, 128}) {
    const MassProperties p = SolidMassProperties(mesh(n), 1.0);
    const double volume_error = std::abs(p.volume / truth.volume - 1.0);
    const Matrix3d inertia = truth.inertia.asDiagonal();
    const double error = volume_error + (p.inertia - inertia).norm() / inertia.norm();
    EXPECT_LT(error, 50.0 / (n * n));
    if (last > 0.0) {
      EXPECT_NEAR(last / error, 4.0, 0.2);
    }
    last = error;
  }
}

TEST(SolidMassProperties, ConvergeToClosedForms) {
  const double r = 0.7, v = 4.0 / 3.0 * kPi * r * r * r;
  ExpectConverges([&](int n) { return shapes::Sphere(r, n); },
                  {v, Vector3d::Constant(0.4 * v * r * r)});
  const double h = 1.1, vc = kPi * r * r * h, across = vc * (3 * r * r + h * h) / 12.0;
  ExpectConverges([&](int n) { return shapes::Cylinder(r, h, n); },
                  {vc, {across, across, 0.5 * vc * r * r}});
  const double R = 1.0, t = 0.25, vt = 2.0 * kPi * kPi * R * t * t;
  const double flat = vt * (4 * R * R + 5 * t * t) / 8.0;
  ExpectConverges([&](int n) { return shapes::Torus(R, t, n, n); },
                  {vt, {flat, flat, vt * (4 * R * R + 3 * t * t) / 4.0}});
}

TEST(SolidMassProperties, SphereByItsOwnTetrahedra) {
  // Independent of the origin: summed about a far vertex in long double.
  const core::TriangleMesh mesh = shapes::Sphere(0.5, 40);
  long double volume = 0.0L;
  Eigen::Matrix<long double, 3, 3> second = Eigen::Matrix<long double, 3, 3>::Zero();
  for (const auto& t : mesh.triangles) {
    Eigen::Matrix<long double, 3, 3> c;
    for (int k = 0; k < 3; ++k) c.col(k) = mesh.vertices[t[k]].cast<long double>();
    const long double det = c.determinant();
    volume += det / 6.0L;
    Eigen::Matrix<long double, 3, 3> pattern = Eigen::Matrix<long double, 3, 3>::Constant(1.0L);
    pattern.diagonal().setConstant(2.0L);
    second += det / 120.0L * c * pattern * c.transpose();
  }
  const Matrix3d s = second.cast<double>();
  const MassProperties p = SolidMassProperties(mesh, 3.0);
  EXPECT_NEAR(p.volume / static_cast<double>(volume), 1.0, 1e-12);
  ExpectNear(p.inertia, 3.0 * (s.trace() * Matrix3d::Identity() - s), 1e-10);
}

TEST(SolidMassProperties, UnionOffCentreIsTheSumOfItsBoxes) {
  const auto a = shapes::BoxAt(0, 0, 0, 2, 1, 1), b = shapes::BoxAt(2, 0, 0, 3, 1, 4);
  const MassProperties whole = SolidMassProperties(shapes::BoxUnion({a, b}), 7.0);
  const MassProperties sum = Combined(SolidMassProperties(shapes::BoxUnion({a}), 7.0),
                                      SolidMassProperties(shapes::BoxUnion({b}), 7.0));
  EXPECT_NEAR(whole.mass, 7.0 * 6.0, 1e-10);
  EXPECT_LT(
      (whole.center_of_mass - Vector3d((2 * 1 + 4 * 2.5) / 6, 0.5, (2 * 0.5 + 4 * 2) / 6)).norm(),
      1e-12);
  ExpectNear(sum.inertia, whole.inertia, 1e-12);
  EXPECT_LT((sum.center_of_mass - whole.center_of_mass).norm(), 1e-12);
}

TEST(SolidMassProperties, TurnsAndMovesWithTheBodyAlsoFarAway) {
  const core::TriangleMesh mesh =
      shapes::BoxUnion({shapes::BoxAt(0, 0, 0, .2, .1, .1), shapes::BoxAt(.2, 0, 0, .3, .1, .4)});
  const MassProperties still = SolidMassProperties(mesh, 900.0);
  core::Rng rng(5);
  for (const double far : {0.0, 1.0, 1e4}) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.rotate(Eigen::AngleAxisd(core::Uniform(rng, 0.0, 3.0), core::UniformDirection(rng)));
    motion.pretranslate(far * core::UniformDirection(rng));
    core::TriangleMesh moved = mesh;
    core::Transform(Eigen::Affine3d(motion.matrix()), &moved);
    const MassProperties p = SolidMassProperties(moved, 900.0);
    const MassProperties expected = Transformed(motion, still);
    EXPECT_NEAR(p.mass / expected.mass, 1.0, 1e-10);
    EXPECT_LT((p.center_of_mass - expected.center_of_mass).norm(), 1e-10 + 1e-14 * far);
    ExpectNear(p.inertia, expected.inertia, 1e-9);
  }
}

TEST(ShellMassProperties, BoxAndSphereOfSheet) {
  const MassProperties box = ShellMassProperties(shapes::Box(1, 1, 1), 0.01, 100.0);
  EXPECT_NEAR(box.mass, 6.0, 1e-12);
  // A hollow cube: 5/18 m a^2.
  ExpectNear(box.inertia, Matrix3d::Identity() * (6.0 * 5.0 / 18.0), 1e-12);
  const MassProperties sphere = ShellMassProperties(shapes::Sphere(0.5, 400), 0.002, 1000.0);
  EXPECT_NEAR(sphere.mass / (4 * kPi * 0.25 * 2.0), 1.0, 1e-4);
  ExpectNear(sphere.inertia, Matrix3d::Identity() * (2.0 / 3.0 * sphere.mass * 0.25), 2e-4);
}

// Independent reference: the body minus its cavity, both solid.
MassProperties WithoutCavity(const core::TriangleMesh& body, const core::TriangleMesh& cavity,
                             double density) {
  const MassProperties outer = SolidMassProperties(body, density);
  const MassProperties inner = SolidMassProperties(cavity, density);
  MassProperties hollow;
  hollow.volume = outer.volume - inner.volume;
  hollow.mass = outer.mass - inner.mass;
  hollow.inertia = outer.inertia - inner.inertia;
  return hollow;
}

TEST(HollowMassProperties, CubesAndSpheresMinusTheirCavities) {
  for (const double wall : {1e-7, 0.001, 0.05, 0.2, 0.49}) {
    const MassProperties box = HollowMassProperties(shapes::Box(1, 1, 1), wall, 700.0);
    const double inside = 1.0 - 2.0 * wall;
    const MassProperties expected =
        WithoutCavity(shapes::Box(1, 1, 1), shapes::Box(inside, inside, inside), 700.0);
    EXPECT_NEAR(box.mass / expected.mass, 1.0, 1e-8);
    EXPECT_NEAR(box.volume, expected.volume, 1e-12);
    ExpectNear(box.inertia, expected.inertia, 1e-8);
    const MassProperties ball = HollowMassProperties(shapes::Sphere(0.6, 100), wall, 700.0);
    const MassProperties hollow_ball =
        WithoutCavity(shapes::Sphere(0.6, 100), shapes::Sphere(0.6 - wall, 100), 700.0);
    EXPECT_NEAR(ball.mass / hollow_ball.mass, 1.0, 1e-3);
    ExpectNear(ball.inertia, hollow_ball.inertia, 1e-3);
  }
}

TEST(HollowMassProperties, TendsToTheSheetAndToTheSolid) {
  const core::TriangleMesh body =
      shapes::BoxUnion({shapes::BoxAt(0, 0, 0, 2, 1, 1), shapes::BoxAt(2, 0, 0, 3, 1, 4)});
  const MassProperties solid = SolidMassProperties(body, 500.0);
  const MassProperties sheet = ShellMassProperties(body, 1e-9, 500.0);
  const MassProperties thin = HollowMassProperties(body, 1e-9, 500.0);
  EXPECT_NEAR(thin.mass / sheet.mass, 1.0, 1e-8);
  EXPECT_LT((thin.center_of_mass - sheet.center_of_mass).norm(), 1e-8);
  ExpectNear(thin.inertia, sheet.inertia, 1e-8);
  const double full = 3.0 * solid.volume / core::SurfaceArea(body);
  const MassProperties thick = HollowMassProperties(body, full * (1.0 - 1e-9), 500.0);
  EXPECT_NEAR(thick.mass / solid.mass, 1.0, 1e-12);
  ExpectNear(thick.inertia, solid.inertia, 1e-12);
  EXPECT_THROW(HollowMassProperties(body, full, 500.0), core::Error);
}

TEST(WallThickness, HoldsTheShareOfMatter) {
  // A cube of side 1 is filled by 1 - (1 - 2 wall)^3.
  for (const double wall : {1e-9, 0.01, 0.3, 0.499}) {
    const double fill = 2.0 * wall * (3.0 - 6.0 * wall + 4.0 * wall * wall);
    EXPECT_NEAR(WallThickness(fill, 1.0, 6.0) / wall, 1.0, 1e-9);
  }
  EXPECT_THROW(WallThickness(1.0, 1.0, 6.0), core::Error);
  EXPECT_THROW(WallThickness(0.0, 1.0, 6.0), core::Error);
  EXPECT_THROW(WallThickness(0.5, 0.0, 6.0), core::Error);
}

TEST(PrincipalInertia, RebuildsTheMatrixAndIsARotation) {
  const MassProperties p = SolidMassProperties(
      shapes::BoxUnion({shapes::BoxAt(0, 0, 0, 2, 1, 1), shapes::BoxAt(2, 0, 0, 3, 1, 4)}), 1.0);
  const PrincipalInertia principal = PrincipalInertiaOf(p.inertia);
  const Matrix3d turn = principal.axes.toRotationMatrix();
  ExpectNear(turn * principal.moments.asDiagonal() * turn.transpose(), p.inertia, 1e-12);
  EXPECT_LE(principal.moments[0], principal.moments[1]);
  EXPECT_LE(principal.moments[1], principal.moments[2]);
  EXPECT_NEAR(turn.determinant(), 1.0, 1e-12);
  EXPECT_TRUE(SatisfiesTriangleInequality(principal.moments));
}

TEST(PrincipalInertia, TriangleInequality) {
  EXPECT_TRUE(SatisfiesTriangleInequality({1.0, 1.0, 2.0}));  // a flat plate
  EXPECT_FALSE(SatisfiesTriangleInequality({1.0, 1.0, 2.001}));
  EXPECT_FALSE(SatisfiesTriangleInequality({0.0, 1.0, 1.0}));
  EXPECT_FALSE(SatisfiesTriangleInequality({std::nan(""), 1.0, 1.0}));
}

TEST(MassProperties, RefusesWhatHasNoMass) {
  core::TriangleMesh box = shapes::Box(1, 1, 1);
  EXPECT_THROW(SolidMassProperties({}, 1.0), core::Error);
  EXPECT_THROW(SolidMassProperties(box, 0.0), core::Error);
  EXPECT_THROW(SolidMassProperties(box, std::nan("")), core::Error);
  EXPECT_THROW(ShellMassProperties(box, -1.0, 1.0), core::Error);
  for (auto& t : box.triangles) std::swap(t[0], t[1]);
  EXPECT_THROW(SolidMassProperties(box, 1.0), core::Error);  // inside out
  core::TriangleMesh flat = shapes::Box(1, 1, 1);
  for (auto& v : flat.vertices) v.z() = 0.0;
  EXPECT_THROW(SolidMassProperties(flat, 1.0), core::Error);
  Matrix3d skew = Matrix3d::Identity();
  skew(0, 1) = 0.5;
  EXPECT_THROW(PrincipalInertiaOf(skew), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
