// Decomposes a table top on one leg (a T of two boxes) into convex parts and weighs it.
#include <cstdio>

#include <simwright/core/mesh.h>
#include <simwright/geometry/convex_decomposition.h>
#include <simwright/geometry/mass_properties.h>

// Returns the T's outline, extruded by 1 m along y: 3 m wide, 1 m thick, on a leg of 1 x 2 m.
simwright::core::TriangleMesh MakeT() {
  const double outline[8][2] = {{-0.5, 0}, {0.5, 0},  {0.5, 2},  {1.5, 2},
                                {1.5, 3},  {-1.5, 3}, {-1.5, 2}, {-0.5, 2}};
  simwright::core::TriangleMesh mesh;
  for (const double y : {0.0, 1.0}) {
    for (const auto& point : outline) mesh.vertices.emplace_back(point[0], y, point[1]);
  }
  for (int i = 0; i < 8; ++i) {
    const int j = (i + 1) % 8;
    mesh.triangles.emplace_back(i, j, j + 8);
    mesh.triangles.emplace_back(i, j + 8, i + 8);
  }
  for (const auto& t :
       {Eigen::Vector3i(0, 2, 1), Eigen::Vector3i(0, 7, 2), Eigen::Vector3i(2, 4, 3),
        Eigen::Vector3i(2, 7, 4), Eigen::Vector3i(7, 5, 4), Eigen::Vector3i(7, 6, 5)}) {
    mesh.triangles.push_back(t);                                // front
    mesh.triangles.emplace_back(t[0] + 8, t[2] + 8, t[1] + 8);  // back
  }
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

int main() {
  const simwright::core::TriangleMesh solid = MakeT();
  const auto mass = simwright::geometry::SolidMassProperties(solid, 500.0);
  const auto parts = simwright::geometry::Decompose(solid);
  std::printf("%.6g m^3, %.6g kg, centre of mass at z = %.6g m; %zu convex parts\n", mass.volume,
              mass.mass, mass.center_of_mass.z(), parts.parts.size());
  // A bar of 3 m^3 at 2.5 m on a leg of 2 m^3 at 1 m.
  return mass.volume > 4.999 && mass.volume < 5.001 && parts.parts.size() == 2 ? 0 : 1;
}
