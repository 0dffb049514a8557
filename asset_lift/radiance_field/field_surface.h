#pragma once

#include <string>
#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/radiance_field/field_fit.h"
#include "asset_lift/radiance_field/field_fit_options.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct FieldSurface {
  // Closed, 2-manifold, facing outward, without self-intersections; never empty. World, m.
  core::TriangleMesh mesh;
  std::vector<Eigen::Vector3f> colors;  // (N x 3) SurfaceColors at the vertices: sRGB in [0, 1]
  double level = 0.0;                   // density of the isosurface, 1/m
  double iou = 0.0;                     // silhouette IoU with the masks, mean over the views
  core::Findings findings;              // "field-surface-faint", "field-surface-silhouette"
};

// Returns the isosurface of a fitted field at the density whose silhouettes agree best with the
// masks of `views` (at least one). Each silhouette is rendered from the view's camera. The function
// keeps the largest component and those that raise the agreement (`component_gain`), and fills
// enclosed cavities, which no mask can show. If the field is below every candidate level, the
// surface is extracted at a fraction of the field's maximum density; if that maximum is zero, the
// surface is the intersection of the cones of the masks. Throws core::Error for invalid views or
// options, and core::Cancelled after Ctrl-C.
FieldSurface ExtractSurface(const FieldFit& fit, const std::vector<ObservedView>& views,
                            const FieldSurfaceOptions& options = {});

// Returns the colours (N x 3; sRGB in [0, 1]) that the field shows at `points` (N, world, m) on its
// surface. At each point the field is rendered along the normal, from `depth` (m) outside to
// `depth` inside, with occlusion. The ray of a point slightly off the fitted surface therefore
// still meets the surface, and the field's interior, which no view has shown, stays hidden.
// `normals` (N, world) are unit vectors pointing outward. Throws core::Error unless there is one
// normal per point.
std::vector<Eigen::Vector3f> SurfaceColors(const RadianceField& field,
                                           const std::vector<Eigen::Vector3d>& points,
                                           const std::vector<Eigen::Vector3d>& normals,
                                           double depth);

}  // namespace simwright::asset_lift
