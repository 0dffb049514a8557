#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/finding.h"
#include "core/image.h"
#include "core/progress.h"
#include "twin/object_detector.h"
#include "twin/table_assets.h"
#include "twin/table_merging.h"
#include "twin/table_reconstruction.h"
#include "workflows/twin/twin_record.h"

namespace simwright::workflows {

// The places of a photo's objects in the twin, where several photos determine them; empty: those of
// the reconstruction.
struct TwinPlacements {
  std::vector<twin::TablePose> poses;     // by object
  std::vector<std::vector<int>> seen_in;  // photos, from 0
};

// Leaves in the reconstruction of the photo `view` the objects whose fit the merged tables take, at
// the common scale and with the merged uncertainties, and returns their places.
TwinPlacements TakeMerged(const twin::MergedTables& merged, int view,
                          twin::TableReconstruction* table);

// The reconstruction whose objects become assets, with the photo (RGB) and the detections that it
// was made of.
struct TwinAssetSources {
  const twin::TableReconstruction& table;
  const core::Image& photo;
  const twin::Detections& detections;
  const std::vector<twin::TableAsset>& assets;  // that may have been retrieved
  const TwinPlacements& placements;
  double free_form = 0.0;  // objects of a lower confidence are reconstructed from the photo
  std::uint64_t seed = 1;
};

// Writes an asset folder, below `folder`, for each object of a reconstruction: a copy of the
// retrieved asset, a free-form reconstruction of a doubtful object, or the fitted object of the
// library, painted by the photo where it shows its surface. Returns the objects with the poses of
// their assets. Objects whose asset cannot be made are left out, with a finding; a reconstruction
// that fails leaves the fitted object, with a finding. `names` counts the folders of each name.
std::vector<TwinObject> WriteTwinAssets(const TwinAssetSources& sources,
                                        const std::filesystem::path& folder,
                                        std::map<std::string, int>* names, core::Progress* progress,
                                        core::Findings* findings);

}  // namespace simwright::workflows
