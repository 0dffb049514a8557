#pragma once

#include <string>
#include <vector>

#include "asset_lift/field_fit.h"
#include "asset_lift/observed_view.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct FieldSurfaceOptions {
  int resolution = 96;  // cells a side of the cube
  // Levels tried, as the density's 1/m times the cube's half side: from a haze to a solid.
  std::vector<double> levels = {0.5, 1.0, 2.0, 4.0, 7.0, 10.0, 15.0, 25.0, 40.0, 80.0};
  // Pixels of a view's longer side at which silhouettes are compared.
  int silhouette_side = 128;
  // Below this agreement the surface is returned with a finding.
  double good_iou = 0.8;
  // A component beside the largest stays where the agreement would lose more than this without it.
  double component_gain = 0.005;

  bool IsValid(std::string* error) const;
};

struct FieldSurface {
  // Closed, 2-manifold, facing outward, without self-intersections; never empty. World, m.
  core::TriangleMesh mesh;
  std::vector<Eigen::Vector3f> colors;  // (N x 3) sRGB of the field at the vertices
  double level = 0.0;                   // density, 1/m
  double iou = 0.0;         // of the silhouettes with the masks, the mean over the views
  core::Findings findings;  // "field-surface-faint", "field-surface-silhouette"
};

// The surface of a fitted field at the density at which its silhouettes agree best with the masks
// of `views` (at least one), each silhouette drawn from the view's camera. Of the surface's
// components the largest is kept, and those without which the agreement suffers; cavities that
// no mask can see are filled. A field that is empty at each level tried is cut at a share of its
// own largest density; if even this is zero, where the masks' cones meet stands in for it.
// Throws core::Error for views or options that are not valid; core::Cancelled.
FieldSurface ExtractSurface(const FieldFit& fit, const std::vector<ObservedView>& views,
                            const FieldSurfaceOptions& options = {});

// Colours (sRGB) of the field as a surface shows them: at each point the field is looked at along
// the normal, from `depth` (m) outside to `depth` within, and what is in front covers what is
// behind. So a point that is a little off the fitted surface still meets it, and the field's
// inside, which no view has ever shown, stays hidden. `normals` are unit, outward. (N x 3).
std::vector<Eigen::Vector3f> SurfaceColors(const RadianceField& field,
                                           const std::vector<Eigen::Vector3d>& points,
                                           const std::vector<Eigen::Vector3d>& normals,
                                           double depth);

}  // namespace simwright::asset_lift
