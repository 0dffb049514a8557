#include "asset_lift/lift.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/mesh_fit/shape_fit.h"
#include "asset_lift/priors/initial_shape.h"
#include "asset_lift/priors/score_distillation.h"
#include "asset_lift/priors/shape_example.h"
#include "asset_lift/priors/shape_prior.h"
#include "asset_lift/priors/view_prior.h"
#include "core/error.h"
#include "core/log.h"
#include "texture/delighting.h"
#include "texture/photo_projection.h"

namespace simwright::asset_lift {
namespace {

core::Image ScaledDown(const core::Image& photo, int max_side) {
  const int longer = std::max(photo.width, photo.height);
  if (longer <= max_side) return photo;
  const double scale = static_cast<double>(max_side) / longer;
  return core::Resize(photo, std::max(1, static_cast<int>(std::lround(photo.width * scale))),
                      std::max(1, static_cast<int>(std::lround(photo.height * scale))));
}

// Returns the focal length in pixels of `photo` and writes its source to `sentence`.
double FocalLength(const core::Image& photo, const LiftOptions& options, std::string* sentence) {
  const double longer = std::max(photo.width, photo.height);
  double fov = options.field_of_view;
  *sentence = "given";
  if (fov <= 0.0 && options.focal_35mm > 0.0) {
    fov = 2.0 * std::atan(18.0 / options.focal_35mm);  // half of 36 mm over the focal length
    *sentence = "from EXIF";
  }
  if (fov <= 0.0) {
    fov = options.default_field_of_view;
    *sentence = "assumed";
  }
  if (!(fov > 0.02 && fov < 2.8)) {
    throw core::Error("the field of view must be between 1 and 160 degrees", "", "correct --fov");
  }
  char text[64];
  std::snprintf(text, sizeof(text), "field of view %.0f degrees, %s", fov * 180.0 / M_PI,
                sentence->c_str());
  *sentence = text;
  return 0.5 * longer / std::tan(0.5 * fov);
}

// Enlarges the matte of photos under 200 pixels smoothly, because their silhouettes are staircases.
Matte Enlarged(const Matte& matte, int factor) {
  if (factor == 1) return matte;
  Matte larger = matte;
  larger.alpha = core::Resize(matte.alpha, matte.alpha.width * factor, matte.alpha.height * factor);
  larger.left *= factor;
  larger.top *= factor;
  larger.right *= factor;
  larger.bottom *= factor;
  return larger;
}

// Pads the image where the object touches its border, so that the shape can continue beyond it.
// Returns the share of the border that the object touches.
double PadWhereCutOff(core::Image* photo, Matte* matte) {
  const int w = photo->width, h = photo->height;
  int touched = 0;
  for (int x = 0; x < w; ++x) {
    touched += (matte->alpha.At(x, 0)[0] > 127) + (matte->alpha.At(x, h - 1)[0] > 127);
  }
  for (int y = 0; y < h; ++y) {
    touched += (matte->alpha.At(0, y)[0] > 127) + (matte->alpha.At(w - 1, y)[0] > 127);
  }
  if (touched == 0) return 0.0;
  const int pad = std::max(w, h) / 8;
  core::Image wider(w + 2 * pad, h + 2 * pad, photo->channels);
  core::Image alpha(w + 2 * pad, h + 2 * pad, 1);
  for (int y = 0; y < wider.height; ++y) {
    for (int x = 0; x < wider.width; ++x) {
      const int fx = std::clamp(x - pad, 0, w - 1), fy = std::clamp(y - pad, 0, h - 1);
      std::copy_n(photo->At(fx, fy), photo->channels, wider.At(x, y));
      if (fx == x - pad && fy == y - pad) alpha.At(x, y)[0] = matte->alpha.At(fx, fy)[0];
    }
  }
  matte->area *= static_cast<double>(w) * h / (static_cast<double>(alpha.width) * alpha.height);
  *photo = std::move(wider);
  matte->alpha = std::move(alpha);
  matte->left += pad;
  matte->right += pad;
  matte->top += pad;
  matte->bottom += pad;
  return touched / (2.0 * (w + h));
}

// Returns the photo that becomes the texture: as it is, or without its shading.
core::Image TexturePhoto(const core::TriangleMesh& mesh, const LiftOptions& options,
                         LiftedMesh* lifted) {
  if (!options.delight) return lifted->photo;
  texture::DelightingOptions delighting;
  delighting.seed = options.seed;
  texture::DelitPhoto delit =
      texture::DelightPhoto(mesh, {lifted->camera, lifted->photo, lifted->matte.alpha}, delighting);
  char text[160];
  std::snprintf(text, sizeof(text),
                "the photo's shading, of a contrast of %.2g, was divided out, and highlights on "
                "%.1f %% of the object were replaced",
                delit.contrast, 100.0 * delit.highlights);
  lifted->findings.push_back({"delighting", core::Severity::kInfo, "", text, delit.contrast});
  return std::move(delit.albedo);
}

// Textures the inflated silhouette from the photo and its mirror image.
void FinishOutline(const InflatedShape& shape, const LiftOptions& options,
                   const texture::PhotoProjectionOptions& projection, LiftedMesh* lifted) {
  lifted->start = std::string("the silhouette, ") + Name(shape.form);
  lifted->silhouette_iou = shape.silhouette_iou;
  const core::Image photo = TexturePhoto(shape.mesh, options, lifted);
  lifted->mesh = texture::ProjectPhoto(shape.mesh, lifted->camera, photo, lifted->matte.alpha,
                                       shape.mirror, projection);
}

// Returns true if the silhouette determines the whole surface, as for a solid of revolution. The
// silhouette of a box or of an object lying flat only resembles one.
bool IsSolidOfRevolution(ShapeForm form, const CategoryPrior& prior) {
  if (form == ShapeForm::kInflated || prior.angular) return false;
  return form == ShapeForm::kUpright || !prior.flat;
}

// Returns one colour per vertex for the regions that the photo does not show.
std::vector<Eigen::Vector3f> HiddenColors(const ShapeFit& fit,
                                          const std::optional<ShapePrediction>& prediction) {
  if (!prediction) return fit.colors;
  std::vector<Eigen::Vector3f> colors;
  for (const Eigen::Vector3d& v : fit.mesh.vertices) colors.push_back(prediction->Color(v));
  return colors;
}

// Computes the initial shape, runs the fit's stages and textures the result.
void FitAndPaint(const InflatedShape& outline, const LiftPriors& priors, const LiftOptions& options,
                 const texture::PhotoProjectionOptions& projection, core::Progress* progress,
                 LiftedMesh* lifted) {
  const ViewFrame frame = FrameAround(lifted->matte, lifted->camera, 1.0);
  std::optional<ShapePrediction> prediction;
  if (priors.shape != nullptr) {
    prediction = priors.shape->Predict(CropImage(lifted->photo, lifted->matte.alpha, frame), frame);
  }
  const bool learned = prediction && !prediction->box.isEmpty();
  const InitialShape guess =
      learned ? WithMissingParts(InitialShapeFrom(*prediction), lifted->matte, lifted->camera)
              : InitialShapeFrom(outline.mesh);
  lifted->start =
      learned ? "the learned prior" : std::string("the silhouette, ") + Name(outline.form);
  const auto distillation = [&](double weight, const ScoreDistillationOptions& settings) {
    return priors.view != nullptr && weight > 0.0
               ? std::make_unique<ScoreDistillation>(priors.view, frame, lifted->photo,
                                                     lifted->matte.alpha, settings)
               : nullptr;
  };
  const std::unique_ptr<ScoreDistillation> in_field =
      distillation(options.fit.field.weights.objective, options.field_distillation);
  const std::unique_ptr<ScoreDistillation> in_mesh =
      distillation(options.fit.mesh.objective_weight, options.mesh_distillation);
  ShapeFitOptions stages = options.fit;
  stages.field_stage = stages.field_stage && options.effort == LiftEffort::kFull;
  stages.field.seed = stages.mesh.seed = options.seed;
  const ShapeFit fit =
      FitShape({CropView(lifted->photo, lifted->matte.alpha, frame, options.fit_side)}, guess,
               in_field.get(), in_mesh.get(), stages, progress);
  lifted->findings.insert(lifted->findings.end(), fit.findings.begin(), fit.findings.end());
  lifted->silhouette_iou = SilhouetteIou(fit.mesh, lifted->camera, lifted->matte);
  progress->Stage("texture");
  const std::vector<Eigen::Vector3f> hidden = HiddenColors(fit, prediction);
  const core::Image photo = TexturePhoto(fit.mesh, options, lifted);
  lifted->mesh =
      hidden.empty()
          ? texture::ProjectPhoto(fit.mesh, lifted->camera, photo, lifted->matte.alpha,
                                  outline.mirror, projection)
          : texture::ProjectPhotos(fit.mesh, {{lifted->camera, photo, lifted->matte.alpha}}, hidden,
                                   projection);
}

void AddFinding(const std::string& code, const std::string& sentence, double figure,
                LiftedMesh* lifted) {
  core::Log(core::LogLevel::kInfo, "asset_lift", sentence);
  lifted->findings.push_back({code, core::Severity::kInfo, "", sentence, figure});
}

// Scales the photo, segments the object and pads the image. Returns the focal length in pixels of
// the resulting photo.
double CutOut(const core::Image& photo, const CategoryPrior& prior, const LiftOptions& options,
              LiftedMesh* lifted) {
  lifted->photo = ScaledDown(photo, options.max_side);
  SegmentationOptions segmentation = options.segmentation;
  segmentation.seed = options.seed;
  segmentation.round_object = prior.round;
  lifted->matte = SegmentObject(lifted->photo, options.mask, segmentation);
  const int longer = std::max(lifted->photo.width, lifted->photo.height);
  std::string camera_sentence;
  double focal = FocalLength(lifted->photo, options, &camera_sentence);
  if (const int factor = longer < 200 ? 3 : 1; factor > 1) {
    lifted->photo =
        core::Resize(lifted->photo, lifted->photo.width * factor, lifted->photo.height * factor);
    lifted->matte = Enlarged(lifted->matte, factor);
    focal *= factor;
  }
  AddFinding("segmentation", "the object was cut out by " + lifted->matte.method,
             lifted->matte.area, lifted);
  AddFinding("camera", camera_sentence, focal, lifted);
  if (const double touched = PadWhereCutOff(&lifted->photo, &lifted->matte); touched > 0.0) {
    lifted->findings.push_back(
        {"border", core::Severity::kWarning, "",
         "the object touches the photo's border: the cut-off part is extrapolated", touched});
  }
  return focal;
}

// Returns the shape prior's estimate from the crop, which does not depend on the assumed elevation.
ElevationEstimate LearnedElevation(const ShapePrior& shape, const LiftedMesh& lifted,
                                   double focal) {
  const ViewFrame frame =
      FrameAround(lifted.matte, PhotoCamera(lifted.matte, focal, lifted.elevation.elevation), 1.0);
  const ShapePrediction prediction =
      shape.Predict(CropImage(lifted.photo, lifted.matte.alpha, frame), frame);
  // The network predicts the mean absolute error of a Laplace distribution.
  ElevationEstimate estimate{prediction.elevation, M_SQRT2 * prediction.elevation_deviation, ""};
  char text[80];
  std::snprintf(text, sizeof(text), "%.0f +- %.0f from the learned prior",
                estimate.elevation * 180.0 / M_PI, estimate.deviation * 180.0 / M_PI);
  estimate.sentence = text;
  return estimate;
}

// Returns the focal length at which the walls of a solid of revolution are straight, where the
// assumed one makes them taper slightly; else the assumed one.
double WithStraightWalls(double focal, const LiftOptions& options, LiftedMesh* lifted) {
  if (options.field_of_view > 0.0 || options.focal_35mm > 0.0) return focal;
  const double elevation = std::clamp(lifted->elevation.elevation, 0.03, 1.5);
  const std::optional<double> straight = StraightWallFocal(lifted->matte, focal, elevation);
  if (!straight) return focal;
  const double longer = std::max(lifted->photo.width, lifted->photo.height);
  const double degrees = 2.0 * std::atan(0.5 * longer / *straight) * 180.0 / M_PI;
  AddFinding("camera",
             "field of view " + std::to_string(std::lround(degrees)) +
                 " degrees taken instead: there its walls are straight",
             *straight, lifted);
  return *straight;
}

void PlaceCamera(double focal, const CategoryPrior& prior, const ShapePrior* shape,
                 const LiftOptions& options, LiftedMesh* lifted) {
  lifted->elevation = EstimateElevation(lifted->matte, prior);
  if (options.elevation >= 0.0) {
    lifted->elevation = {options.elevation, 0.0, "given"};
  } else if (prior.revolved && !prior.round) {
    lifted->elevation = RefineElevation(lifted->matte, focal, lifted->elevation);
  } else if (shape != nullptr) {
    lifted->elevation = Combined(lifted->elevation, LearnedElevation(*shape, *lifted, focal));
  }
  if (prior.revolved && !prior.round) focal = WithStraightWalls(focal, options, lifted);
  // Horizontal sight lines never cross the planes of a solid of revolution's discs.
  const double elevation = std::clamp(lifted->elevation.elevation, 0.03, 1.5);
  lifted->camera = PhotoCamera(lifted->matte, focal, elevation);
  AddFinding("elevation", "elevation " + lifted->elevation.sentence, elevation, lifted);
}

}  // namespace

// Leaves out score distillation: with our small view prior even a weight of 0.003 makes the Chamfer
// distance worse (docs/experiments/lift.md). The guidance and the times serve those who set
// weights of their own. One photo does not constrain the hidden side, so the initial shape has more
// weight than with many views.
LiftOptions::LiftOptions() {
  fit.initial_shape_weight = 6.0;
  fit.field.weights.objective = 0.0;
  fit.mesh.objective_weight = 0.0;
  field_distillation.guidance = mesh_distillation.guidance = 1.0;
  mesh_distillation.t_min_first = mesh_distillation.t_min_last = 0.02;
  mesh_distillation.t_max_first = mesh_distillation.t_max_last = 0.3;
}

void ConfigureForPublishedViewPrior(LiftOptions* options) {
  options->fit.initial_shape_weight = ShapeFitOptions().initial_shape_weight;
  options->fit.field.weights.objective = FieldLossWeights().objective;
  options->fit.mesh.objective_weight = MeshFitOptions().objective_weight;
  options->field_distillation = options->mesh_distillation = ScoreDistillationOptions();
  options->mesh_distillation.t_min_first = options->mesh_distillation.t_min_last = 0.02;
  options->mesh_distillation.t_max_first = options->mesh_distillation.t_max_last = 0.5;
}

LiftedMesh LiftPhoto(const core::Image& photo, const CategoryPrior& prior, const LiftPriors& priors,
                     const LiftOptions& options, core::Progress* progress) {
  LiftedMesh lifted;
  progress->Stage("segmentation");
  const double focal = CutOut(photo, prior, options, &lifted);
  PlaceCamera(focal, prior, priors.shape.get(), options, &lifted);
  progress->Stage("outline");
  const InflatedShape outline =
      InflateOutline(lifted.matte, lifted.camera, prior, options.inflation);
  lifted.form = outline.form;
  core::Log(core::LogLevel::kInfo, "asset_lift", "outline ", Name(outline.form),
            ", silhouette IoU ", outline.silhouette_iou);
  texture::PhotoProjectionOptions projection;
  projection.texture_size = options.texture_size;
  const bool revolved = IsSolidOfRevolution(outline.form, prior);
  const bool nothing_learned = priors.shape == nullptr && priors.view == nullptr;
  if (options.effort == LiftEffort::kOutline || revolved || nothing_learned) {
    progress->Stage("texture");
    FinishOutline(outline, options, projection, &lifted);
  } else {
    FitAndPaint(outline, priors, options, projection, progress, &lifted);
  }
  progress->Finish();
  AddFinding("shape", "the shape began as " + lifted.start, lifted.silhouette_iou, &lifted);
  return lifted;
}

}  // namespace simwright::asset_lift
