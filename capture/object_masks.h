#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "capture/color_mixture.h"
#include "capture/mat_evidence.h"
#include "core/image.h"
#include "core/mesh.h"

namespace simwright::capture {

struct ObjectMask {
  core::FloatImage opacity;  // (H x W x 1)
  // (H x W x 1) 1 where the photo's colour can as well be the mat's as the object's; empty:
  // nowhere.
  core::FloatImage unsure;
};

// Segments the object that stands on a mat in one photo: pixels that look as the mat should are
// background, pixels that do not are object. On a printed mat a cut that knows its colours decides
// (CutFromMat), on a table GrabCut (Rother et al. 2004). `hull`: the silhouette of the hull of all
// views, which limits the object and tells where to look for it beside the mat; empty: unknown yet.
// `others`: the object's colours in the other photos, or null; unused on a table. The opacity is 0
// or 1, near the outline that of MatteOnMat, or softened where there is no hull yet. Throws
// core::Error if sizes differ.
ObjectMask SegmentOnMat(const core::Image& photo, const MatEvidence& evidence,
                        const core::FloatImage& hull, const ColorMixture* others);

// Returns the colours, RGB in [0, 255], of the mask's pixels that lie before the mat and differ
// from it by more than noise and shadows explain. `photo` and `evidence`: those of the mask.
std::vector<Eigen::Vector3f> ColorsBeforeMat(const core::Image& photo, const MatEvidence& evidence,
                                             const ObjectMask& mask);

// Returns 1 for the pixels beside the mat (H x W x 1): there a first mask, which rests on the mat,
// says nothing.
core::FloatImage PixelsBesideMat(const MatEvidence& evidence);

// Sets the opacity to 0 where a pixel lies beside the mat and outside the hull's silhouette (H x W
// x 1, grown by 3 % of its size): what only one photo shows there is background. Over the mat
// nothing changes, so that photos which contradict the hull still do.
void ClipBesideMat(const MatEvidence& evidence, const core::FloatImage& hull,
                   core::FloatImage* opacity);

// Returns the silhouette of a mesh (H x W x 1), 0 or 1 and softened at the outline.
core::FloatImage SilhouetteOf(const core::TriangleMesh& mesh, const core::Camera& camera);

}  // namespace simwright::capture
