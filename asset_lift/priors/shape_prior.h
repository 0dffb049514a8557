#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/camera/view_frame.h"
#include "asset_lift/priors/image_objective.h"
#include "core/image.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

// A shape prior's prediction for one crop: the occupancy of each cell of the block of space behind
// it and the colours of the hidden side. Const and thread-safe.
struct ShapePrediction {
  ViewFrame frame;
  core::Image crop;            // RGBA, kCropSide pixels per side: the input
  core::Image back;            // RGB, same size: the hidden side through the same pixels
  std::vector<float> logits;   // (kDepthCells x side x side), log odds of "filled", nearest w first
  std::vector<float> front_w;  // (side x side) w of the first and the last filled cell of a pixel's
  std::vector<float> back_w;   // column, 0 where it is empty
  double elevation = 0.0;      // rad, of the line of sight above the horizon
  double elevation_deviation = 0.0;  // rad, mean absolute error that the network expects

  // Returns the log odds at a world point, trilinearly interpolated; -8 outside the block. They
  // never exceed the bound of the crop's silhouette.
  float Logit(const Eigen::Vector3d& point) const;
  // Returns the RGB (sRGB in [0, 1]) of the surface near a point: the photo's colours in the front
  // half of the column, the predicted colours of the hidden side in the back half.
  Eigen::Vector3f Color(const Eigen::Vector3d& point) const;
  // The world AABB of the cells that are more likely filled than not; empty where there are none.
  Eigen::AlignedBox3d box;
};

// Returns the value of ShapePrediction::box, computed from the other members. The creator of a
// prediction sets it.
Eigen::AlignedBox3d FilledBox(const ShapePrediction& prediction);

// Renders the prediction from any camera, with `samples` steps through its AABB: colour and opacity
// as for a fit, and the depth (m, 0 for background) times opacity.
struct RenderedPrediction {
  ObjectImage picture;
  core::FloatImage depth;  // (H x W x 1)
};
RenderedPrediction RenderPrediction(const ShapePrediction& prediction, const core::Camera& camera,
                                    int samples = 64);

// Returns the closed isosurface at even odds in the world frame; `resolution` is the number of
// cells along the longest side. Throws core::Error where no cell is filled.
core::TriangleMesh PredictedSurface(const ShapePrediction& prediction, int resolution);

// The learned shape prior: one network, a few hundredths of a second per crop.
class ShapePrior {
 public:
  // Throws core::Error where the weights are missing, damaged or of another kind.
  explicit ShapePrior(const std::filesystem::path& weights);
  ~ShapePrior();
  ShapePrior(const ShapePrior&) = delete;
  ShapePrior& operator=(const ShapePrior&) = delete;

  ShapePrediction Predict(const core::Image& crop, const ViewFrame& frame) const;
  // Predicts a batch. `crops` are RGBA with kCropSide pixels per side; there are as many frames.
  std::vector<ShapePrediction> Predict(const std::vector<core::Image>& crops,
                                       const std::vector<ViewFrame>& frames) const;

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

}  // namespace simwright::asset_lift
