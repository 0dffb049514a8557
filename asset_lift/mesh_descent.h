#pragma once

#include <memory>
#include <vector>

#include "asset_lift/large_steps.h"
#include "asset_lift/mesh_fit.h"
#include "asset_lift/normal_penalty.h"
#include "asset_lift/view_loss.h"
#include "core/random.h"
#include "render/differentiable.h"

namespace simwright::asset_lift {

// The descent of FitMesh while the topology stays.
class MeshDescent {
 public:
  // `colors` one a vertex, or none. `diagonal` m, of the start: the measure of steps and depths.
  MeshDescent(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& colors,
              double diagonal, const MeshFitOptions& options);

  // One step down the mean loss of `views` and of the objective's next picture (may be null).
  // `progress` in [0, 1); `rate` m. Returns the loss before the step. Where that or a gradient is
  // not finite nothing moves, and the answer is not finite.
  double Step(const std::vector<const ViewTarget*>& views, PictureObjective* objective,
              double progress, double rate, core::Rng* rng);

  // Remembers the state; goes back to it, with the moments of the steps forgotten.
  void Keep();
  void GoBack();

  const core::TriangleMesh& mesh() const { return mesh_; }
  const std::vector<Eigen::Vector3f>& colors() const { return colors_; }

 private:
  double AddView(const ViewTarget& target, double weight, std::uint64_t seed);
  double AddObjective(PictureObjective* objective, double progress, core::Rng* rng);
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

  Eigen::MatrixX3d smooth_;  // u of the vertices
  AdamUniform adam_;
  std::vector<Eigen::Vector3f> color_mean_, color_square_;  // Adam's moments
  int color_steps_ = 0;

  Eigen::MatrixX3d kept_smooth_;
  std::vector<Eigen::Vector3f> kept_colors_;
};

}  // namespace simwright::asset_lift
