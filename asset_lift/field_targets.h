#pragma once

#include <vector>

#include "asset_lift/observed_view.h"
#include "asset_lift/volume_rendering.h"
#include "core/random.h"

namespace simwright::asset_lift {

// Rays through pixels of pictures, taken by square patches, so that most have their neighbours
// beside them.
struct PixelRays {
  std::vector<FieldRay> rays;
  std::vector<int> right, below;  // the neighbouring pixel's ray, or -1
  std::vector<int> pixel;         // y * width + x in the picture that the ray belongs to

  static constexpr int kPatch = 8;  // pixels a side

  void Clear();
  // Appends the patch with its upper left at (x, y), as far as it lies in the picture. With `rng`,
  // each ray goes through a random point of its pixel, else through its centre.
  void AppendPatch(const core::Camera& camera, int x, int y, core::Rng* rng);
  // Appends the whole picture.
  void AppendPicture(const core::Camera& camera);
};

// What rays of observed views should see.
struct RayTargets {
  PixelRays pixels;
  std::vector<float> color;    // (n x 3), premultiplied by opacity
  std::vector<float> opacity;  // (n)
  std::vector<float> depth;    // (n), m along the optical axis, 0 unknown
};

// Throws core::Error, naming the view's number, where sizes do not fit, a value or the camera is
// not finite, or nothing of the object is seen.
void RequireValidViews(const std::vector<ObservedView>& views);

// The view at `longer_side` pixels or its own size, if that is smaller: areas averaged, colours
// weighed by opacity, depths averaged where they are known to lie on the object.
ObservedView ScaledView(const ObservedView& view, int longer_side);

// A shuffled pack of all patches of some views that can show the object, dealt some at a time.
class TargetDeck {
 public:
  // Patches without any of the object, nor within a patch of it, are left out unless `everything`.
  TargetDeck(std::vector<ObservedView> views, bool everything);

  // The next patches, of `rays` rays at most (one patch at least); reshuffled when the pack ends.
  // No patch comes twice in one hand.
  void Deal(int rays, core::Rng* rng, RayTargets* hand);

  // Rays of the whole pack.
  int size() const;

 private:
  struct Patch {
    int view, x, y;
  };
  void Append(const Patch& patch, core::Rng* rng, RayTargets* hand) const;

  std::vector<ObservedView> views_;
  std::vector<Patch> patches_;
  std::size_t next_ = 0;
};

}  // namespace simwright::asset_lift
