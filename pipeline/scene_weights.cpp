#include "pipeline/scene_weights.h"

#include "core/error.h"
#include "pipeline/models_folder.h"

namespace simwright::pipeline {

std::filesystem::path ShippedSceneWeights(const std::string& type) {
  const std::filesystem::path models = ModelsFolder();
  const std::filesystem::path weights = models / "scenes" / (type + ".pt");
  if (models.empty() || !std::filesystem::exists(weights)) {
    throw core::Error("no weights of this scene type are shipped", type,
                      "train some with `simwright scene train` and name their model.pt");
  }
  return weights;
}

}  // namespace simwright::pipeline
