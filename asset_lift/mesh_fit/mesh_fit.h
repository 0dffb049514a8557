#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/mesh_fit/shape_fit_options.h"
#include "asset_lift/priors/image_objective.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct MeshFitResult {
  core::TriangleMesh mesh;  // closed, oriented outward, free of self-intersections; m
  std::vector<Eigen::Vector3f> vertex_colors;  // (N x 3), sRGB; empty where no view had colours
  std::vector<double> mask_iou;                // per view, at the fit's resolution
  std::vector<double> color_error;             // per view: mean |difference| per object pixel
  int steps = 0;
  bool complete = true;  // false: stopped early with the last finite mesh
  // Reports rollbacks, skipped remeshing, the repair of self-intersections and contradicting views.
  core::Findings findings;
};

// Fits the mesh to the views and to `objective` (may be null; then views are required) by gradient
// descent on the sum of squared differences of mask, colour (unlit, one per vertex, fitted jointly)
// and depth through the differentiable renderer, in the coordinates of LargeSteps, with a penalty
// on the change of normals. The topology is that of `start`: a sphere gets no hole; start from
// VisualHull for objects with holes. Where the loss or a gradient is not finite, the fit returns to
// the last finite state and halves the step; after five times it stops (`complete` is false and a
// finding gives the reason). Reproducible for the same seed and threads. Throws core::Error for
// invalid options, views or initial mesh; core::Cancelled.
MeshFitResult FitMesh(const core::TriangleMesh& start, const std::vector<ObservedView>& views,
                      ImageObjective* objective, const MeshFitOptions& options = {},
                      core::Progress* progress = nullptr);

}  // namespace simwright::asset_lift
