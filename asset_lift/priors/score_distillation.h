#pragma once

#include <memory>
#include <string>

#include "asset_lift/camera/view_frame.h"
#include "asset_lift/priors/image_objective.h"
#include "core/image.h"

namespace simwright::asset_lift {

class ViewPrior;

struct ScoreDistillationOptions {
  // The bounds between which t is sampled, as shares of the diffusion steps; they move from the
  // first to the second value over `anneal` of the fit. Zero-1-to-3 in threestudio: .4 to .2 and
  // .85 to .5.
  double t_min_first = 0.4, t_min_last = 0.2;
  double t_max_first = 0.85, t_max_last = 0.5;
  double anneal = 0.33;
  double guidance = 3.0;          // classifier-free (Ho and Salimans 2022)
  double elevation_min = -0.17;   // rad; -10 to 80 degrees as in threestudio
  double elevation_max = 1.4;     // rad
  int side = 0;                   // pixels per side of the requested images; 0: the prior's size
  double largest_gradient = 1.0;  // per pixel channel, before the sum: clips outliers

  bool IsValid(std::string* error) const;
};

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
