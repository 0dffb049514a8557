#include "twin/asset_retrieval.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>

#include "core/error.h"
#include "core/parallel.h"
#include "library_fit/cma_es.h"
#include "library_fit/fit_kinds.h"
#include "render/forward.h"
#include "render/scene.h"
#include "twin/observed_object.h"
#include "twin/pose_uncertainty.h"
#include "twin/table_pose.h"

namespace simwright::twin {
namespace {

constexpr float kInsideObject = 0.5f;      // opacity from which a pixel shows the object
constexpr double kPlausibleScale = 0.25;   // of the logarithm, of a scale that is known
constexpr double kAgreeingScale = 0.12;    // of the logarithm, from the common scale
constexpr double kRetrievalMove = 0.08;    // of the longest side: the search's step
constexpr double kRetrievalTurn = 0.2;     // rad
constexpr double kRetrievalScale = 0.06;   // of the logarithm
constexpr double kLeastScaleError = 0.01;  // of the logarithm
constexpr double kOneAssetError = 0.03;    // of the scale that a single asset gives
constexpr double kDisplayGamma = 2.2;

// An asset at a place, whose scale is 1 if it is the right one at the right scale.
struct PlacedAsset {
  int asset = -1;
  ScaledPose pose;
  AssetAgreement agreement;
};

// An asset, ready for rays.
struct RenderableAsset {
  explicit RenderableAsset(const TableAsset& of) {
    scene.Add(&of.visual);
    scene.Commit();
  }
  render::Scene scene;
};

Eigen::Vector3f LinearOfDisplay(const Eigen::Vector3f& display) {
  return display.array().max(0.0f).pow(static_cast<float>(kDisplayGamma));
}

AssetAgreement Compare(const render::Scene& scene, const ScaledPose& pose,
                       const ObservedObject& object, const core::Camera& photo_camera) {
  core::Camera camera = object.CropCamera(photo_camera);
  camera.world_from_camera = pose.pose.WorldFromObject().inverse() * photo_camera.world_from_camera;
  // A larger asset before the camera looks as the asset before a nearer one.
  camera.world_from_camera.translation() /= pose.scale;
  render::ForwardOptions options;
  options.shaded = true;
  options.lit = false;
  const render::ForwardBuffers seen = render::RenderForward(scene, camera, options);
  const library_fit::FitTarget& target = object.target;
  double shared = 0.0, joint = 0.0, power = 0.0;
  Eigen::Matrix4d products = 1e-6 * Eigen::Matrix4d::Identity();
  Eigen::Vector4d sums = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < seen.triangle.size(); ++i) {
    if (!target.Counts(i)) continue;
    const double theirs = target.opacity[i];
    joint += seen.triangle[i] < 0 ? theirs : 1.0;
    if (seen.triangle[i] < 0) continue;
    shared += theirs;
    if (theirs < kInsideObject) continue;
    const std::uint8_t* pixel = &seen.color.pixels[4 * i];
    const Eigen::Vector3f own =
        LinearOfDisplay(Eigen::Vector3f(pixel[0], pixel[1], pixel[2]) / 255.0f);
    const Eigen::Vector3f photo = LinearOfDisplay(target.color[i]);
    const Eigen::Vector4d light(1.0, seen.normal[i].x(), seen.normal[i].y(), seen.normal[i].z());
    products += own.squaredNorm() * light * light.transpose();
    sums += own.dot(photo) * light;
    power += photo.squaredNorm();
  }
  AssetAgreement agreement;
  agreement.iou = joint > 0.0 ? shared / joint : 0.0;
  if (power > 0.0) {
    // |p - r (l . w)|^2, summed, is |p|^2 - sums . w at the least squares' solution.
    const double rest = power - sums.dot(products.ldlt().solve(sums));
    agreement.color_error = std::sqrt(std::clamp(rest / power, 0.0, 1.0));
  }
  return agreement;
}

// The search for one object among the assets.
class AssetSearch {
 public:
  AssetSearch(const std::vector<TableAsset>& assets,
              const std::vector<std::unique_ptr<RenderableAsset>>& renderable,
              const ObservedObject& object, const core::Camera& camera,
              const RetrievalOptions& options)
      : assets_(assets),
        renderable_(renderable),
        object_(object),
        camera_(camera),
        options_(options) {}

  // Returns the asset that agrees best. `free_scale`: it may be larger or smaller.
  std::optional<PlacedAsset> Best(bool free_scale, core::Rng* rng) const {
    std::vector<PlacedAsset> starts = Starts(free_scale);
    std::optional<PlacedAsset> best;
    for (PlacedAsset& start : starts) {
      Refine(free_scale, rng, &start);
      if (!best || start.agreement.Loss() < best->agreement.Loss()) best = start;
    }
    return best;
  }

