#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/picture_objective.h"
#include "asset_lift/view_frame.h"
#include "core/image.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

// What a shape prior makes of one crop: how likely each cell of the block of space behind it is
// filled, and what the hidden side looks like. Const and safe from several threads.
struct ShapePrediction {
  ViewFrame frame;
  core::Image crop;            // RGBA, kCropSide pixels a side: what was seen
  core::Image back;            // RGB, likewise: the hidden side through the same pixels
  std::vector<float> logits;   // (kDepthCells x side x side), log odds of "filled", nearest w first
  std::vector<float> front_w;  // (side x side) w of the first and the last filled cell of a pixel's
  std::vector<float> back_w;   // column, 0 where nothing is
  double elevation = 0.0;      // rad, of the sight line above the horizon
  double elevation_deviation = 0.0;  // rad, mean absolute error that the network expects

  // Log odds at a world point, trilinear; -8 outside the block. Never above what the crop's outline
  // allows.
  float Logit(const Eigen::Vector3d& point) const;
  // RGB (sRGB in [0, 1]) of the surface near a point: the photo's colours in the front half of the
  // column, the predicted ones of the hidden side in the other.
  Eigen::Vector3f Color(const Eigen::Vector3d& point) const;
  // World box of the cells that are more likely filled than not; empty where there are none.
  Eigen::AlignedBox3d box;
};

// What ShapePrediction::box holds, from the other members: whoever makes a prediction fills it.
Eigen::AlignedBox3d FilledBox(const ShapePrediction& prediction);

// The prediction drawn from any camera, by `samples` steps through its box: colour and opacity as a
// fit shows them, and the depth (m, 0 where nothing is) times opacity.
struct PredictionPicture {
  ObjectPicture picture;
  core::FloatImage depth;  // (H x W x 1)
};
PredictionPicture DrawPrediction(const ShapePrediction& prediction, const core::Camera& camera,
                                 int samples = 64);

// The surface at even odds, closed, in the world; `resolution` cells along the longest side.
// Throws core::Error where nothing is filled.
core::TriangleMesh PredictedSurface(const ShapePrediction& prediction, int resolution);

// The learned shape prior: one network, a few hundredths of a second a crop.
class ShapePrior {
 public:
  // Throws core::Error where the weights are missing, damaged or of another kind.
  explicit ShapePrior(const std::filesystem::path& weights);
  ~ShapePrior();
  ShapePrior(const ShapePrior&) = delete;
  ShapePrior& operator=(const ShapePrior&) = delete;

  ShapePrediction Predict(const core::Image& crop, const ViewFrame& frame) const;
  // As many at once. `crops` RGBA, kCropSide pixels a side; frames alike in number.
  std::vector<ShapePrediction> Predict(const std::vector<core::Image>& crops,
                                       const std::vector<ViewFrame>& frames) const;

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

}  // namespace simwright::asset_lift
