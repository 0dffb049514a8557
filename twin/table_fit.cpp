#include "twin/table_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "library_fit/cma_es.h"
#include "library_fit/fit_kinds.h"
#include "twin/table_scene.h"

namespace simwright::twin {
namespace {

using library_fit::FitAgreement;
using library_fit::FitKinds;
using library_fit::Instance;
using library_fit::InstanceMesh;
using library_fit::KindPrediction;

// One standard deviation of the search, by dimension.
constexpr double kYawStep = 0.25;   // rad
constexpr double kMoveStep = 0.12;  // of the object's longest side
constexpr double kSizeStep = 0.12;  // of the logarithm
constexpr double kChoiceStep = 0.2;
constexpr int kPoseNumbers = 3, kFixedNumbers = kPoseNumbers + 3;

constexpr double kProbe = 0.02;          // step of a choice that tells continuous ones
constexpr double kChoiceWeight = 0.012;  // of the negative log probability of a choice
constexpr double kSizeWeight = 0.03;     // of a deviation of a size
constexpr double kKindWeight = 0.08;     // of the negative log probability of the kind
constexpr double kLeastSizeError = 0.06;
constexpr double kNoShape = 1e9;  // loss of sizes that no solid has
constexpr std::uint64_t kProbedSeeds = 8;

// Returns the value reflected into [0, 1].
double IntoUnit(double value) {
  const double turn = std::fmod(std::abs(value), 2.0);
  return std::min(turn <= 1.0 ? turn : 2.0 - turn, 1.0 - 1e-9);
}

double BinLogProbability(const std::vector<double>& bins, double share) {
  const auto count = static_cast<double>(bins.size());
  const auto bin = static_cast<size_t>(std::clamp(share * count, 0.0, count - 1.0));
  return std::log(bins[bin] * count + 1e-3);
}

bool Opens(const Instance& instance) {
  return FitKinds()[static_cast<size_t>(instance.kind)].opening > 0.0;
}

// Returns the instance's mesh, or none for sizes with which its parts are too thin to be solids.
std::optional<core::TexturedMesh> MeshIfAny(const Instance& instance) {
  try {
    return InstanceMesh(instance);
  } catch (const core::Error&) {
    return std::nullopt;
  }
}

// The search for the instance of one kind, and its pose on the table.
class TableSearch {
 public:
  TableSearch(const KindPrediction& prediction, const ObservedObject& object,
              const core::Camera& camera, const TableFitOptions& options)
      : prediction_(prediction),
        object_(object),
        camera_(camera),
        options_(options),
        crop_(object.CropCamera(camera)) {
    for (std::uint64_t seed = 1; seed <= kProbedSeeds; ++seed) {
      choices_ =
          std::max(choices_, library_fit::SampleInstance(prediction.kind, seed).draws.size());
    }
    choices_ = std::min(choices_, prediction.choices.size());
  }

  double Evaluate(TableFit* fit) const {
    core::Camera camera = crop_;
    camera.world_from_camera = fit->pose.WorldFromObject().inverse() * crop_.world_from_camera;
    const std::optional<core::TexturedMesh> mesh = MeshIfAny(fit->instance);
    fit->agreement =
        mesh ? library_fit::CompareWithPhoto(*mesh, camera, object_.target) : FitAgreement();
    fit->probability = prediction_.probability;
    fit->shape_loss = mesh ? fit->agreement.Loss() + Improbability(*fit, camera) : kNoShape;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<size_t>(i);
      fit->size_off[i] = std::log(fit->instance.size[i]) - prediction_.numbers[at];
      fit->size_error[i] = std::max(kLeastSizeError, prediction_.errors[at]);
    }
    return Loss(*fit);
  }

