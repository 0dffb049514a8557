#pragma once

#include <string>
#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "core/mesh.h"

namespace simwright {

// An object with a known shape, painted so that its regions can be distinguished.
struct FitShape {
  std::string name;
  core::TriangleMesh mesh;
  std::vector<std::string> starts;  // of fits: "sphere", "wrap", "hull", "carved"
};

// Returns a bumpy sphere, a torus, a mug (hollow, with a handle) and a chair, about 0.2 to 1 m.
std::vector<FitShape> FitShapes();

// Renders `count` images from all sides, 25 deg below to 70 deg above, `size` pixels per side, 64
// samples per pixel, of the mesh with a smooth colour pattern and baked light. Unlit.
std::vector<asset_lift::ObservedView> PatternedViews(const core::TriangleMesh& mesh, int count,
                                                     int size);

// Returns a sphere around the viewed object, with about 1300 faces.
core::TriangleMesh SphereAbout(const std::vector<asset_lift::ObservedView>& views);

// Returns the Chamfer distance (m): the mean of the two mean distances between points of one
// surface and the other.
double Chamfer(const core::TriangleMesh& one, const core::TriangleMesh& other);

}  // namespace simwright
