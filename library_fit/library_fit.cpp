#include "library_fit/library_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "asset_lift/priors/shape_example.h"
#include "core/error.h"
#include "library_fit/fit_search.h"
#include "library_fit/prior_example.h"

namespace simwright::library_fit {
namespace {

static_assert(kPriorSide == asset_lift::kCropSide, "the crops of both priors are the same");
constexpr double kKindWeight = 0.08;  // of the negative log probability of the kind

// Returns the most probable of the kinds considered.
std::vector<int> KindsToFit(const std::vector<double>& probabilities,
                            const LibraryFitOptions& options) {
  std::vector<int> kinds = options.kinds;
  if (kinds.empty()) {
    kinds.resize(probabilities.size());
    std::iota(kinds.begin(), kinds.end(), 0);
  }
  for (const int kind : kinds) {
    if (kind < 0 || kind >= static_cast<int>(probabilities.size())) {
      throw core::Error("no such kind to fit", std::to_string(kind));
    }
  }
  std::stable_sort(kinds.begin(), kinds.end(), [&](int a, int b) {
    return probabilities[static_cast<size_t>(a)] > probabilities[static_cast<size_t>(b)];
  });
  double sum = 0.0;
  for (const int kind : kinds) sum += probabilities[static_cast<size_t>(kind)];
  size_t count = 1;
  while (count < kinds.size() && count < static_cast<size_t>(options.most_kinds) &&
         probabilities[static_cast<size_t>(kinds[count])] >= options.least_probability * sum) {
    ++count;
  }
  kinds.resize(count);
  return kinds;
}

FittedInstance FitKindTo(const KindPrediction& prediction, const FitTarget& target,
                         const LibraryFitOptions& options, core::Rng rng) {
  const FitSearch search(prediction, target);
  std::vector<FitPoint> points = search.Proposals(options.proposals, options.starts, &rng);
  for (FitPoint& point : points) {
    search.TryChoices(&point);
    search.Refine(options.generations, 0.5, &rng, &point);
  }
  FitPoint best =
      *std::min_element(points.begin(), points.end(),
                        [](const FitPoint& a, const FitPoint& b) { return a.loss < b.loss; });
  search.TryChoices(&best);
  search.Refine(options.generations, 0.25, &rng, &best);
  FittedInstance fit;
  fit.instance = best.instance;
  fit.view = best.view;
  fit.probability = prediction.probability;
  fit.iou = best.agreement.iou;
  fit.unexplained = best.agreement.unexplained;
  fit.edge_error = best.agreement.edge_error;
  fit.score = best.loss - kKindWeight * std::log(prediction.probability + 1e-4);
  return fit;
}

}  // namespace

bool LibraryFitOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (most_kinds < 1) return fail("a fit needs a kind");
  if (proposals < 1 || starts < 1) return fail("a fit needs a proposal to start from");
  if (generations < 0) return fail("the number of generations is negative");
  if (side < 16) return fail("the compared crop needs at least 16 pixels per side");
  return true;
}

FitPhoto FitPhotoOf(const core::Image& photo, const core::Image& alpha) {
  if (photo.width != alpha.width || photo.height != alpha.height || alpha.channels != 1) {
    throw core::Error("a fit needs a photo and a matte of the same size");
  }
  asset_lift::Matte matte;
  matte.left = photo.width;
  matte.top = photo.height;
  for (int y = 0; y < alpha.height; ++y) {
    for (int x = 0; x < alpha.width; ++x) {
      if (*alpha.At(x, y) < 128) continue;
      matte.left = std::min(matte.left, x);
      matte.right = std::max(matte.right, x + 1);
      matte.top = std::min(matte.top, y);
      matte.bottom = std::max(matte.bottom, y + 1);
    }
  }
  if (matte.right <= matte.left) throw core::Error("the matte shows no object");
  core::Camera camera;
  camera.width = photo.width;
  camera.height = photo.height;
  camera.fx = camera.fy = photo.width;
  camera.cx = 0.5 * photo.width;
  camera.cy = 0.5 * photo.height;
  return {photo, alpha, asset_lift::FrameAround(matte, camera, 1.0, kPriorMargin)};
}

std::vector<FittedInstance> FitLibrary(const LibraryPrior& prior, const FitPhoto& photo,
                                       const LibraryFitOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "library fit");
  const core::Image crop = asset_lift::CropImage(photo.photo, photo.alpha, photo.frame);
  const FitTarget target =
      MakeFitTarget(asset_lift::CropView(photo.photo, photo.alpha, photo.frame, options.side));
  const std::vector<int> kinds = KindsToFit(prior.KindProbabilities(crop), options);
  std::vector<FittedInstance> fits;
  for (const KindPrediction& prediction : prior.Predict(crop, kinds)) {
    fits.push_back(
        FitKindTo(prediction, target, options,
                  core::StreamRng(options.seed, static_cast<std::uint64_t>(prediction.kind))));
  }
  std::stable_sort(fits.begin(), fits.end(), [](const FittedInstance& a, const FittedInstance& b) {
    return a.score < b.score;
  });
  return fits;
}

core::Camera PhotoCamera(const FittedInstance& fit, const FitPhoto& photo) {
  constexpr int kSide = 512;
  const FitTarget target =
      MakeFitTarget(asset_lift::CropView(photo.photo, photo.alpha, photo.frame, kSide));
  const core::TexturedMesh mesh = InstanceMesh(fit.instance);
  core::Camera camera = CameraOf(fit.view, mesh.mesh, target.box, kSide);
  const double scale = 2.0 * photo.frame.half / kSide;
  camera.width = photo.photo.width;
  camera.height = photo.photo.height;
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = scale * camera.cx + photo.frame.center_x - photo.frame.half;
  camera.cy = scale * camera.cy + photo.frame.center_y - photo.frame.half;
  return camera;
}

}  // namespace simwright::library_fit