  // Returns the `count` best of the network's proposals, placed by the object's box.
  std::vector<TableFit> Proposals(int count, core::Rng* rng) const {
    std::vector<TableFit> fits(static_cast<size_t>(options_.proposals));
    for (size_t i = 0; i < fits.size(); ++i) {
      const auto [instance, view] = i == 0 ? library_fit::LikeliestInstance(prediction_)
                                           : library_fit::SampledInstance(prediction_, rng);
      fits[i].instance = instance;
      if (i % 2 == 0) {
        fits[i].instance.size = library_fit::LikeliestInstance(prediction_).first.size;
      }
      fits[i].pose.yaw = YawOf(view.azimuth);
    }
    core::ParallelFor(static_cast<int>(fits.size()), [&](int i) {
      TableFit& fit = fits[static_cast<size_t>(i)];
      PlaceByBox(&fit);
      Evaluate(&fit);
    });
    std::stable_sort(fits.begin(), fits.end(),
                     [this](const TableFit& a, const TableFit& b) { return Loss(a) < Loss(b); });
    fits.resize(static_cast<size_t>(std::min<int>(count, options_.proposals)));
    return fits;
  }

  void Refine(int generations, double step, core::Rng* rng, TableFit* fit) const {
    library_fit::CmaEsOptions options;
    options.generations = generations;
    options.step = step;
    options.population = 12;
    const std::vector<int> choices = ContinuousChoices(*fit);
    const TableFit start = *fit;
    const int dimensions =
        kFixedNumbers + static_cast<int>(choices.size()) + (Opens(fit->instance) ? 1 : 0);
    const library_fit::CmaEsResult result = library_fit::MinimizeByCmaEs(
        [&](const Eigen::VectorXd& x) {
          TableFit moved = Moved(start, choices, x);
          return Evaluate(&moved);
        },
        Eigen::VectorXd::Zero(dimensions), options, rng);
    TableFit moved = Moved(start, choices, result.best);
    if (Evaluate(&moved) < Loss(start)) *fit = moved;
  }

  // Tries the values of each choice in turn, and keeps what lowers the loss.
  void TryChoices(TableFit* fit) const {
    for (size_t i = 0; i < choices_; ++i) {
      const size_t bins = prediction_.choices[i].size();
      const std::optional<core::TexturedMesh> base = MeshIfAny(fit->instance);
      if (!base) return;
      std::vector<TableFit> others;
      for (size_t bin = 0; bin < bins; ++bin) {
        if (prediction_.choices[i][bin] < 0.02) continue;
        TableFit other = *fit;
        other.instance.draws[i] = (static_cast<double>(bin) + 0.5) / static_cast<double>(bins);
        const std::optional<core::TexturedMesh> mesh = MeshIfAny(other.instance);
        if (!mesh || (mesh->mesh.vertices == base->mesh.vertices &&
                      mesh->triangle_material == base->triangle_material)) {
          continue;  // A choice that changes nothing but colours needs no render.
        }
        others.push_back(other);
      }
      core::ParallelFor(static_cast<int>(others.size()),
                        [&](int k) { Evaluate(&others[static_cast<size_t>(k)]); });
      for (const TableFit& other : others) {
        if (Loss(other) < Loss(*fit)) *fit = other;
      }
    }
  }

  double Loss(const TableFit& fit) const {
    double sum = fit.shape_loss;
    // The part that the three sizes share is as uncertain as the camera's height.
    const double common = fit.size_off.mean();
    for (int i = 0; i < 3; ++i) {
      sum += kSizeWeight * std::abs(fit.size_off[i] - common) / fit.size_error[i];
    }
    const double error = std::hypot(fit.size_error.mean(), options_.log_scale_error);
    return sum + 3.0 * kSizeWeight * std::abs(common) / error;
  }

 private:
  // Returns the object's yaw if the camera sees it from `azimuth` in its frame.
  double YawOf(double azimuth) const {
    const Eigen::Vector3d ray = camera_.Ray(object_.box.center());
    return std::atan2(-ray.y(), -ray.x()) - azimuth;
  }

