#pragma once

#include <string>
#include <vector>

#include "asset_lift/lift.h"
#include "made_photos.h"

namespace simwright::bench {

// Returns the compared variants, one row of the table each:
//   ellipsoid  fills the silhouette's bounding box, as deep as its smaller half axis in the image;
//              mirrored colours
//   outline    the inflated silhouette (LiftEffort::kOutline)
//   guess      the initial shape, not fitted
//   fast       LiftEffort::kFast: no stage 1
//   stage1     the radiance field's surface, not refined
//   both       the full pipeline
//   no_prior   both stages from the inflated silhouette and the photo alone: no learned initial
//              shape, no score distillation
const std::vector<std::string>& LiftVariants();

struct VariantSettings {
  asset_lift::LiftPriors priors;
  bool true_elevation = false;  // given, instead of estimated
  std::uint64_t seed = 1;
};

// A variant's result in the reconstruction's world, with the photo's camera.
struct VariantResult {
  core::TexturedMesh mesh;
  core::Camera camera;
  double elevation = 0.0;  // rad, used by the reconstruction
  double seconds = 0.0;    // wall time of the reconstruction alone
  std::string start;       // initial shape
};

// Reconstructs a rendered photo; its mask and field of view are given, so that neither is measured.
// Throws core::Error for an unknown variant, and the errors of LiftPhoto and FitShape.
VariantResult LiftVariant(const std::string& variant, const CatalogueObject& object,
                          const MadePhoto& made, const VariantSettings& settings);

}  // namespace simwright::bench
