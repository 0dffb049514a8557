#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "asset_lift/lift.h"

namespace simwright::asset_lift {

// A photo with a known camera. RGBA where the object is already cut out.
struct PosedPhoto {
  core::Image photo;
  core::Camera camera;  // m, z up
  std::string name;     // used in findings
};

struct MultiViewOptions {
  bool field_stage = false;  // runs a radiance field between visual hull and mesh stage: carves
                             // concavities that no silhouette shows, from the colours
  ShapeFitOptions fit;
  int fit_side = 160;  // pixels per side of each photo's crop
  int texture_size = 1024;
  std::uint64_t seed = 1;
};

// Reconstructs one object from several photos with known cameras: the visual hull of its
// silhouettes, fitted to masks and colours, textured from all photos. The result is in the cameras'
// world frame and metres; its camera and photo are the first's. Photos whose cameras contradict the
// others are named in the findings and excluded. Throws core::Error for fewer than two photos that
// agree, a photo without a single salient object, or cameras without a common field of view;
// core::Cancelled.
LiftedMesh LiftPhotos(const std::vector<PosedPhoto>& photos, const CategoryPrior& prior,
                      const MultiViewOptions& options, core::Progress* progress);

}  // namespace simwright::asset_lift
