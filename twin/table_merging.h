#pragma once

#include <vector>

#include "core/finding.h"
#include "twin/table_assets.h"
#include "twin/table_reconstruction.h"

namespace simwright::twin {

// The motion in the plane, and the factor of lengths, that leads from one reconstruction's frame to
// another's.
struct PlaneSimilarity {
  double turn = 0.0;               // rad
  double log_scale = 0.0;          // of the logarithm of lengths
  Eigen::Vector2d move{0.0, 0.0};  // m

  Eigen::Vector2d operator*(const Eigen::Vector2d& point) const;
};

// An object that one or several photos show.
struct MergedObject {
  int view = 0, object = 0;     // the reconstruction, and the object in it, whose fit is taken
  TablePose pose;               // in the frame of the first reconstruction, at the common scale
  double size_factor = 1.0;     // of the taken fit's size
  double confidence = 0.0;      // that no photo is wrong about it: 1 - prod (1 - confidence)
  double position_error = 0.0;  // m, one standard deviation in the plane
  double yaw_error = 0.0;       // rad
  double size_error = 0.0;      // of the logarithm
  std::vector<int> seen_in;     // the reconstructions that show it
};

struct MergedTables {
  std::vector<MergedObject> objects;
  std::vector<PlaneSimilarity> first_from_view;  // by reconstruction
  double log_scale = 0.0;        // to be added to the logarithms of the first one's lengths
  double log_scale_error = 0.0;  // of the result
  core::Findings findings;
};

// Merges reconstructions of one table from several photos. Each is aligned with the first by the
// pairs of objects of like kinds whose similarity brings most objects together (within 3 standard
// deviations and 3 cm), refined by least squares (Umeyama 1991). Scales that are not known are
// averaged in their logarithms by inverse variance, and so are positions, sizes, and yaws that
// agree; the kind is that with the largest sum of confidences. Objects that only another photo
// shows are added where their confidence is at least 0.25. Disagreements are findings
// ("twin-views-disagree"), which name kinds, and retrieved objects by their asset in `assets`.
// Throws core::Error, which names the photo by its number, where fewer than two objects correspond.
MergedTables MergeTables(const std::vector<TableReconstruction>& views,
                         const std::vector<TableAsset>& assets);

}  // namespace simwright::twin
