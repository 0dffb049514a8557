#include "workflows/priors/prior_weights.h"

#include "asset_lift/priors/learned_view_prior.h"
#include "asset_lift/priors/scripted_view_prior.h"
#include "workflows/priors/models_folder.h"
#include "workflows/priors/prior_training.h"

namespace simwright::workflows {
namespace fs = std::filesystem;

asset_lift::LiftPriors LoadLiftPriors(const fs::path& view_script, core::Findings* findings) {
  asset_lift::LiftPriors priors;
  const fs::path folder = ModelsFolder();
  const fs::path shape = ShapeWeights(folder), view = ViewWeights(folder);
  const bool have_shape = !folder.empty() && fs::exists(shape);
  if (have_shape) priors.shape = std::make_shared<asset_lift::ShapePrior>(shape);
  if (!view_script.empty()) {
    priors.view = asset_lift::LoadScriptedViewPrior(view_script);
  } else if (have_shape && fs::exists(view)) {
    priors.view = asset_lift::LoadLearnedViewPrior(view, priors.shape);
  }
  if (!have_shape || priors.view == nullptr) {
    findings->push_back({"prior", core::Severity::kWarning, folder.string(),
                         std::string("no weights of the ") + (have_shape ? "view" : "shape") +
                             " prior were found: the hidden side is inferred from the silhouette "
                             "(simwright prior train -o models makes them)",
                         0.0});
  }
  return priors;
}

}  // namespace simwright::workflows
