#include "asset_lift/radiance_field/field_fit.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/radiance_field/field_adam.h"
#include "asset_lift/radiance_field/field_carving.h"
#include "asset_lift/radiance_field/field_losses.h"
#include "asset_lift/radiance_field/field_targets.h"
#include "core/error.h"
#include "core/random.h"

namespace simwright::asset_lift {
namespace {

constexpr int kSnapshotInterval = 10;  // steps
constexpr int kFieldFitMaxRollbacks = 3;

int TotalSteps(const FieldFitOptions& options) {
  int steps = 0;
  for (const FieldFitStage& stage : options.stages) steps += stage.steps;
  return steps;
}

// Converts the rays of a whole camera to an image.
ObjectImage ToPicture(const core::Camera& camera, const PixelRays& pixels,
                      const RayRenderings<float>& seen) {
  ObjectImage picture;
  picture.color = core::FloatImage(camera.width, camera.height, 3);
  picture.opacity = core::FloatImage(camera.width, camera.height, 1);
  for (std::size_t r = 0; r < pixels.rays.size(); ++r) {
    for (int c = 0; c < 3; ++c) {
      picture.color.values[3 * pixels.pixel[r] + c] = seen.color[3 * r + c];
    }
    picture.opacity.values[pixels.pixel[r]] = seen.opacity[r];
  }
  return picture;
}

void RequireRenderable(const core::Camera& camera) {
  if (camera.width < 1 || camera.height < 1 || !(camera.fx > 0.0) || !(camera.fy > 0.0) ||
      !std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy) ||
      !camera.world_from_camera.matrix().allFinite()) {
    throw core::Error("a camera has no pixels, no focal length, or is not finite", "field");
  }
}

class Fitter {
 public:
  Fitter(const std::vector<ObservedView>& views, ImageObjective* objective,
         const FieldFitOptions& options)
      : options_(options),
        objective_(objective),
        fit_{RadianceField(options.field, options.seed), {}, {}, 0.0, {}},
        view_renderer_(WithNormals(options)),
        picture_renderer_(WithNormals(options)),
        rng_(core::StreamRng(options.seed, 1)),
        total_(TotalSteps(options)),
        good_(fit_.field.parameters()),
        candidate_(good_) {
    for (const ObservedView& view : views) views_.push_back(ScaledView(view, LastSide()));
    if (options.carve) Carve();
  }

  FieldFit Run(core::Progress* progress) {
    for (int i = 0; i < 2; ++i) UpdateOccupancy();
    for (const FieldFitStage& stage : options_.stages) {
      std::vector<ObservedView> scaled;
      for (const ObservedView& view : views_) scaled.push_back(ScaledView(view, stage.view_side));
      PatchSampler deck(std::move(scaled), !options_.carve);
      for (int s = 0; s < stage.steps; ++s) {
        Step(&deck);
        if (progress != nullptr) progress->Advance();
        core::CheckCancelled();
        if (rollbacks_ == kFieldFitMaxRollbacks) return Finished();
      }
    }
    return Finished();
  }

 private:
  static VolumeRenderOptions WithNormals(const FieldFitOptions& options) {
    VolumeRenderOptions render = options.render;
    render.normals = options.weights.UseNormals();
    return render;
  }

  int LastSide() const {
    int side = 0;
    for (const FieldFitStage& stage : options_.stages) side = std::max(side, stage.view_side);
    return side;
  }

  void Carve() {
    Carving carving = CarveByMasks(views_, options_.field.center, options_.field.half_side,
                                   options_.carve_margin);
    fit_.findings = carving.findings;
    fit_.occupancy.Restrict(carving.allowed);
    for (auto i = carving.contradicting.rbegin(); i != carving.contradicting.rend(); ++i) {
      views_.erase(views_.begin() + *i);
    }
  }

  double Done() const { return static_cast<double>(fit_.losses.size()) / total_; }

  void UpdateOccupancy() { fit_.occupancy.Update(fit_.field, options_.occupancy, rng_()); }

