#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/observed_view.h"
#include "asset_lift/picture_objective.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct MeshFitOptions {
  // Coarse to fine: each round remeshes to its edge length (from the first to the last in equal
  // ratios, of the start's diagonal) and then descends.
  int rounds = 4;
  int steps_per_round = 150;
  double first_edge_ratio = 0.05;
  double last_edge_ratio = 0.02;  // about 6000 faces for a ball
  // Edges sharper than this survive remeshing as they are, deg.
  double feature_angle_deg = 60.0;

  int max_side = 128;        // pixels to which views are averaged down
  int views_per_step = 4;    // drawn in turn; the objective's picture comes on top
  int samples_per_side = 2;  // of a pixel
  int edge_samples = 4000;   // of a picture

  double mask_weight = 1.0;
  double color_weight = 1.0;
  double depth_weight = 20.0;   // of squared depths in diagonals
  double normal_weight = 0.01;  // of 1 - cosine across edges: evens out what no view decides
  double objective_weight = 1.0;

  // Lambda of large steps. The paper's 19 with its steps of 0.3% left a mug's hollow at 1.5% of the
  // diagonal where these values reach 0.9%: gradients at outlines and of colours have long tails,
  // and the largest one sets the scale of all.
  double smoothing = 5.0;
  double step_ratio = 0.04;  // of the diagonal: a step in the smoothed coordinates
  double color_rate = 0.03;  // a step of a vertex's colour
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

struct MeshFitResult {
  core::TriangleMesh mesh;  // closed, oriented outward, free of self-intersections; m
  std::vector<Eigen::Vector3f> vertex_colors;  // (N x 3), sRGB; empty where nothing had colours
  std::vector<double> mask_iou;                // by view, at the fit's resolution
  std::vector<double> color_error;             // by view: mean |difference| a pixel of the object
  int steps = 0;
  bool complete = true;  // false: stopped early with the last good mesh
  // Steps back, remeshing left out, how crossings were removed, views that contradict the others.
  core::Findings findings;
};

// Moves the mesh until its pictures are those of the views, and `objective` (may be null; then
// there have to be views) is content: descent on the sum of squared differences of mask, colour
// (unlit, one a vertex, fitted along) and depth through the differentiable renderer, in the
// coordinates of LargeSteps, with a penalty on the change of normals. The topology is the start's:
// a sphere gets no hole; start from VisualHull for what has one.
// Where the loss or a gradient is not finite, the fit goes back to the last good state and halves
// the step; after five times it stops there (`complete` is false, a finding says why).
// Reproducible for the same seed and threads. Throws core::Error for options, views or a start that
// are not valid; core::Cancelled.
MeshFitResult FitMesh(const core::TriangleMesh& start, const std::vector<ObservedView>& views,
                      PictureObjective* objective, const MeshFitOptions& options = {},
                      core::Progress* progress = nullptr);

}  // namespace simwright::asset_lift
