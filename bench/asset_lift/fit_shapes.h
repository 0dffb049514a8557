#pragma once

#include <string>
#include <vector>

#include "asset_lift/observed_view.h"
#include "core/mesh.h"

namespace simwright {

// A thing whose shape is known, and painted so that places can be told apart.
struct FitShape {
  std::string name;
  core::TriangleMesh mesh;
  std::vector<std::string> starts;  // of fits: "sphere", "wrap", "hull", "carved"
};

// Bumpy sphere, torus, mug (hollow, with a handle) and chair, about 0.2 to 1 m.
std::vector<FitShape> FitShapes();

// `count` pictures from all round, 25 deg below to 70 deg above, `size` pixels a side, 64
// samples a pixel, of the mesh with a smooth pattern of colours and baked light. Not lit.
std::vector<asset_lift::ObservedView> PatternedViews(const core::TriangleMesh& mesh, int count,
                                                     int size);

// A sphere about what the views show, of about 1300 faces.
core::TriangleMesh SphereAbout(const std::vector<asset_lift::ObservedView>& views);

// Mean of the two mean distances between points of one surface and the other, m.
double Chamfer(const core::TriangleMesh& one, const core::TriangleMesh& other);

}  // namespace simwright
