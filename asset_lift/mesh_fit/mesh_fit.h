#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/priors/image_objective.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct MeshFitOptions {
  // Coarse to fine: each round remeshes to its edge length (from the first to the last ratio in a
  // geometric sequence, relative to the initial diagonal) and then descends.
  int rounds = 4;
  int steps_per_round = 150;
  double first_edge_ratio = 0.05;
  double last_edge_ratio = 0.02;  // about 6000 faces for a ball
  // Edges sharper than this are preserved by remeshing, deg.
  double feature_angle_deg = 60.0;

  int max_side = 128;        // maximum side in pixels; views are averaged down to it
  int views_per_step = 4;    // in rotation; the objective's image is additional
  int samples_per_side = 2;  // per pixel
  int edge_samples = 4000;   // per image

  double mask_weight = 1.0;
  double color_weight = 1.0;
  double depth_weight = 20.0;   // of squared depths in units of the diagonal
  double normal_weight = 0.01;  // of 1 - cosine across edges: smooths regions that no view
                                // constrains
  double objective_weight = 1.0;

  // The lambda of large steps. The paper's 19 with its steps of 0.3% leaves hollows less accurate:
  // gradients at silhouettes and of colours have long tails, and the largest gradient sets the
  // scale of all.
  double smoothing = 5.0;
  double step_ratio = 0.04;  // of the diagonal, per step in the smoothed coordinates
  double color_rate = 0.03;  // per step of a vertex's colour
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

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