  void PlaceByBox(TableFit* fit) const {
    const std::optional<core::TexturedMesh> mesh = MeshIfAny(fit->instance);
    if (!mesh) return;
    const ScaledPose placed = PoseFromBox(mesh->mesh, fit->pose.yaw, camera_, object_.box);
    fit->pose = placed.pose;
    fit->instance.size *= placed.scale;
  }

  double Improbability(const TableFit& fit, const core::Camera& seen_from) const {
    double sum = 0.0;
    for (size_t i = 0; i < choices_; ++i) {
      sum -= kChoiceWeight * BinLogProbability(prediction_.choices[i], fit.instance.draws[i]);
    }
    const Eigen::Vector3d eye = seen_from.position();
    const double turn = std::fmod(std::atan2(eye.y(), eye.x()) / (2.0 * M_PI) + 4.0, 1.0);
    return sum - kChoiceWeight * BinLogProbability(prediction_.azimuth, turn);
  }

  TableFit Moved(const TableFit& start, const std::vector<int>& choices,
                 const Eigen::VectorXd& x) const {
    TableFit fit = start;
    const double side = start.instance.size.maxCoeff();
    // Along the line of sight and across it.
    const Eigen::Vector3d ray = camera_.Ray(object_.box.center());
    const Eigen::Vector2d away = ray.head<2>().normalized();
    const Eigen::Vector2d across(-away.y(), away.x());
    const Eigen::Vector2d move = kMoveStep * side * (x[0] * across + 2.0 * x[1] * away);
    fit.pose.x += move.x();
    fit.pose.y += move.y();
    fit.pose.yaw += kYawStep * x[2];
    for (int i = 0; i < 3; ++i) {
      fit.instance.size[i] *= std::exp(kSizeStep * std::clamp(x[kPoseNumbers + i], -8.0, 8.0));
    }
    for (size_t i = 0; i < choices.size(); ++i) {
      double& draw = fit.instance.draws[static_cast<size_t>(choices[i])];
      draw = IntoUnit(draw + kChoiceStep * x[kFixedNumbers + static_cast<Eigen::Index>(i)]);
    }
    if (Opens(start.instance)) {
      fit.instance.opening = IntoUnit(fit.instance.opening + kChoiceStep * x[x.size() - 1]);
    }
    return fit;
  }

  std::vector<int> ContinuousChoices(const TableFit& fit) const {
    const std::optional<core::TexturedMesh> base = MeshIfAny(fit.instance);
    std::vector<int> continuous;
    if (!base) return continuous;
    for (size_t i = 0; i < choices_; ++i) {
      Instance other = fit.instance;
      other.draws[i] += other.draws[i] > 0.5 ? -kProbe : kProbe;
      const std::optional<core::TexturedMesh> mesh = MeshIfAny(other);
      // A choice of another number of parts is no continuous one.
      if (mesh && mesh->mesh.vertices.size() == base->mesh.vertices.size() &&
          mesh->mesh.vertices != base->mesh.vertices) {
        continuous.push_back(static_cast<int>(i));
      }
    }
    return continuous;
  }

  const KindPrediction& prediction_;
  const ObservedObject& object_;
  const core::Camera& camera_;
  const TableFitOptions& options_;
  core::Camera crop_;
  size_t choices_ = 0;  // that the generator makes, at most; the network predicts more
};

std::vector<int> LikelyKinds(const std::vector<double>& probabilities,
                             const TableFitOptions& options) {
  std::vector<int> kinds = options.kinds.empty() ? TableKinds() : options.kinds;
  for (const int kind : kinds) {
    if (kind < 0 || kind >= static_cast<int>(probabilities.size())) {
      throw core::Error("no such kind to fit", std::to_string(kind));
    }
  }
  std::stable_sort(kinds.begin(), kinds.end(), [&](int a, int b) {
    return probabilities[static_cast<size_t>(a)] > probabilities[static_cast<size_t>(b)];
  });
  size_t count = 1;
  while (count < kinds.size() && count < static_cast<size_t>(options.most_kinds) &&
         probabilities[static_cast<size_t>(kinds[count])] >= options.least_probability) {
    ++count;
  }
  kinds.resize(count);
  return kinds;
}

TableFit FitKindOnTable(const KindPrediction& prediction, const ObservedObject& object,
                        const core::Camera& camera, const TableFitOptions& options) {
  core::Rng rng = core::StreamRng(options.seed, static_cast<std::uint64_t>(prediction.kind));
  const TableSearch search(prediction, object, camera, options);
  std::vector<TableFit> fits = search.Proposals(options.starts, &rng);
  for (TableFit& fit : fits) {
    search.TryChoices(&fit);
    search.Refine(options.generations, 0.5, &rng, &fit);
  }
  TableFit best = *std::min_element(
      fits.begin(), fits.end(),
      [&](const TableFit& a, const TableFit& b) { return search.Loss(a) < search.Loss(b); });
  search.TryChoices(&best);
  search.Refine(options.generations, 0.25, &rng, &best);
  return best;
}

}  // namespace

