#pragma once

#include <cstdint>
#include <string>

#include "asset_lift/radiance_field/field_fit_options.h"

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
  double depth_weight = 20.0;  // of squared depths in units of the diagonal
  // Depths that are wrong by more than this share of the diagonal count linearly; 0: all squared.
  double depth_tolerance = 0.0;
  double normal_weight = 0.01;  // of 1 - cosine across edges: smooths regions that no view
                                // constrains
  // From about this angle on, an edge is a crease that costs the same whatever its angle
  // (normal_penalty.h), deg; 0: none.
  double crease_angle_deg = 0.0;
  // Weights of the area over the squared diagonal (area_penalty.h), from the first to the last step
  // in a geometric sequence; 0: none.
  double first_area_weight = 0.0;
  double last_area_weight = 0.0;
  bool stands_on_floor = false;  // holds the base on the floor z = 0 (floor_contact.h)
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

}  // namespace simwright::asset_lift
