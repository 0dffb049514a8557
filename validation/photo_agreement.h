#pragma once

#include "core/mesh.h"
#include "validation/asset_photo.h"

namespace simwright::validation {

// The agreement of a mesh with the photo that it was reconstructed from.
struct PhotoAgreement {
  double outline_iou = 0.0;  // of both silhouettes
  // The following two are defined for a photo with a contrast of its own.
  bool textured = false;
  double texture_contrast = 0.0;  // of the render from the photo's camera, over the photo's
  double hidden_contrast = 0.0;   // of the render from behind, over that from the front
};

// Renders the mesh (the photo's camera's frame, m) from the photo's camera, and from behind: the
// same camera turned by half a turn about the vertical axis through the mesh's middle. Contrast is
// the root mean square difference of neighbouring pixels' grey values away from the outline, in
// pictures of 256 pixels: finer detail is mostly the photo's noise.
PhotoAgreement CompareWithPhoto(const core::TexturedMesh& mesh, const AssetPhoto& photo);

}  // namespace simwright::validation
