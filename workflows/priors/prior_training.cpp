#include "workflows/priors/prior_training.h"

#include <iterator>
#include <utility>

#include "core/error.h"
#include "importers/catalogue_meshes.h"
#include "library_fit/fit_kinds.h"
#include "twin/scene_sources.h"
#include "twin/table_crops.h"

namespace simwright::workflows {
namespace {

// Returns true if a prior is trained on pictures of tables.
bool ShowsTables(const PriorTrainingRequest& request) {
  return request.detector || (request.library && request.library_options.scene_share > 0.0);
}

// Reports missing files before the minutes that reading takes.
void RequireFiles(const PriorTrainingRequest& request) {
  const bool needs_meshes = request.shape || request.view || request.detector;
  for (const std::filesystem::path& path : request.catalogues) {
    if (needs_meshes && !std::filesystem::exists(path)) {
      throw core::Error("no such catalogue", path.string(),
                        "./setup.sh --catalogue installs the one that the shipped weights learned "
                        "from; --parametric-only learns without one");
    }
  }
  const auto require_start = [](bool wanted, const auto& options) {
    if (wanted && !options.start.empty() && !std::filesystem::exists(options.start)) {
      throw core::Error("no such weights to start from", options.start.string(),
                        "--from names a folder written by `simwright prior train`; --only trains "
                        "one prior");
    }
  };
  require_start(request.shape, request.shape_options);
  require_start(request.view, request.view_options);
  require_start(request.library, request.library_options);
  require_start(request.detector, request.detector_options);
  if (!request.photos.empty() && !ShowsTables(request)) {
    throw core::Error("photos are shown to the library prior and the detector alone",
                      request.photos.front().string(), "leave out --photos");
  }
  if (request.view && !request.shape && !std::filesystem::exists(ShapeWeights(request.output))) {
    throw core::Error("the view prior needs a shape prior", ShapeWeights(request.output),
                      "train it too, or copy one there");
  }
}

// Returns a random instance of a random kind of the library. The seeds from 1e9 on are held out, as
// those of the library's prior are.
core::TexturedMesh SampleLibraryMesh(core::Rng* rng) {
  constexpr std::int64_t kTrainingSeeds = 999999999;
  const auto kinds = static_cast<std::int64_t>(library_fit::FitKinds().size());
  const int kind = static_cast<int>(core::UniformIndex(*rng, kinds));
  const auto seed = static_cast<std::uint64_t>(1 + core::UniformIndex(*rng, kTrainingSeeds));
  return library_fit::InstanceMesh(library_fit::SampleInstance(kind, seed));
}

// Returns the options with the library as the sampler of meshes.
asset_lift::PriorTrainingOptions WithLibrary(asset_lift::PriorTrainingOptions options) {
  if (options.sampler_share > 0.0) options.sampler = SampleLibraryMesh;
  return options;
}

// Returns the options with crops of tables as the pictures of scenes; `sources` must outlive them.
library_fit::LibraryTrainingOptions WithTables(library_fit::LibraryTrainingOptions options,
                                               const twin::TableSceneSources& sources) {
  options.scene_example = [&sources](std::uint64_t seed) { return twin::TableCrop(sources, seed); };
  return options;
}

}  // namespace

std::filesystem::path DefaultTrainingCatalogue() {
  return "/usr/share/sweethome3d/furniture/BlendSwap-CC-0.sh3f";
}

PriorTrainingRequest::PriorTrainingRequest() {
  shape_options.trainer.steps = 9200;
  shape_options.trainer.learning_rate = 8e-4;
  view_options.trainer.steps = 2250;
  view_options.trainer.learning_rate = 1e-3;
}

std::filesystem::path ShapeWeights(const std::filesystem::path& folder) {
  return folder / "shape_prior.pt";
}

std::filesystem::path ViewWeights(const std::filesystem::path& folder) {
  return folder / "view_prior.pt";
}

std::filesystem::path LibraryWeights(const std::filesystem::path& folder) {
  return folder / "library_prior.pt";
}

std::filesystem::path DetectorWeights(const std::filesystem::path& folder) {
  return folder / "table_detector.pt";
}

std::vector<TrainedPrior> TrainPriors(const PriorTrainingRequest& request, core::Progress* progress,
                                      const TrainedPriorListener& listener) {
  RequireFiles(request);
  twin::TableSceneSources sources;
  if (ShowsTables(request)) sources.photos = twin::ReadScenePhotos(request.photos);
  std::vector<core::TexturedMesh> meshes;
  for (const std::filesystem::path& path : request.catalogues) {
    if (!request.shape && !request.view && !request.detector) break;
    std::vector<core::TexturedMesh> read = importers::ReadCatalogue(path, progress);
    std::move(read.begin(), read.end(), std::back_inserter(meshes));
  }
  std::filesystem::create_directories(request.output);
  const std::filesystem::path shape = ShapeWeights(request.output),
                              view = ViewWeights(request.output);
  const auto named = [&](const char* name, const std::filesystem::path& weights) {
    return [&listener, name, weights](const asset_lift::PriorTrainingReport& report) {
      if (listener) listener({name, weights, report});
    };
  };
  std::vector<TrainedPrior> trained;
  if (request.shape) {
    trained.push_back({"shape", shape,
                       asset_lift::TrainShapeNetwork(meshes, WithLibrary(request.shape_options),
                                                     shape, progress, named("shape", shape))});
  }
  if (request.view) {
    trained.push_back(
        {"view", view,
         asset_lift::TrainViewNetwork(meshes, shape, WithLibrary(request.view_options), view,
                                      progress, named("view", view))});
  }
  if (request.library) {
    const std::filesystem::path library = LibraryWeights(request.output);
    trained.push_back(
        {"library", library,
         library_fit::TrainLibraryNetwork(WithTables(request.library_options, sources), library,
                                          progress, named("library", library))});
  }
  if (request.detector) {
    sources.meshes = twin::TableMeshes(std::move(meshes));
    const std::filesystem::path detector = DetectorWeights(request.output);
    trained.push_back({"detector", detector,
                       twin::TrainDetector(sources, request.detector_options, detector, progress,
                                           named("detector", detector))});
  }
  return trained;
}

}  // namespace simwright::workflows
