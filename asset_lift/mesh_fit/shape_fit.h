#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/mesh_fit/mesh_fit.h"
#include "asset_lift/priors/image_objective.h"
#include "asset_lift/priors/initial_shape.h"
#include "asset_lift/radiance_field/field_fit.h"
#include "asset_lift/radiance_field/field_surface.h"
#include "core/finding.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct ShapeFitOptions {
  bool field_stage = true;  // stage 1: a radiance field started from the initial shape
  bool mesh_stage = true;   // stage 2: refines the surface of stage 1, or of the initial shape
  FieldFitOptions field;    // its cube and bias come from the initial shape
  FieldSurfaceOptions surface;
  MeshFitOptions mesh;
  // The weight of the initial shape in stage 1: log odds times this are added to the density. 2.5
  // makes certain cells as dense as the centre of the published blob.
  double initial_shape_weight = 2.5;

  ShapeFitOptions();
};

// A shape fitted to the views. Closed, oriented and free of self-intersections where the mesh stage
// ran; world, m.
struct ShapeFit {
  core::TriangleMesh mesh;
  std::vector<Eigen::Vector3f> colors;  // (N x 3) sRGB, one per vertex; empty: not fitted
  core::Findings findings;
};

// Runs the two stages of the reconstruction. `field_objective` and `mesh_objective` (each may be
// null) are the score-distillation losses of the two stages. Throws the exceptions of FitField and
// FitMesh.
ShapeFit FitShape(const std::vector<ObservedView>& views, const InitialShape& guess,
                  ImageObjective* field_objective, ImageObjective* mesh_objective,
                  const ShapeFitOptions& options, core::Progress* progress);

}  // namespace simwright::asset_lift
