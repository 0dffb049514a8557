#pragma once

#include <memory>
#include <vector>

#include "asset_lift/mesh_fit/large_steps.h"
#include "asset_lift/mesh_fit/mesh_fit.h"
#include "asset_lift/mesh_fit/normal_penalty.h"
#include "asset_lift/mesh_fit/view_loss.h"
#include "core/random.h"
#include "render/differentiable.h"

namespace simwright::asset_lift {

// The gradient descent of FitMesh at a fixed topology.
class MeshDescent {
 public:
  // `colors` has one entry per vertex, or is empty. `diagonal` (m) is that of the initial mesh: the
  // unit of steps and depths.
  MeshDescent(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& colors,
              double diagonal, const MeshFitOptions& options);

  // Takes one step down the mean loss of `views` and of the objective's next image (may be null).
  // `progress` in [0, 1); `rate` in m. Returns the loss before the step. If the loss or a gradient
  // is not finite, no parameter changes and the returned value is not finite.
  double Step(const std::vector<const ViewTarget*>& views, ImageObjective* objective,
              double progress, double rate, core::Rng* rng);

  // Saves the state; RestoreState restores it and resets the optimizer's moments.
  void SaveState();
  void RestoreState();

  const core::TriangleMesh& mesh() const { return mesh_; }
  const std::vector<Eigen::Vector3f>& colors() const { return colors_; }

 private:
  double AddView(const ViewTarget& target, double weight, std::uint64_t seed);
  double AddObjective(ImageObjective* objective, double progress, core::Rng* rng);
  void Move(const Eigen::MatrixX3d& gradient, double rate);
  void Recolor();
  void Show();

  MeshFitOptions options_;
  ViewLossWeights weights_;
  core::TriangleMesh mesh_;
  std::vector<Eigen::Vector3f> colors_;
  LargeSteps steps_;
  NormalPenalty penalty_;
  render::DifferentiableRenderer renderer_;
  render::SceneGradients gradients_;
  render::DifferentiableBuffers pixel_gradient_;

  Eigen::MatrixX3d smooth_;  // the vertices' u coordinates (LargeSteps)
  AdamUniform adam_;
  std::vector<Eigen::Vector3f> color_mean_, color_square_;  // Adam's moments
  int color_steps_ = 0;

  Eigen::MatrixX3d kept_smooth_;
  std::vector<Eigen::Vector3f> kept_colors_;
};

}  // namespace simwright::asset_lift
