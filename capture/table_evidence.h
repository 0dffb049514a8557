#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "capture/mat_evidence.h"
#include "core/camera.h"
#include "core/float_image.h"
#include "core/image.h"

namespace simwright::capture {

// A photo without distortion, and where the object hides the table in it.
struct TableView {
  const core::Image* photo = nullptr;      // RGB
  const core::Camera* camera = nullptr;    // the object stands on z = 0
  const core::FloatImage* hull = nullptr;  // (H x W x 1) the hull's silhouette; null: unknown
};

// A picture of the table from above, made of all photos: each view sees the table where the object
// hides it from another.
struct TablePicture {
  Eigen::AlignedBox2d area;  // of the plane z = 0
  core::FloatImage color;    // (N x N x 3), of 255, rows from the highest y
  // (N x N x 1) the share of the photos that agree on the colour; 0: unknown, e.g. always hidden or
  // not a part of the plane.
  core::FloatImage support;
  std::vector<Eigen::Vector3d>
      gains;  // per view and channel: the photo's colour over the picture's
};

// Paints the table from the views' photos, `cells` per side. A cell's colour is the one that most
// photos agree on; where under half of at least three do, it is unknown. Exposure and white balance
// may differ from photo to photo. Throws core::Error for an empty area.
TablePicture PaintTable(const std::vector<TableView>& views, const Eigen::AlignedBox2d& area,
                        int cells);

// Compares view `index` of those with which the table was painted with the table that it should
// show: as CompareWithMat does with a mat. The albedo stays empty; where the table is unknown, the
// difference is -1.
MatEvidence CompareWithTable(const TableView& view, const TablePicture& table, int index);

}  // namespace simwright::capture
