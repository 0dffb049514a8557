#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "asset_lift/observed_view.h"
#include "core/mesh.h"
#include "core/progress.h"
#include "geometry/isosurface.h"

namespace simwright::asset_lift {

struct VisualHullOptions {
  // Along the longest side of the hull's box. 96 put a cell at about a pixel of a 128-pixel view.
  int cells = 96;
  // Where to look, world, m; empty: found from where the masks' cones cross.
  Eigen::AlignedBox3d bounds;
  // Largest standard deviation of the colours (sRGB, all channels together) that the views which
  // see a place may find there; where it is more, it is air (space carving, Kutulakos and Seitz
  // 2000). Opens hollows that no outline shows, but needs patterned surfaces, even light and true
  // cameras; where it would eat what the masks show, it is left out. 0: masks (and depths, where
  // given) alone. 0.1 is a start.
  double color_tolerance = 0.0;

  bool IsValid(std::string* error) const;
};

// Throws core::Error, naming the view, for one without pixels, focal length or mask, of images
// that do not have its camera's size, or with values that are not finite. Colour may be missing.
void RequireValid(const std::vector<ObservedView>& views);

// Whatever lies in all the masks' cones and, where a view has depths, not in front of them: an
// outer bound of what was seen, and the start of a fit. A view says nothing about places beyond a
// border that its mask touches. Specks of less than a hundredth of the largest part's volume are
// left out. Closed, oriented, free of self-intersections, m. Throws core::Error where no place lies
// in all masks (naming the views that ExamineViews blames), for views that are not valid or fewer
// than two; core::Cancelled.
core::TriangleMesh VisualHull(const std::vector<ObservedView>& views,
                              const VisualHullOptions& options = {},
                              core::Progress* progress = nullptr);

// Signed distance to the mask's outline, pixels, negative inside. (H x W x 1), at pixel centres.
core::FloatImage MaskDistance(const core::FloatImage& opacity);

// A view's mask as a field in space.
class MaskCone {
 public:
  explicit MaskCone(const ObservedView& view);

  // Signed distance to the cone of the mask, m, roughly, positive outside; the lowest double where
  // the view says nothing. Where the view has a depth, at least what the point lies in front of it.
  double At(const Eigen::Vector3d& point) const;

 private:
  double Bilinear(double x, double y) const;
  double InFront(double x, double y, double z) const;

  core::Camera camera_;
  Eigen::Isometry3d camera_from_world_;
  core::FloatImage distance_;
  core::FloatImage depth_;
};

// Where the middles of the masks are seen (the nearest point to those rays), and how far the masks
// reach from there at most, m: a box about all that any mask shows.
Eigen::AlignedBox3d ReachBox(const std::vector<ObservedView>& views);

// The signed distance to the hull of the masks, m, roughly: right at the surface and in sign.
geometry::ScalarGrid HullField(const std::vector<ObservedView>& views,
                               const Eigen::AlignedBox3d& box, int cells);

// A box about what the masks show. Throws as VisualHull does.
Eigen::AlignedBox3d HullBounds(const std::vector<ObservedView>& views);

}  // namespace simwright::asset_lift
