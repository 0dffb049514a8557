#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "asset_lift/camera/observed_view.h"
#include "core/mesh.h"
#include "core/progress.h"
#include "geometry/isosurface.h"

namespace simwright::asset_lift {

struct VisualHullOptions {
  // The cells along the longest side of the hull's AABB. 96 makes a cell about a pixel of a
  // 128-pixel view.
  int cells = 96;
  // The world AABB to search, m; empty: computed from the intersection of the masks' cones.
  Eigen::AlignedBox3d bounds;
  // The maximum standard deviation of the colours (sRGB, all channels together) at a point over the
  // views that see it; points above it are carved away (space carving, Kutulakos and Seitz 2000).
  // Carving opens concavities that no silhouette shows, but needs textured surfaces, even light and
  // accurate cameras; it is skipped where it would erode the masked object. 0: masks (and depths,
  // where given) alone. 0.1 is a reasonable start.
  double color_tolerance = 0.0;

  bool IsValid(std::string* error) const;
};

// Throws core::Error, naming the view, for a view without pixels, focal length or mask, for images
// whose size is not its camera's, or for values that are not finite. Colour may be missing.
void RequireValid(const std::vector<ObservedView>& views);

// Returns the intersection of all masks' cones and, where a view has depths, of the space not in
// front of them: an outer bound of the object, and the initial shape of a fit. A view does not
// constrain points beyond a border that its mask touches. Components of less than a hundredth of
// the largest one's volume are removed. Closed, oriented, free of self-intersections, m. Throws
// core::Error where the intersection is empty (naming the views that CheckViewConsistency reports),
// for invalid views or fewer than two; core::Cancelled.
core::TriangleMesh VisualHull(const std::vector<ObservedView>& views,
                              const VisualHullOptions& options = {},
                              core::Progress* progress = nullptr);

// Returns the mesh without components of less than a hundredth of the largest one's volume. The
// mesh is closed.
core::TriangleMesh LargeComponents(const core::TriangleMesh& mesh);

// Returns the signed distance to the mask's outline, pixels, negative inside. (H x W x 1), at pixel
// centres.
core::FloatImage MaskDistance(const core::FloatImage& opacity);

// A view's mask as a field in space.
class SilhouetteCone {
 public:
  explicit SilhouetteCone(const ObservedView& view);

  // Returns the approximate signed distance to the cone of the mask, m, positive outside; the
  // lowest double where the view gives no information. Where the view has a depth, at least the
  // point's distance in front of it.
  double At(const Eigen::Vector3d& point) const;

 private:
  double Bilinear(double x, double y) const;
  double InFront(double x, double y, double z) const;

  core::Camera camera_;
  Eigen::Isometry3d camera_from_world_;
  core::FloatImage distance_;
  core::FloatImage depth_;
};

// Returns an AABB that contains everything any mask shows: centred at the point nearest to the rays
// through the masks' centres, as large as the masks' greatest reach from there, m.
Eigen::AlignedBox3d MaskBounds(const std::vector<ObservedView>& views);

// Returns the approximate signed distance to the visual hull, m; exact at the surface and in sign.
geometry::ScalarGrid VisualHullField(const std::vector<ObservedView>& views,
                                     const Eigen::AlignedBox3d& box, int cells);

// Returns an AABB of the masked object. Throws the exceptions of VisualHull.
Eigen::AlignedBox3d HullBounds(const std::vector<ObservedView>& views);

}  // namespace simwright::asset_lift