bool TableFitOptions::IsValid(std::string* error) const {
  const auto fail = [error](const char* reason) {
    if (error) *error = reason;
    return false;
  };
  if (most_kinds < 1) return fail("a fit needs a kind");
  if (proposals < 1 || starts < 1) return fail("a fit needs a proposal to start from");
  if (generations < 1) return fail("a fit needs a generation");
  if (!(log_scale_error >= 0.0)) return fail("the scale's error is negative");
  return true;
}

double TableFit::Score(double log_scale) const {
  double sum = shape_loss - kKindWeight * std::log(probability + 1e-4);
  for (int i = 0; i < 3; ++i) {
    sum += kSizeWeight * std::abs(size_off[i] + log_scale) / size_error[i];
  }
  return sum;
}

std::vector<TableFit> FitOnTable(const library_fit::LibraryPrior& prior,
                                 const ObservedObject& object, const core::Camera& camera,
                                 const TableFitOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "fit on a table");
  const std::vector<int> kinds = LikelyKinds(prior.KindProbabilities(object.prior_crop), options);
  std::vector<TableFit> fits;
  for (const KindPrediction& prediction : prior.Predict(object.prior_crop, kinds)) {
    fits.push_back(FitKindOnTable(prediction, object, camera, options));
  }
  std::stable_sort(fits.begin(), fits.end(), [](const TableFit& a, const TableFit& b) {
    return a.Score(0.0) < b.Score(0.0);
  });
  return fits;
}

TableFit MovedToCamera(const TableFit& fit, const core::Camera& before, const core::Camera& after) {
  const core::TriangleMesh mesh = InstanceMesh(fit.instance).mesh;
  const Eigen::AlignedBox2d box = ProjectedBox(mesh, {fit.pose, 1.0}, before);
  if (box.isEmpty()) return fit;
  const ScaledPose placed = PoseFromBox(mesh, fit.pose.yaw, after, box);
  TableFit moved = fit;
  moved.pose = placed.pose;
  moved.instance.size *= placed.scale;
  return moved;
}

void CompareOnTable(const ObservedObject& object, const core::Camera& camera, TableFit* fit) {
  core::Camera crop = object.CropCamera(camera);
  crop.world_from_camera = fit->pose.WorldFromObject().inverse() * camera.world_from_camera;
  fit->agreement = library_fit::CompareWithPhoto(InstanceMesh(fit->instance), crop, object.target);
}

void RefineOnTable(const library_fit::LibraryPrior& prior, const ObservedObject& object,
                   const core::Camera& camera, const TableFitOptions& options, TableFit* fit) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "fit on a table");
  core::Rng rng =
      core::StreamRng(options.seed, 1000 + static_cast<std::uint64_t>(fit->instance.kind));
  const KindPrediction prediction = prior.Predict(object.prior_crop, {fit->instance.kind}).front();
  const TableSearch search(prediction, object, camera, options);
  search.Evaluate(fit);
  search.Refine(options.generations, 0.3, &rng, fit);
}

}  // namespace simwright::twin