  // Moves, turns and, if `free_scale`, scales an asset until it agrees best.
  void Refine(bool free_scale, core::Rng* rng, PlacedAsset* placed) const {
    library_fit::CmaEsOptions options;
    options.generations = options_.generations;
    options.population = 10;
    const PlacedAsset start = *placed;
    const library_fit::CmaEsResult found = library_fit::MinimizeByCmaEs(
        [&](const Eigen::VectorXd& x) { return Moved(start, x).agreement.Loss(); },
        Eigen::VectorXd::Zero(free_scale ? 4 : 3), options, rng);
    const PlacedAsset moved = Moved(start, found.best);
    if (moved.agreement.Loss() < start.agreement.Loss()) *placed = moved;
  }

  void Evaluate(PlacedAsset* placed) const {
    placed->agreement = Compare(renderable_[static_cast<size_t>(placed->asset)]->scene,
                                placed->pose, object_, camera_);
  }

 private:
  std::vector<PlacedAsset> Starts(bool free_scale) const {
    const int count = static_cast<int>(assets_.size()) * options_.yaws;
    std::vector<PlacedAsset> all(static_cast<size_t>(count));
    core::ParallelFor(count, [&](int i) {
      PlacedAsset& placed = all[static_cast<size_t>(i)];
      const int asset = i / options_.yaws;
      const double yaw = 2.0 * M_PI * (i % options_.yaws) / options_.yaws;
      placed.pose =
          PoseFromBox(assets_[static_cast<size_t>(asset)].visual.mesh, yaw, camera_, object_.box);
      if (!free_scale && !object_.hidden &&
          std::abs(std::log(placed.pose.scale)) > kPlausibleScale) {
        return;
      }
      placed.asset = asset;
      if (!free_scale) placed.pose.scale = 1.0;
      Evaluate(&placed);
    });
    all.erase(std::remove_if(all.begin(), all.end(),
                             [](const PlacedAsset& placed) { return placed.asset < 0; }),
              all.end());
    std::stable_sort(all.begin(), all.end(), [](const PlacedAsset& a, const PlacedAsset& b) {
      return a.agreement.Loss() < b.agreement.Loss();
    });
    all.resize(std::min(all.size(), static_cast<size_t>(options_.refined)));
    return all;
  }

  PlacedAsset Moved(const PlacedAsset& start, const Eigen::VectorXd& x) const {
    PlacedAsset moved = start;
    const double side =
        start.pose.scale * assets_[static_cast<size_t>(start.asset)].size.maxCoeff();
    moved.pose.pose.x += kRetrievalMove * side * x[0];
    moved.pose.pose.y += 1.5 * kRetrievalMove * side * x[1];
    moved.pose.pose.yaw += kRetrievalTurn * x[2];
    if (x.size() > 3) moved.pose.scale *= std::exp(kRetrievalScale * std::clamp(x[3], -6.0, 6.0));
    Evaluate(&moved);
    return moved;
  }

  const std::vector<TableAsset>& assets_;
  const std::vector<std::unique_ptr<RenderableAsset>>& renderable_;
  const ObservedObject& object_;
  const core::Camera& camera_;
  const RetrievalOptions& options_;
};

bool IsTaken(const PlacedAsset& placed, const ReconstructedObject& object,
             const RetrievalOptions& options) {
  return placed.agreement.iou >= options.least_iou &&
         placed.agreement.color_error <= options.most_color_error &&
         placed.agreement.iou >= object.fit.agreement.iou - options.iou_margin;
}

// Returns the factor of all lengths at which the assets have their own size, and its error.
std::pair<double, double> ScaleOfAssets(const std::vector<std::optional<PlacedAsset>>& found) {
  std::vector<double> logs;
  for (const std::optional<PlacedAsset>& placed : found) {
    if (placed) logs.push_back(-std::log(placed->pose.scale));
  }
  if (logs.empty()) return {0.0, 0.0};
  std::sort(logs.begin(), logs.end());
  const double middle = 0.5 * (logs[(logs.size() - 1) / 2] + logs[logs.size() / 2]);
  std::erase_if(logs, [&](double log) { return std::abs(log - middle) > kAgreeingScale; });
  if (logs.empty()) return {0.0, 0.0};
  if (logs.size() == 1) return {middle, kOneAssetError};
  double off = 0.0;
  for (const double log : logs) off += std::min(std::abs(log - middle), kAgreeingScale);
  const auto count = static_cast<double>(logs.size());
  return {middle, std::max(kLeastScaleError, 1.25 * off / count / std::sqrt(count))};
}

// Returns the error of a size (of the logarithm) whose part by the common scale changed.
double WithScaleError(double size_error, double before, double after) {
  return std::hypot(std::sqrt(std::max(0.0, size_error * size_error - before * before)), after);
}

void ScaleTable(double log_factor, double error, TableReconstruction* table,
                std::vector<std::optional<PlacedAsset>>* found, core::Findings* findings) {
  const double factor = std::exp(log_factor), before = table->log_scale_error;
  table->camera.height *= factor;
  table->log_scale_error = error;
  for (ReconstructedObject& object : table->objects) {
    object.fit.pose.x *= factor;
    object.fit.pose.y *= factor;
    object.fit.instance.size *= factor;
    object.fit.size_off.array() += log_factor;
    object.position_error *= factor;
    object.size_error = WithScaleError(object.size_error, before, error);
  }
  for (std::optional<PlacedAsset>& placed : *found) {
    if (!placed) continue;
    placed->pose.pose.x *= factor;
    placed->pose.pose.y *= factor;
    placed->pose.scale *= factor;
    if (std::abs(std::log(placed->pose.scale)) > kAgreeingScale) placed.reset();
  }
  char sentence[120];
  std::snprintf(sentence, sizeof sentence,
                "the assets' own sizes give the scale: the camera stands %.2f m above the table",
                table->camera.height);
  findings->push_back({"twin-scale-from-assets", core::Severity::kInfo, "", sentence,
                       table->camera.height, "--camera-height states it"});
}

void TakeAsset(const PlacedAsset& placed, const TableAsset& asset, const Detection& detection,
               const core::Camera& camera, double log_scale_error, ReconstructedObject* object) {
  object->retrieved = placed.asset;
  object->fit.pose = placed.pose.pose;
  object->fit.instance.size = asset.size;
  object->fit.agreement.iou = placed.agreement.iou;
  object->fit.agreement.unexplained = placed.agreement.color_error;
  object->confidence =
      detection.confidence * placed.agreement.iou * (1.0 - placed.agreement.color_error);
  const PoseUncertainty uncertainty =
      UncertaintyOf(object->fit, detection.box, camera, object->hidden, log_scale_error);
  object->position_error = uncertainty.position;
  object->yaw_error = uncertainty.yaw;
  object->size_error = 0.0;  // the asset's own
}

}  // namespace

