#pragma once

#include <string>
#include <vector>

#include "asset_lift/lift.h"
#include "made_photos.h"

namespace simwright::bench {

// What is compared, a row of the table each:
//   ellipsoid  fills the outline's box, as deep as its smaller half axis in the picture; mirrored
//              colours
//   outline    the inflated outline (LiftEffort::kOutline)
//   guess      the first guess, not fitted
//   fast       LiftEffort::kFast: no stage 1
//   stage1     the radiance field's surface, not refined
//   both       the full lift
//   no_prior   both stages from the inflated outline and the photo alone: no learned guess, no
//   score
//              distillation
const std::vector<std::string>& LiftVariants();

struct VariantSettings {
  asset_lift::LiftPriors priors;
  bool true_elevation = false;  // given to the lift, which estimates it otherwise
  std::uint64_t seed = 1;
};

// A variant's result in the lift's world, with the photo's camera there.
struct VariantResult {
  core::TexturedMesh mesh;
  core::Camera camera;
  double elevation = 0.0;  // rad, that the lift went by
  double seconds = 0.0;    // wall time of the lift alone
  std::string start;       // what it started from
};

// Lifts a made photo; its mask and field of view are given, so that neither is what is measured.
// Throws core::Error for an unknown variant, and what LiftPhoto and FitShape throw.
VariantResult LiftVariant(const std::string& variant, const CatalogueObject& object,
                          const MadePhoto& made, const VariantSettings& settings);

}  // namespace simwright::bench
