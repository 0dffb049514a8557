#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "capture/mat_evidence.h"
#include "core/image.h"
#include "core/mesh.h"

namespace simwright::capture {

// Segments the object that stands on a mat in one photo (GrabCut, Rother et al. 2004): pixels that
// look as the mat should are background, pixels that do not are object. `hull`: the silhouette of
// the hull of all views, which limits the object and tells where to look for it beside the mat;
// empty: unknown yet. Returns the opacity (H x W x 1): 0 or 1, near the outline that of MatteOnMat,
// or softened where there is no hull yet. Throws core::Error if sizes differ.
core::FloatImage SegmentOnMat(const core::Image& photo, const MatEvidence& evidence,
                              const core::FloatImage& hull);

// Returns the opacity with the pixels beside the mat counted as object: there a first mask, which
// rests on the mat, says nothing.
core::FloatImage OpenBesideMat(const core::FloatImage& opacity, const MatEvidence& evidence);

// Sets the opacity to 0 where a pixel lies beside the mat and outside the hull's silhouette (H x W
// x 1, grown by 3 % of its size): what only one photo shows there is background. Over the mat
// nothing changes, so that photos which contradict the hull still do.
void ClipBesideMat(const MatEvidence& evidence, const core::FloatImage& hull,
                   core::FloatImage* opacity);

// Returns the silhouette of a mesh (H x W x 1), 0 or 1 and softened at the outline.
core::FloatImage SilhouetteOf(const core::TriangleMesh& mesh, const core::Camera& camera);

}  // namespace simwright::capture
