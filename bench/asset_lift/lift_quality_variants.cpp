#include "lift_quality_variants.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "asset_lift/camera/view_frame.h"
#include "asset_lift/mesh_fit/shape_fit.h"
#include "asset_lift/priors/initial_shape.h"
#include "core/error.h"
#include "core/progress.h"
#include "texture/photo_projection.h"

namespace simwright::bench {
namespace {

asset_lift::LiftOptions OptionsOf(const std::string& variant, const MadePhoto& made,
                                  const VariantSettings& settings) {
  asset_lift::LiftOptions options;
  options.seed = settings.seed;
  options.mask = made.matte.alpha;
  const double longer = std::max(made.photo.width, made.photo.height);
  options.field_of_view = 2.0 * std::atan(0.5 * longer / made.focal);
  if (settings.true_elevation) {
    // The camera looks at the box's middle; the reconstruction needs the line of sight to the
    // mask's.
    const double middle = 0.5 * (made.matte.top + made.matte.bottom) - made.camera.cy;
    options.elevation = made.elevation + std::atan(middle / made.focal);
  }
  if (variant == "fast" || variant == "guess") {
    options.effort = asset_lift::LiftEffort::kFast;
  } else if (variant == "stage1" || variant == "both") {
    options.effort = asset_lift::LiftEffort::kFull;
  } else {
    options.effort = asset_lift::LiftEffort::kOutline;
  }
  if (variant == "guess") options.fit.field_stage = options.fit.mesh_stage = false;
  if (variant == "stage1") options.fit.mesh_stage = false;
  return options;
}

// Returns the plane across the line of sight through the frame's middle: the back mirrors the
// front.
Eigen::Hyperplane<double, 3> PlaneAcross(const asset_lift::ViewFrame& frame) {
  return {frame.Direction(), frame.PointAt(Eigen::Vector3d::Zero())};
}

void Paint(const core::TriangleMesh& shape, const asset_lift::ViewFrame& frame,
           const std::vector<Eigen::Vector3f>& hidden, asset_lift::LiftedMesh* lifted) {
  lifted->mesh = hidden.empty()
                     ? texture::ProjectPhoto(shape, lifted->camera, lifted->photo,
                                             lifted->matte.alpha, PlaneAcross(frame))
                     : texture::ProjectPhotos(
                           shape, {{lifted->camera, lifted->photo, lifted->matte.alpha}}, hidden);
}

void MakeEllipsoid(asset_lift::LiftedMesh* lifted) {
  const asset_lift::ViewFrame frame = asset_lift::FrameAround(lifted->matte, lifted->camera, 1.0);
  const asset_lift::Matte& matte = lifted->matte;
  const Eigen::Vector2d half(matte.right - matte.left, matte.bottom - matte.top);
  Paint(asset_lift::InitialEllipsoid(frame, 0.5 * half / frame.half).surface, frame, {}, lifted);
  lifted->start = "an ellipsoid";
}

// Fits without priors. LiftPhoto would return the inflated silhouette unchanged; here the stages
// run anyway, to show the contribution of the priors.
void FitWithoutPrior(const CatalogueObject& object, const asset_lift::LiftOptions& options,
                     asset_lift::LiftedMesh* lifted) {
  const asset_lift::ViewFrame frame = asset_lift::FrameAround(lifted->matte, lifted->camera, 1.0);
  const asset_lift::InflatedShape outline =
      asset_lift::InflateOutline(lifted->matte, lifted->camera, object.prior, options.inflation);
  asset_lift::ShapeFitOptions stages = options.fit;
  stages.field.seed = stages.mesh.seed = options.seed;
  core::Progress silent;
  const asset_lift::ShapeFit fit = asset_lift::FitShape(
      {asset_lift::CropView(lifted->photo, lifted->matte.alpha, frame, options.fit_side)},
      asset_lift::InitialShapeFrom(outline.mesh), nullptr, nullptr, stages, &silent);
  Paint(fit.mesh, frame, fit.colors, lifted);
}

}  // namespace

const std::vector<std::string>& LiftVariants() {
  static const std::vector<std::string> variants = {"ellipsoid", "outline", "guess",   "fast",
                                                    "stage1",    "both",    "no_prior"};
  return variants;
}

VariantResult LiftVariant(const std::string& variant, const CatalogueObject& object,
                          const MadePhoto& made, const VariantSettings& settings) {
  const auto& known = LiftVariants();
  if (std::find(known.begin(), known.end(), variant) == known.end()) {
    throw core::Error("there is no such variant", variant);
  }
  const asset_lift::LiftOptions options = OptionsOf(variant, made, settings);
  const bool learned = options.effort != asset_lift::LiftEffort::kOutline;
  const auto start = std::chrono::steady_clock::now();
  core::Progress silent;
  asset_lift::LiftedMesh lifted =
      asset_lift::LiftPhoto(made.photo, object.prior,
                            learned ? settings.priors : asset_lift::LiftPriors(), options, &silent);
  if (variant == "ellipsoid") MakeEllipsoid(&lifted);
  if (variant == "no_prior") FitWithoutPrior(object, options, &lifted);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return {std::move(lifted.mesh), lifted.camera, lifted.elevation.elevation, seconds.count(),
          lifted.start};
}

}  // namespace simwright::bench
