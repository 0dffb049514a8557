#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/field_fit.h"
#include "asset_lift/field_surface.h"
#include "asset_lift/first_guess.h"
#include "asset_lift/mesh_fit.h"
#include "asset_lift/observed_view.h"
#include "asset_lift/picture_objective.h"
#include "core/finding.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct ShapeFitOptions {
  bool field_stage = true;  // stage 1: a radiance field about the first guess
  bool mesh_stage = true;   // stage 2: the surface of stage 1, or of the first guess, refined
  FieldFitOptions field;    // its cube and bias are taken from the guess
  FieldSurfaceOptions surface;
  MeshFitOptions mesh;
  // How much of the guess stage 1 starts with: log odds times this are added to the density. 2.5
  // makes what is sure as dense as the middle of the published blob.
  double guess_scale = 2.5;

  ShapeFitOptions();
};

// A shape that shows what the views show. Closed, oriented, free of self-intersections where the
// mesh stage ran; world, m.
struct ShapeFit {
  core::TriangleMesh mesh;
  std::vector<Eigen::Vector3f> colors;  // (N x 3) sRGB, a colour a vertex; empty: none were fitted
  core::Findings findings;
};

// The two stages of the lift. `field_objective` and `mesh_objective` (each may be null) are what
// score distillation asks of either stage. Throws what FitField and FitMesh throw.
ShapeFit FitShape(const std::vector<ObservedView>& views, const FirstGuess& guess,
                  PictureObjective* field_objective, PictureObjective* mesh_objective,
                  const ShapeFitOptions& options, core::Progress* progress);

}  // namespace simwright::asset_lift
