#pragma once

#include <string>
#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/radiance_field/field_fit.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct FieldSurfaceOptions {
  int resolution = 96;  // cells per side of the cube
  // The candidate density levels, in 1/m times the cube's half side, from a haze to a solid.
  std::vector<double> levels = {0.5, 1.0, 2.0, 4.0, 7.0, 10.0, 15.0, 25.0, 40.0, 80.0};
  // Pixels of a view's longer side at which silhouettes are compared.
  int silhouette_side = 128;
  // The silhouette IoU below which the surface is returned with a finding.
  double good_iou = 0.8;
  // A component other than the largest is kept if removing it lowers the silhouette IoU by more
  // than this.
  double component_gain = 0.005;

  bool IsValid(std::string* error) const;
};

struct FieldSurface {
  // Closed, 2-manifold, facing outward, without self-intersections; never empty. World, m.
  core::TriangleMesh mesh;
  std::vector<Eigen::Vector3f> colors;  // (N x 3) sRGB of the field at the vertices
  double level = 0.0;                   // density, 1/m
  double iou = 0.0;                     // silhouette IoU with the masks, mean over the views
  core::Findings findings;              // "field-surface-faint", "field-surface-silhouette"
};

// Returns the isosurface of a fitted field at the density whose silhouettes agree best with the
// masks of `views` (at least one). Each silhouette is rendered from the view's camera. The largest
// component is kept, and so are components without which the agreement drops; cavities that no mask
// can see are filled. If the field is empty at every candidate level, the surface is extracted at a
// fraction of the field's maximum density; if that is zero too, the intersection of the masks'
// cones replaces it. Throws core::Error for invalid views or options; core::Cancelled.
FieldSurface ExtractSurface(const FieldFit& fit, const std::vector<ObservedView>& views,
                            const FieldSurfaceOptions& options = {});

// Returns the field's colours (sRGB) as a surface shows them, (N x 3). At each point the field is
// rendered along the normal, from `depth` (m) outside to `depth` inside, with occlusion. A point
// slightly off the fitted surface therefore still meets it, and the field's interior, which no view
// has shown, stays hidden. `normals` are unit vectors pointing outward.
std::vector<Eigen::Vector3f> SurfaceColors(const RadianceField& field,
                                           const std::vector<Eigen::Vector3d>& points,
                                           const std::vector<Eigen::Vector3d>& normals,
                                           double depth);

}  // namespace simwright::asset_lift
