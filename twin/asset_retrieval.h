#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/image.h"
#include "core/progress.h"
#include "twin/table_assets.h"
#include "twin/table_reconstruction.h"

namespace simwright::twin {

// The agreement of an asset in a pose with the photo.
struct AssetAgreement {
  double iou = 0.0;  // of the outlines
  // sqrt(sum |p - r (a + b . n)|^2 / sum |p|^2) over the pixels that both show, p and r being the
  // linear colours of photo and asset, n the normals, a and b fitted: light of the first order and
  // of one colour over the asset's own colours. In [0, 1]; 1: nothing is shared.
  double color_error = 1.0;
  double Loss() const { return 2.0 * (1.0 - iou) + color_error; }
};

struct RetrievalOptions {
  int yaws = 20;                   // tried for each asset
  int refined = 4;                 // starts of the search, of all assets together
  int generations = 14;            // of CMA-ES over the pose
  int side = 80;                   // pixels per side of the compared crops
  double least_iou = 0.8;          // of an asset that is taken
  double most_color_error = 0.42;  // the model lacks shadows within the asset
  // An asset is taken where its outline's IoU is that of the fitted kind of the library or less by
  // at most this: it has no shape to adapt.
  double iou_margin = 0.06;
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

// Looks for the user's assets among the objects of a reconstruction: each asset is turned by equal
// angles, placed by the object's box and compared, and the best are refined. Where one agrees as
// well as the fitted kind it takes its place: `retrieved`, pose, size and uncertainty. Assets are
// metric: if the scale was not known, the median of the scales that they need replaces it, in all
// lengths and the camera, with the finding "twin-scale-from-assets". `photo` and `detections` are
// those of the reconstruction. Throws core::Error for invalid options.
void RetrieveAssets(const core::Image& photo, const Detections& detections,
                    const std::vector<TableAsset>& assets, const RetrievalOptions& options,
                    TableReconstruction* table, core::Progress* progress, core::Findings* findings);

// Returns the name of a retrieved object's asset, of `assets`, or of a fitted object's kind: "mug".
const std::string& NameOf(const ReconstructedObject& object, const std::vector<TableAsset>& assets);

}  // namespace simwright::twin
