#include "workflows/scenes/scene_weights.h"

#include <set>

#include "core/error.h"
#include "workflows/priors/models_folder.h"

namespace simwright::workflows {
namespace {

namespace fs = std::filesystem;

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

}  // namespace simwright::workflows