const std::string& NameOf(const ReconstructedObject& object,
                          const std::vector<TableAsset>& assets) {
  if (object.retrieved >= 0) return assets.at(static_cast<size_t>(object.retrieved)).name;
  return library_fit::FitKinds().at(static_cast<size_t>(object.fit.instance.kind)).name;
}

bool RetrievalOptions::IsValid(std::string* error) const {
  const auto fail = [error](const char* reason) {
    if (error) *error = reason;
    return false;
  };
  if (yaws < 4 || yaws > 360) return fail("4 to 360 yaws are tried");
  if (refined < 1) return fail("at least one start is refined");
  if (generations < 1) return fail("the search needs a generation");
  if (side < 16 || side > 1024) return fail("the crops must be 16 to 1024 pixels a side");
  return true;
}

void RetrieveAssets(const core::Image& photo, const Detections& detections,
                    const std::vector<TableAsset>& assets, const RetrievalOptions& options,
                    TableReconstruction* table, core::Progress* progress,
                    core::Findings* findings) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "retrieval of assets");
  if (assets.empty()) return;
  std::vector<std::unique_ptr<RenderableAsset>> renderable;
  for (const TableAsset& asset : assets) {
    renderable.push_back(std::make_unique<RenderableAsset>(asset));
  }
  const std::vector<ObservedObject> observed =
      ObserveObjects(photo, detections.objects, options.side);
  const bool free_scale = table->log_scale_error > 0.0;
  core::Camera camera = table->camera.At(photo.width, photo.height);
  const auto search_of = [&](const ReconstructedObject& object) {
    return AssetSearch(assets, renderable, observed[static_cast<size_t>(object.detection)], camera,
                       options);
  };
  const auto rng_of = [&](size_t k) { return core::StreamRng(options.seed, 500 + k); };
  std::vector<std::optional<PlacedAsset>> found(table->objects.size());
  for (size_t k = 0; k < found.size(); ++k) {
    core::Rng rng = rng_of(k);
    found[k] = search_of(table->objects[k]).Best(free_scale, &rng);
    if (found[k] && !IsTaken(*found[k], table->objects[k], options)) found[k].reset();
    progress->Advance();
  }
  if (free_scale) {
    const auto [log_factor, scale_error] = ScaleOfAssets(found);
    if (scale_error > 0.0) {
      ScaleTable(log_factor, scale_error, table, &found, findings);
      camera = table->camera.At(photo.width, photo.height);
    }
  }
  for (size_t k = 0; k < found.size(); ++k) {
    if (!found[k]) continue;
    ReconstructedObject& object = table->objects[k];
    if (free_scale) {
      core::Rng rng = rng_of(k);
      found[k]->pose.scale = 1.0;
      const AssetSearch search = search_of(object);
      search.Evaluate(&*found[k]);
      search.Refine(false, &rng, &*found[k]);
      if (!IsTaken(*found[k], object, options)) continue;
    }
    TakeAsset(*found[k], assets[static_cast<size_t>(found[k]->asset)],
              detections.objects[static_cast<size_t>(object.detection)], camera,
              table->log_scale_error, &object);
  }
}

}  // namespace simwright::twin