  void Step(PatchSampler* deck) {
    const double rate = options_.rate * std::pow(options_.last_rate / options_.rate, Done()) *
                        std::pow(0.5, rollbacks_);
    double loss = ObservationGradient(deck);
    if (std::isfinite(loss)) {
      if (objective_ != nullptr) {
        loss += ObjectiveGradient();
      } else if (options_.shape_picture_side > 0) {
        loss += ShapeGradient();
      }
    }
    const bool stepped = std::isfinite(loss) && adam_.Step(rate, &fit_.field, &gradient_);
    fit_.losses.push_back(loss);
    const int steps = static_cast<int>(fit_.losses.size());
    if (!stepped) {
      RollBack();
    } else if (steps % kSnapshotInterval == 0) {
      // The steps since the last snapshot have shown that the candidate is finite.
      good_ = candidate_;
      candidate_ = fit_.field.parameters();
    }
    if (steps % options_.occupancy_interval == 0) UpdateOccupancy();
  }

  void RollBack() {
    ++rollbacks_;
    fit_.field.parameters() = good_;
    candidate_ = good_;
    adam_ = FieldAdam();
    gradient_ = FieldGradient<float>();
    if (rollbacks_ < kFieldFitMaxRollbacks) return;
    fit_.findings.push_back({"field-fit-unstable", core::Severity::kWarning, "radiance field",
                             "the fit became non-finite three times and stopped at step " +
                                 std::to_string(fit_.losses.size()) + " of " +
                                 std::to_string(total_),
                             static_cast<double>(fit_.losses.size())});
  }

  double ObservationGradient(PatchSampler* deck) {
    deck->NextBatch(options_.rays_per_step, &rng_, &batch_);
    if (batch_.pixels.rays.empty()) return 0.0;
    view_renderer_.Render(fit_.field, fit_.occupancy, batch_.pixels.rays, rng_(), &seen_);
    of_seen_.Resize(batch_.pixels.rays.size());
    const Eigen::Vector3f background(static_cast<float>(core::Uniform(rng_)),
                                     static_cast<float>(core::Uniform(rng_)),
                                     static_cast<float>(core::Uniform(rng_)));
    double loss = AddObservationLoss(batch_, seen_, background, options_.field.half_side,
                                     options_.weights, &of_seen_);
    loss += AddShapeLoss(batch_.pixels, seen_, options_.weights, &of_seen_);
    double squares = 0.0;
    for (std::size_t i = 0; i < seen_.color.size(); ++i) {
      squares += std::pow(seen_.color[i] - batch_.color[i], 2);
    }
    errors_.push_back(squares / static_cast<double>(seen_.color.size()));
    if (std::isfinite(loss)) view_renderer_.AddGradient(fit_.field, of_seen_, &gradient_);
    return loss;
  }

  double ObjectiveGradient() {
    const core::Camera camera = objective_->NextCamera(Done(), &rng_);
    RequireRenderable(camera);
    pixels_.Clear();
    pixels_.AppendImage(camera);
    picture_renderer_.Render(fit_.field, fit_.occupancy, pixels_.rays, rng_(), &seen_);
    ObjectImage of_picture;
    double loss =
        options_.weights.objective *
        objective_->Evaluate(camera, ToPicture(camera, pixels_, seen_), Done(), &rng_, &of_picture);
    const std::size_t count = pixels_.rays.size();
    if (of_picture.color.values.size() != 3 * count || of_picture.opacity.values.size() != count) {
      throw core::Error("the objective's gradient has another size than its image", "field fit");
    }
    const auto weight = static_cast<float>(options_.weights.objective);
    of_seen_.Resize(count);
    for (std::size_t r = 0; r < count; ++r) {
      const std::size_t pixel = pixels_.pixel[r];
      for (int c = 0; c < 3; ++c) {
        of_seen_.color[3 * r + c] = weight * of_picture.color.values[3 * pixel + c];
      }
      of_seen_.opacity[r] = weight * of_picture.opacity.values[pixel];
    }
    loss += AddShapeLoss(pixels_, seen_, options_.weights, &of_seen_);
    if (std::isfinite(loss)) picture_renderer_.AddGradient(fit_.field, of_seen_, &gradient_);
    return loss;
  }

