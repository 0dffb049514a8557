#include "geometry/mass_properties.h"

#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>

#include "core/error.h"

namespace simwright::geometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The integrals of 1, x and x x^T over a body, about some origin.
struct Moments {
  double zeroth = 0.0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
};

// Sums over the signed tetrahedra that the triangles span with `origin` (Tonon 2004).
Moments VolumeMoments(const core::TriangleMesh& mesh, const Vector3d& origin) {
  Moments m;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]] - origin;
    const Vector3d b = mesh.vertices[t[1]] - origin;
    const Vector3d c = mesh.vertices[t[2]] - origin;
    const double det = a.dot(b.cross(c));
    const Vector3d s = a + b + c;
    m.zeroth += det / 6.0;
    m.first += det / 24.0 * s;
    m.second += det / 120.0 *
                (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  return m;
}

Moments AreaMoments(const core::TriangleMesh& mesh, const Vector3d& origin) {
  Moments m;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]] - origin;
    const Vector3d b = mesh.vertices[t[1]] - origin;
    const Vector3d c = mesh.vertices[t[2]] - origin;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const Vector3d s = a + b + c;
    m.zeroth += area;
    m.first += area / 3.0 * s;
    m.second += area / 12.0 *
                (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  return m;
}

// Returns tr(S) 1 - S, the inertia for the second moment S of the mass.
Matrix3d InertiaOf(const Matrix3d& second) {
  return second.trace() * Matrix3d::Identity() - second;
}

void RequirePositive(double value, const char* name) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw core::Error(std::string("the ") + name + " is not positive and finite",
                      "mass properties");
  }
}

// Computes mass properties from moments. `thickness` turns the integrals' measure (area or volume,
// given by `dimension`) into a volume.
template <typename MomentsAbout>
MassProperties FromMoments(const core::TriangleMesh& mesh, int dimension, double thickness,
                           double density, MomentsAbout moments_about) {
  core::RequireValid(mesh, "mass properties");
  RequirePositive(density, "density");
  RequirePositive(thickness, "wall thickness");
  if (mesh.empty()) throw core::Error("the mesh has no triangles", "mass properties");
  const Eigen::AlignedBox3d bounds = core::Bounds(mesh);
  const Moments rough = moments_about(mesh, bounds.center());
  // Below this threshold the sum is only rounding error.
  if (!(rough.zeroth > 1e-14 * std::pow(bounds.diagonal().norm(), dimension)) ||
      !std::isfinite(rough.zeroth)) {
    throw core::Error(
        dimension == 3 ? "the mesh encloses no positive volume" : "the mesh has no area",
        "mass properties", "close it and turn its faces outward");
  }
  MassProperties properties;
  properties.center_of_mass = bounds.center() + rough.first / rough.zeroth;
  // A second pass about the centre of mass avoids differences of large numbers.
  const Moments m = moments_about(mesh, properties.center_of_mass);
  properties.volume = m.zeroth * thickness;
  properties.mass = properties.volume * density;
  const Vector3d left = m.first / m.zeroth;
  properties.inertia =
      InertiaOf((m.second - m.zeroth * left * left.transpose()) * (thickness * density));
  return properties;
}

}  // namespace

MassProperties SolidMassProperties(const core::TriangleMesh& mesh, double density) {
  return FromMoments(mesh, 3, 1.0, density, VolumeMoments);
}

MassProperties ShellMassProperties(const core::TriangleMesh& mesh, double wall_thickness,
                                   double density) {
  return FromMoments(mesh, 2, wall_thickness, density, AreaMoments);
}

MassProperties HollowMassProperties(const core::TriangleMesh& mesh, double wall_thickness,
                                    double density) {
  const MassProperties solid = SolidMassProperties(mesh, density);
  const MassProperties sheet = ShellMassProperties(mesh, wall_thickness, density);
  const double wall_share = sheet.volume / (3.0 * solid.volume);
  if (wall_share >= 1.0) {
    throw core::Error("the wall is thicker than the body", "mass properties",
                      "treat the body as solid");
  }
  // 1 - s^3 and 1 - s^5 as polynomials in u = 1 - s, without cancellation.
  const double u = wall_share;
  const double cubic = 3.0 + u * (-3.0 + u);
  const double quintic = 5.0 + u * (-10.0 + u * (10.0 + u * (-5.0 + u)));
  const double sheet_weight = 1.5 * (quintic / cubic - 1.0);
  MassProperties hollow;
  hollow.volume = solid.volume * u * cubic;
  hollow.mass = hollow.volume * density;
  hollow.center_of_mass =
      sheet_weight * sheet.center_of_mass + (1.0 - sheet_weight) * solid.center_of_mass;
  hollow.inertia = hollow.mass * (sheet_weight / sheet.mass * sheet.inertia +
                                  (1.0 - sheet_weight) / solid.mass * solid.inertia);
  return hollow;
}

double WallThickness(double fill, double volume, double area) {
  RequirePositive(volume, "volume");
  RequirePositive(area, "area");
  if (!(fill > 0.0 && fill < 1.0)) {
    throw core::Error("the filled share must lie between 0 and 1", "wall thickness");
  }
  // 1 - cbrt(1 - fill) without cancellation.
  return -3.0 * volume / area * std::expm1(std::log1p(-fill) / 3.0);
}

MassProperties Combined(const MassProperties& a, const MassProperties& b) {
  MassProperties sum;
  sum.volume = a.volume + b.volume;
  sum.mass = a.mass + b.mass;
  RequirePositive(sum.mass, "total mass");
  const Vector3d offset = b.center_of_mass - a.center_of_mass;
  sum.center_of_mass = a.center_of_mass + b.mass / sum.mass * offset;
  const double reduced = a.mass * b.mass / sum.mass;
  sum.inertia = a.inertia + b.inertia + reduced * InertiaOf(offset * offset.transpose());
  return sum;
}

MassProperties Transformed(const Eigen::Isometry3d& target_from_source,
                           const MassProperties& properties) {
  MassProperties moved = properties;
  const Matrix3d turn = target_from_source.linear();
  moved.center_of_mass = target_from_source * properties.center_of_mass;
  moved.inertia = turn * properties.inertia * turn.transpose();
  return moved;
}

PrincipalInertia PrincipalInertiaOf(const Matrix3d& inertia) {
  const double norm = inertia.norm();
  if (!inertia.allFinite() || (inertia - inertia.transpose()).norm() > 1e-6 * norm) {
    throw core::Error("the inertia is not a finite symmetric matrix", "principal inertia");
  }
  PrincipalInertia principal;
  if (norm == 0.0) return principal;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(0.5 / norm *
                                                       (inertia + inertia.transpose()));
  principal.moments = solver.eigenvalues() * norm;
  Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  principal.axes = Eigen::Quaterniond(axes).normalized();
  return principal;
}

bool SatisfiesTriangleInequality(const Vector3d& moments, double tolerance) {
  if (!moments.allFinite() || !(moments.minCoeff() > 0.0)) return false;
  const double largest = moments.maxCoeff();
  return 2.0 * largest <= moments.sum() + tolerance * largest;
}

}  // namespace simwright::geometry
