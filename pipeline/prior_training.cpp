#include "pipeline/prior_training.h"

#include <cmath>
#include <sstream>

#include "core/error.h"
#include "pipeline/catalogue_meshes.h"

namespace simwright::pipeline {

std::filesystem::path DefaultTrainingCatalogue() {
  return "/usr/share/sweethome3d/furniture/BlendSwap-CC-0.sh3f";
}

PriorTrainingRequest::PriorTrainingRequest() {
  shape_options.trainer.steps = 3200;
  shape_options.trainer.learning_rate = 8e-4;
  view_options.trainer.steps = 2500;
  view_options.trainer.learning_rate = 1e-3;
}

void TrainPriors(const PriorTrainingRequest& request, core::Progress* progress,
                 const std::function<void(const std::string&)>& report) {
  std::vector<core::TexturedMesh> meshes;
  for (const std::filesystem::path& path : request.catalogues) {
    if (!std::filesystem::exists(path)) {
      throw core::Error("no such catalogue", path.string(),
                        "./setup.sh --catalogue installs the one that the shipped weights learned "
                        "from; --parametric-only learns without one");
    }
    std::vector<core::TexturedMesh> read = ReadCatalogue(path, progress);
    std::move(read.begin(), read.end(), std::back_inserter(meshes));
  }
  std::filesystem::create_directories(request.output);
  const auto listener = [&](const char* name) {
    return [&report, name](const asset_lift::PriorTrainingReport& r) {
      std::ostringstream line;
      line << name << " prior, step " << r.step << ", loss " << r.loss;
      for (const auto& [metric, value] : r.metrics) line << ", " << metric << ' ' << value;
      line << ", " << std::lround(r.seconds) << " s";
      report(line.str());
    };
  };
  const std::filesystem::path shape = request.output / "shape_prior.pt";
  if (request.shape) {
    asset_lift::TrainShapeNetwork(meshes, request.shape_options, shape, progress,
                                  listener("shape"));
  }
  if (request.view) {
    asset_lift::TrainViewNetwork(meshes, shape, request.view_options,
                                 request.output / "view_prior.pt", progress, listener("view"));
  }
}

}  // namespace simwright::pipeline
