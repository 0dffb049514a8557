#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace simwright::asset_lift {

struct HashGridOptions {
  // 8 levels from 16 to 429 cells per side take a third of the time of the published 16 levels, and
  // images of 128 pixels hold no finer detail.
  int levels = 8;
  int features = 2;          // values per entry: 1, 2 or 4
  int log2_table_size = 15;  // maximum entries per level: the grid fits a core's cache
  int base_resolution = 16;  // cells per side of the coarsest level
  double scale = 1.6;        // growth of cells per side between levels

  // Returns true if a grid can be built; otherwise writes the reason to `error` where it is not
  // null.
  bool IsValid(std::string* error) const;
};

struct RadianceFieldOptions {
  HashGridOptions grid;
  // The units of the one hidden layer (ReLU, no biases), a multiple of 8 up to 128.
  int hidden = 32;
  // The field's cube is centred at `center` (m, world); the space outside it is empty.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double half_side = 0.5;  // m
  // Density = density_scale * softplus(raw), per half side. With the published 1 a fit of 200 steps
  // ends in a haze.
  double density_scale = 5.0;
  // The term added to the density before its softplus: by default a blob, blob_scale * (1 - |x| /
  // blob_std) with x in half sides. Poole et al., "DreamFusion", 2022, with the values of
  // threestudio's Zero-1-to-3.
  double blob_scale = 10.0;
  double blob_std = 0.5;
  // A function of a world point that replaces the blob where it is set. It is tabulated at 65^3
  // points and interpolated trilinearly; its values must be finite.
  std::function<double(const Eigen::Vector3d&)> density_bias;

  bool IsValid(std::string* error) const;
};

struct OccupancyOptions {
  double decay = 0.9;  // factor on a cell's density per update
  // A cell is empty if light that crosses it loses less than this share, or less than the mean over
  // all cells where that is lower: the grid must not cull a field that is thin everywhere.
  double threshold = 0.01;
};

struct VolumeRenderOptions {
  int max_samples = 64;        // per ray; at most 64
  double finest_step = 0.016;  // half sides: half a cell of the occupancy grid
  // A ray ends where its transmittance falls below this: regions behind a surface cost nothing.
  double min_transmittance = 1e-3;
  // The step of the finite differences for normals (half sides): about a cell of the finest level
  // that images of 128 pixels can train.
  double normal_step = 0.02;
  bool normals = false;

  bool IsValid(std::string* error) const;
};

// The weights of a field's losses; each loss is a mean over the rays of an image. The values are
// those of threestudio's Zero-1-to-3 (`depth` is ours: squared distances in units of the cube's
// half side).
struct FieldLossWeights {
  double color = 500.0;
  double mask = 50.0;
  double depth = 50.0;
  double objective = 0.1;  // the image objective's own loss, unscaled
  double orientation = 1.0;
  double sparsity = 0.1;
  double opaque = 0.1;
  // The published 8 is for images of more pixels; here it erodes thin parts.
  double normal_smoothness = 1.0;

  bool IsValid(std::string* error) const;  // finite and not negative
  bool UseNormals() const { return orientation > 0.0 || normal_smoothness > 0.0; }
};

// A stage of the fit, on observed views of one size.
struct FieldFitStage {
  int steps = 0;
  int view_side = 0;  // maximum pixels of a view's longer side
};

struct FieldFitOptions {
  // The cube that contains the object, and the field's sizes.
  RadianceFieldOptions field;
  // The published schedule (600 steps; 128, 256, 512 pixels) reduced for two cores.
  std::vector<FieldFitStage> stages = {{200, 64}, {100, 128}};
  // Rays of observed views per step: one view of 64 pixels, or random patches of larger views.
  int rays_per_step = 4096;
  // Adam's learning rate, which decays geometrically to `last_rate`. The published 0.01 is for 600
  // steps and gives a lower volume IoU in 200.
  double rate = 0.02;
  double last_rate = 0.004;
  FieldLossWeights weights;
  VolumeRenderOptions render;
  OccupancyOptions occupancy;
  int occupancy_interval = 16;  // steps between updates of the occupancy grid
  // True if space that projects outside a mask is excluded from the start, so that the fit need not
  // learn the masks and rays through empty space cost nothing.
  bool carve = true;
  // The side in pixels of a random image that takes the shape losses each step where there is no
  // objective, as the objective's images do. 0: none.
  int shape_picture_side = 48;
  double carve_margin = 1.0;  // pixels at the last stage's size, for masks that are slightly too
                              // small
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

struct FieldSurfaceOptions {
  int resolution = 96;  // cells per side of the cube
  // The candidate density levels, from a haze to a solid: densities in 1/m times the half side (m)
  // of the field's cube, hence without unit.
  std::vector<double> levels = {0.5, 1.0, 2.0, 4.0, 7.0, 10.0, 15.0, 25.0, 40.0, 80.0};
  // The longer side, in pixels, to which views are scaled for the comparison of silhouettes.
  int silhouette_side = 128;
  // The silhouette IoU below which the surface is returned with a finding.
  double good_iou = 0.8;
  // A component other than the largest is kept if it raises the silhouette IoU by more than this.
  double component_gain = 0.005;

  // Returns false for invalid values, with the reason in `error` unless it is null.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::asset_lift
