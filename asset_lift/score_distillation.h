#pragma once

#include <memory>
#include <string>

#include "asset_lift/picture_objective.h"
#include "asset_lift/view_frame.h"
#include "core/image.h"

namespace simwright::asset_lift {

class ViewPrior;

struct ScoreDistillationOptions {
  // Shares of the diffusion's steps between which t is drawn; they move from the first to the
  // second value over `anneal` of the fit. Zero-1-to-3 in threestudio: .4 to .2 and .85 to .5.
  double t_min_first = 0.4, t_min_last = 0.2;
  double t_max_first = 0.85, t_max_last = 0.5;
  double anneal = 0.33;
  double guidance = 3.0;          // classifier-free (Ho and Salimans 2022)
  double elevation_min = -0.17;   // rad; -10 to 80 degrees as there
  double elevation_max = 1.4;     // rad
  int side = 0;                   // pixels a side of the pictures asked for; 0: as the prior sees
  double largest_gradient = 1.0;  // of a pixel's channel, before the sum: tames rare outliers

  bool IsValid(std::string* error) const;
};

// Score distillation (Poole et al. 2022): the gradient of a picture x is
//   w(t) (noise^(a_t x + s_t noise; t, y) - noise) dz/dx,  w(t) = s_t^2,
// with y the picture that was taken and the relative camera, noise^ guided, z the prior's encoding.
// Cameras stand on a sphere about the origin, as far as the reference camera, all round.
class ScoreDistillation : public PictureObjective {
 public:
  // The picture that was taken: `frame` says by what camera; photo and alpha of its size. Throws
  // core::Error for options that are not valid.
  ScoreDistillation(std::shared_ptr<ViewPrior> prior, const ViewFrame& frame,
                    const core::Image& photo, const core::Image& alpha,
                    const ScoreDistillationOptions& options = {});
  ~ScoreDistillation() override;

  core::Camera NextCamera(double progress, core::Rng* rng) override;
  double Evaluate(const core::Camera& camera, const ObjectPicture& picture, double progress,
                  core::Rng* rng, ObjectPicture* gradient) override;

 private:
  std::shared_ptr<ViewPrior> prior_;
  ViewFrame frame_;
  ScoreDistillationOptions options_;
};

}  // namespace simwright::asset_lift
