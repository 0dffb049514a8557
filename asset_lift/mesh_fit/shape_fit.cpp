#include "asset_lift/mesh_fit/shape_fit.h"

#include <algorithm>

#include "asset_lift/mesh_fit/mesh_fit.h"
#include "asset_lift/radiance_field/field_fit.h"
#include "asset_lift/radiance_field/field_surface.h"
#include "core/log.h"

namespace simwright::asset_lift {
namespace {

// The bias at which a point is certainly solid, or empty.
constexpr double kCertainBias = 10.0;

// Sets the field's cube to the initial shape's, enlarged about its centre.
void PlaceField(const InitialShape& guess, double scale, RadianceFieldOptions* field) {
  field->center = guess.box.center();
  field->half_side = 0.5 * 1.3 * guess.box.sizes().maxCoeff();
  const auto odds = guess.odds;
  field->density_bias = [odds, scale](const Eigen::Vector3d& point) {
    return std::clamp(scale * odds(point), -kCertainBias, kCertainBias);
  };
}

void Append(const core::Findings& from, core::Findings* to) {
  to->insert(to->end(), from.begin(), from.end());
}

}  // namespace

ShapeFitOptions::ShapeFitOptions() {
  // The result of stage 1 needs no coarse rounds.
  mesh.rounds = 2;
  mesh.steps_per_round = 60;
  mesh.first_edge_ratio = 0.03;
  mesh.last_edge_ratio = 0.02;
}

ShapeFit FitShape(const std::vector<ObservedView>& views, const InitialShape& guess,
                  ImageObjective* field_objective, ImageObjective* mesh_objective,
                  const ShapeFitOptions& options, core::Progress* progress) {
  ShapeFit fit;
  fit.mesh = guess.surface;
  if (options.field_stage) {
    FieldFitOptions field = options.field;
    PlaceField(guess, options.initial_shape_weight, &field.field);
    const FieldFit fitted = FitField(views, field_objective, field, progress);
    FieldSurface surface = ExtractSurface(fitted, views, options.surface);
    Append(fitted.findings, &fit.findings);
    Append(surface.findings, &fit.findings);
    core::Log(core::LogLevel::kInfo, "asset_lift", "radiance field: colour error ",
              fitted.color_error, ", silhouette IoU ", surface.iou);
    fit.mesh = std::move(surface.mesh);
    fit.colors = std::move(surface.colors);
  }
  if (options.mesh_stage) {
    MeshFitResult refined = FitMesh(fit.mesh, views, mesh_objective, options.mesh, progress);
    Append(refined.findings, &fit.findings);
    core::Log(core::LogLevel::kInfo, "asset_lift", "mesh: ", refined.mesh.triangles.size(),
              " faces after ", refined.steps, " steps");
    fit.mesh = std::move(refined.mesh);
    fit.colors = std::move(refined.vertex_colors);
  }
  return fit;
}

}  // namespace simwright::asset_lift
