#pragma once

#include <memory>
#include <string>

#include "asset_lift/camera/view_frame.h"
#include "asset_lift/priors/image_objective.h"
#include "asset_lift/priors/score_distillation_options.h"
#include "core/image.h"

namespace simwright::asset_lift {

class ViewPrior;

// Score distillation (Poole et al. 2022): the gradient of an image x is
//   w(t) (noise^(a_t x + s_t noise; t, y) - noise) dz/dx,  w(t) = s_t^2,
// with y the reference photo and the relative camera, noise^ the guided prediction, z the prior's
// encoding. Cameras lie on a sphere about the origin with the reference camera's radius, at all
// azimuths.
class ScoreDistillation : public ImageObjective {
 public:
  // `frame` holds the reference camera; `photo` and `alpha` have its image size. Throws core::Error
  // for invalid options.
  ScoreDistillation(std::shared_ptr<ViewPrior> prior, const ViewFrame& frame,
                    const core::Image& photo, const core::Image& alpha,
                    const ScoreDistillationOptions& options = {});
  ~ScoreDistillation() override;

  core::Camera NextCamera(double progress, core::Rng* rng) override;
  double Evaluate(const core::Camera& camera, const ObjectImage& picture, double progress,
                  core::Rng* rng, ObjectImage* gradient) override;

 private:
  std::shared_ptr<ViewPrior> prior_;
  ViewFrame frame_;
  ScoreDistillationOptions options_;
};

}  // namespace simwright::asset_lift
