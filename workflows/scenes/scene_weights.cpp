#include "workflows/scenes/scene_weights.h"

#include <algorithm>
#include <set>
#include <vector>

#include "core/error.h"
#include "scene/model/scene_model.h"
#include "workflows/priors/models_folder.h"

namespace simwright::workflows {
namespace {

namespace fs = std::filesystem;

constexpr char kTextWeights[] = "scenes/text/all_types.pt";

std::set<std::string> ShippedTypes() {
  std::set<std::string> types;
  const fs::path models = ModelsFolder();
  if (models.empty() || !fs::is_directory(models / "scenes")) return types;
  for (const fs::directory_entry& entry : fs::directory_iterator(models / "scenes")) {
    if (entry.path().extension() == ".pt") types.insert(entry.path().stem().string());
  }
  return types;
}

}  // namespace

fs::path ShippedSceneWeights(const std::string& type) {
  const std::set<std::string> types = ShippedTypes();
  if (types.contains(type)) return ModelsFolder() / "scenes" / (type + ".pt");
  std::string known;
  for (const std::string& shipped : types) known += (known.empty() ? "" : ", ") + shipped;
  throw core::Error("no weights of this scene type are shipped", type,
                    (types.empty() ? "" : "those of " + known + " are; else ") +
                        "train some with `simwright scene train` and name their model.pt");
}

fs::path ShippedTextWeights() {
  const fs::path weights = ModelsFolder() / kTextWeights;
  if (fs::is_regular_file(weights)) return weights;
  throw core::Error("the weights that read prompts are missing", weights.string(),
                    "set SIMWRIGHT_MODELS to the folder models/ of the source, or name a --type");
}

fs::path ShippedWeightsForType(const std::string& type) {
  const fs::path all = ModelsFolder() / kTextWeights;
  if (!ShippedTypes().contains(type) && fs::is_regular_file(all)) {
    const std::vector<std::string> names = scene::ReadSceneModelMetadata(all).TypeNames();
    if (std::find(names.begin(), names.end(), type) != names.end()) return all;
  }
  return ShippedSceneWeights(type);
}

}  // namespace simwright::workflows
