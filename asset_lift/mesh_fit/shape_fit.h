#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/mesh_fit/shape_fit_options.h"
#include "asset_lift/priors/image_objective.h"
#include "asset_lift/priors/initial_shape.h"
#include "core/finding.h"
#include "core/progress.h"

namespace simwright::asset_lift {

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
