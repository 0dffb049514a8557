#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "asset_lift/lift.h"

namespace simwright::asset_lift {

// A photo whose camera is known. RGBA where the object is cut out already.
struct PosedPhoto {
  core::Image photo;
  core::Camera camera;  // m, z up
  std::string name;     // for what there is to say of it
};

struct MultiViewOptions {
  bool field_stage = false;  // between the visual hull and the mesh stage: fills hollows that no
                             // outline shows, from the colours
  ShapeFitOptions fit;
  int fit_side = 160;  // pixels a side of each photo's crop
  int texture_size = 1024;
  std::uint64_t seed = 1;
};

// One thing from several photos with known cameras: the visual hull of its outlines, fitted to
// masks and colours, textured from all photos. In the cameras' world and metres; the camera and
// photo of the result are the first's. Photos whose cameras contradict the others are named in the
// findings and left out. Throws core::Error: fewer than two photos that agree, a photo without one
// object that stands out, cameras that see no common place; core::Cancelled.
LiftedMesh LiftPhotos(const std::vector<PosedPhoto>& photos, const CategoryPrior& prior,
                      const MultiViewOptions& options, core::Progress* progress);

}  // namespace simwright::asset_lift
