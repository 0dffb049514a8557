#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/radiance_field/volume_rendering.h"
#include "core/random.h"

namespace simwright::asset_lift {

// Rays through pixels of images, sampled in square patches, so that most rays have their neighbours
// beside them.
struct PixelRays {
  std::vector<FieldRay> rays;
  std::vector<int> right, below;  // the neighbouring pixel's ray, or -1
  std::vector<int> pixel;         // y * width + x in the ray's image

  static constexpr int kPatch = 8;  // pixels per side

  void Clear();
  // Appends the patch with its upper left corner at (x, y), clipped to the image. With `rng`, each
  // ray passes through a random point of its pixel, otherwise through its centre.
  void AppendPatch(const core::Camera& camera, int x, int y, core::Rng* rng);
  // Appends all pixels of the image.
  void AppendImage(const core::Camera& camera);
};

// The target values for rays of observed views.
struct RayTargets {
  PixelRays pixels;
  std::vector<float> color;    // (n x 3), premultiplied by opacity
  std::vector<float> opacity;  // (n)
  std::vector<float> depth;    // (n), m along the optical axis, 0 unknown
};

// Throws core::Error, naming the view's index, where sizes do not match, a value or the camera is
// not finite, or the mask is empty.
void RequireValidViews(const std::vector<ObservedView>& views);

// Returns the view scaled down to `longer_side` pixels, or unchanged if it is smaller: areas are
// averaged, colours weighted by opacity, and depths averaged where they are known to lie on the
// object.
ObservedView ScaledView(const ObservedView& view, int longer_side);

// A shuffled list of all patches of some views that can show the object, returned in batches.
class PatchSampler {
 public:
  // Excludes patches that neither contain the object nor have it within a patch's distance, unless
  // `everything`.
  PatchSampler(std::vector<ObservedView> views, bool everything);

  // Writes the next patches to `batch`, at most `rays` rays but at least one patch; reshuffles at
  // the end of the list. No patch appears twice in one batch.
  void NextBatch(int rays, core::Rng* rng, RayTargets* batch);

  // Returns the number of rays in all patches.
  int size() const;

 private:
  struct Patch {
    int view, x, y;
  };
  void Append(const Patch& patch, core::Rng* rng, RayTargets* batch) const;

  std::vector<ObservedView> views_;
  std::vector<Patch> patches_;
  std::size_t next_ = 0;
};

}  // namespace simwright::asset_lift