  // Adds the shape losses of an image from a random direction, at the first view's distance from
  // the cube's centre.
  double ShapeGradient() {
    const core::Camera& like = views_[0].camera;
    const double distance = (like.position() - options_.field.center).norm();
    const double elevation = core::Uniform(rng_, -0.5, 1.2),
                 azimuth = core::Uniform(rng_, -M_PI, M_PI);
    const core::Camera camera =
        core::OrbitCamera(options_.field.center, std::max(distance, 1e-6), elevation, azimuth,
                          2.0 * std::atan(0.5 * like.height / like.fy), options_.shape_picture_side,
                          options_.shape_picture_side);
    pixels_.Clear();
    pixels_.AppendImage(camera);
    picture_renderer_.Render(fit_.field, fit_.occupancy, pixels_.rays, rng_(), &seen_);
    of_seen_.Resize(pixels_.rays.size());
    const double loss = AddShapeLoss(pixels_, seen_, options_.weights, &of_seen_);
    if (std::isfinite(loss)) picture_renderer_.AddGradient(fit_.field, of_seen_, &gradient_);
    return loss;
  }

  FieldFit Finished() {
    for (int i = 0; i < 2; ++i) UpdateOccupancy();
    const std::size_t last = std::min<std::size_t>(errors_.size(), 20);
    double sum = 0.0;
    for (std::size_t i = errors_.size() - last; i < errors_.size(); ++i) sum += errors_[i];
    fit_.color_error = last > 0 ? std::sqrt(sum / static_cast<double>(last)) : 0.0;
    return std::move(fit_);
  }

  const FieldFitOptions& options_;
  ImageObjective* const objective_;
  FieldFit fit_;
  std::vector<ObservedView> views_;  // at the largest stage's size
  VolumeRenderer<float> view_renderer_, picture_renderer_;
  FieldAdam adam_;
  FieldGradient<float> gradient_;
  core::Rng rng_;
  const int total_;
  int rollbacks_ = 0;
  // Parameters that a later step confirmed, and parameters that no step has used yet.
  std::vector<float> good_, candidate_;
  std::vector<double> errors_;
  RayTargets batch_;
  PixelRays pixels_;
  RayRenderings<float> seen_, of_seen_;
};

}  // namespace

bool FieldFitOptions::IsValid(std::string* error) const {
  if (!field.IsValid(error) || !weights.IsValid(error) || !render.IsValid(error)) return false;
  const char* fault = nullptr;
  for (const FieldFitStage& stage : stages) {
    if (stage.steps < 0 || stage.view_side < 8) {
      fault = "a stage needs steps and a view_side of at least 8";
    }
  }
  if (TotalSteps(*this) < 1) fault = "a fit needs at least one step";
  if (rays_per_step < 1) fault = "rays_per_step must be at least 1";
  if (!(rate > 0.0 && rate < 1.0) || !(last_rate > 0.0 && last_rate < 1.0)) {
    fault = "the rates must be in (0, 1)";
  }
  if (occupancy_interval < 1) fault = "occupancy_interval must be at least 1";
  if (!(occupancy.decay >= 0.0 && occupancy.decay <= 1.0) || !(occupancy.threshold >= 0.0)) {
    fault = "the occupancy decay must be in [0, 1] and its threshold not negative";
  }
  if (!(carve_margin >= 0.0)) fault = "carve_margin must not be negative";
  if (fault != nullptr && error != nullptr) *error = fault;
  return fault == nullptr;
}

FieldFit FitField(const std::vector<ObservedView>& views, ImageObjective* objective,
                  const FieldFitOptions& options, core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "field fit");
  RequireValidViews(views);
  if (progress != nullptr) progress->Stage("radiance field", TotalSteps(options));
  return Fitter(views, objective, options).Run(progress);
}

ObjectImage RenderField(const FieldFit& fit, const core::Camera& camera,
                        core::FloatImage* normals) {
  RequireRenderable(camera);
  PixelRays pixels;
  pixels.AppendImage(camera);
  VolumeRenderOptions options;
  options.normals = normals != nullptr;
  VolumeRenderer<float> renderer(options);
  RayRenderings<float> seen;
  renderer.Render(fit.field, fit.occupancy, pixels.rays, 1, &seen);
  if (normals != nullptr) {
    *normals = core::FloatImage(camera.width, camera.height, 3);
    for (std::size_t r = 0; r < pixels.rays.size(); ++r) {
      for (int a = 0; a < 3; ++a) {
        normals->values[3 * pixels.pixel[r] + a] = seen.normal[3 * r + a];
      }
    }
  }
  return ToPicture(camera, pixels, seen);
}

}  // namespace simwright::asset_lift
