#include "pipeline/prior_training.h"

#include <cstdio>

#include "core/error.h"
#include "pipeline/catalogue_meshes.h"

namespace simwright::pipeline {

std::filesystem::path DefaultTrainingCatalogue() {
  return "/usr/share/sweethome3d/furniture/BlendSwap-CC-0.sh3f";
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
  asset_lift::TrainShapeNetwork(
      meshes, request.shape, request.output / "shape_prior.pt", progress,
      [&](const asset_lift::ShapeTrainingReport& r) {
        char line[160];
        std::snprintf(line, sizeof(line),
                      "shape step %d  loss %.4f  volume IoU %.3f  elevation %.1f deg  %.0f s",
                      r.step, r.loss, r.occupancy_iou, r.elevation_error, r.seconds);
        report(line);
      });
}

}  // namespace simwright::pipeline
