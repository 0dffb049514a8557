#include "workflows/lift/fitted_lift.h"

#include <cstdio>

#include "asset_build/articulated_preview.h"
#include "assets/articulated_folder.h"
#include "assets/asset.h"
#include "core/error.h"
#include "library_fit/fitted_object.h"
#include "render/forward.h"
#include "validation/check.h"
#include "workflows/lift/cut_out.h"
#include "workflows/priors/models_folder.h"
#include "workflows/priors/prior_training.h"

namespace simwright::workflows {
namespace {

namespace fs = std::filesystem;

// Fits that agree less are refused, and so is a kind of this small a probability if the category
// does not name it.
constexpr double kLeastOutline = 0.8;
constexpr double kLeastProbability = 0.3;
// The free form follows the photo's outline closely, whatever its depth: a fit whose outline is
// worse by more than this is another object of the kind.
constexpr double kOutlineTolerance = 0.03;

void AddChoice(const char* code, const std::string& sentence, double figure,
               const Finishing& finishing, core::Findings* findings) {
  findings->push_back({code, core::Severity::kInfo, finishing.source, sentence, figure});
}

std::string AgreementText(double iou, double edge_error) {
  char text[96];
  std::snprintf(text, sizeof text, "outline IoU %.3f, edge error %.2f", iou, edge_error);
  return text;
}

// Returns what an articulated asset cannot take from the request; empty if nothing.
std::string Unusable(const Finishing& finishing) {
  if (!finishing.size.empty()) return "--size is not used with an articulated fit";
  if (finishing.stated.Any()) return "a stated mass, density or friction is not used with one";
  if (finishing.budget.Any()) return "a budget of collision parts is not used with one";
  return "";
}

constexpr const char* kNoWeights = "the weights of the library prior are missing";
constexpr const char* kTrainThem = "simwright prior train --only library -o models makes them";

bool HasLibraryWeights() {
  const fs::path folder = ModelsFolder();
  return !folder.empty() && fs::exists(LibraryWeights(folder));
}

}  // namespace

void RequireFittable(const Finishing& finishing) {
  const std::string& category = finishing.category.category->name;
  if (library_fit::KindsOfCategory(category).empty()) {
    throw core::Error("the library has no kind of the category '" + category + "'",
                      finishing.source,
                      "leave out --shape fitted; simwright library --list prints the kinds");
  }
  if (!HasLibraryWeights()) throw core::Error(kNoWeights, ModelsFolder().string(), kTrainThem);
}

std::optional<ChosenFit> ChooseFit(LiftShape shape, const Finishing& finishing,
                                   const asset_lift::LiftedMesh& lifted, core::Findings* findings,
                                   core::Progress* progress) {
  const std::string& category = finishing.category.category->name;
  const fs::path weights = LibraryWeights(ModelsFolder());
  library_fit::LibraryFitOptions options;
  options.kinds = library_fit::KindsOfCategory(category);
  options.seed = finishing.seed;
  if (options.kinds.empty()) return {};
  if (!HasLibraryWeights()) {
    AddChoice("shape-free", std::string(kNoWeights) + " (" + kTrainThem + ")", 0.0, finishing,
              findings);
    return {};
  }
  progress->Stage("fitting the library");
  const library_fit::LibraryPrior prior(weights);
  ChosenFit chosen;
  chosen.photo = library_fit::FitPhotoOf(lifted.photo, lifted.matte.alpha);
  chosen.fit = library_fit::FitLibrary(prior, chosen.photo, options).front();
  const library_fit::FitKind& kind =
      library_fit::FitKinds()[static_cast<size_t>(chosen.fit.instance.kind)];
  chosen.articulated = kind.articulated != nullptr;
  const library_fit::PhotoAgreement fitted = library_fit::AgreementWithPhoto(
      library_fit::InstanceMesh(chosen.fit.instance),
      library_fit::PhotoCamera(chosen.fit, chosen.photo), chosen.photo);
  const std::string ours =
      "the fitted " + kind.name + " has " + AgreementText(fitted.iou, fitted.edge_error);
  const std::string unusable = chosen.articulated ? Unusable(finishing) : "";
  if (shape == LiftShape::kFitted) {
    if (!unusable.empty()) throw core::Error(unusable, finishing.source);
    AddChoice("shape-fitted", ours, fitted.iou, finishing, findings);
    return chosen;
  }
  const library_fit::PhotoAgreement free_form =
      library_fit::AgreementWithPhoto(lifted.mesh, lifted.camera, chosen.photo);
  const std::string both =
      ours + ", the free form " + AgreementText(free_form.iou, free_form.edge_error);
  const bool credible = fitted.iou >= kLeastOutline &&
                        fitted.iou >= free_form.iou - kOutlineTolerance &&
                        (category != "object" || chosen.fit.probability >= kLeastProbability);
  if (!credible || !unusable.empty() || fitted.Disagreement() >= free_form.Disagreement()) {
    AddChoice("shape-free", unusable.empty() ? both : both + "; " + unusable, fitted.iou, finishing,
              findings);
    return {};
  }
  AddChoice("shape-fitted", both, fitted.iou, finishing, findings);
  return chosen;
}

void TakeFit(const ChosenFit& chosen, asset_lift::LiftedMesh* lifted) {
  library_fit::FittedMesh fitted = library_fit::TexturedFit(chosen.fit, chosen.photo);
  lifted->mesh = std::move(fitted.mesh);
  lifted->camera = fitted.camera;
  lifted->silhouette_iou = chosen.fit.iou;
}

LiftOutcome FinishArticulated(const ChosenFit& chosen, const Finishing& finishing,
                              double lift_seconds, const asset_lift::LiftedMesh& lifted,
                              core::StagedFolder* staged) {
  assets::ArticulatedAsset asset =
      library_fit::FittedAsset(chosen.fit, chosen.photo, finishing.height);
  const fs::path& output = finishing.output;
  asset.name =
      assets::FileSafeName(output.filename().empty() ? output.parent_path().filename().string()
                                                     : output.filename().string());
  asset.findings.insert(asset.findings.begin(), lifted.findings.begin(), lifted.findings.end());
  assets::WriteArticulatedAsset(asset, staged->staging());
  core::WritePng(staged->staging() / "preview.png", asset_build::ArticulatedPreview(asset));
  const core::Image cut = CutOut(lifted.photo, lifted.matte.alpha);
  core::WritePng(staged->staging() / "matte.png", cut);
  core::TexturedMesh shown = library_fit::PaintedFit(chosen.fit, chosen.photo);
  render::Scene scene;
  scene.Add(&shown);
  scene.Commit();
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.lit = false;  // the photo's colours contain its light
  const core::Camera camera = library_fit::PhotoCamera(chosen.fit, chosen.photo);
  core::WritePng(staged->staging() / "lift.png",
                 core::ContactSheet(
                     {lifted.photo, cut, render::RenderForward(scene, camera, options).color}, 3));
  const core::Findings warnings =
      validation::CheckBeforeKeeping(staged->staging(), asset.name).Warnings();
  staged->Commit();
  LiftOutcome outcome{output, {}, asset.findings, chosen.fit.iou};
  outcome.findings.insert(outcome.findings.end(), warnings.begin(), warnings.end());
  outcome.seconds["lift"] = lift_seconds;
  return outcome;
}

void RejectFit(const validation::CheckFailed& failed, const Finishing& finishing,
               const fs::path& staging, core::Findings* findings) {
  for (const auto& entry : fs::directory_iterator(staging)) fs::remove_all(entry.path());
  std::erase_if(*findings, [](const core::Finding& f) { return f.code == "shape-fitted"; });
  findings->push_back({"shape-free", core::Severity::kWarning, finishing.source,
                       std::string("the fitted object is not taken: ") + failed.what(),
                       static_cast<double>(failed.results().size())});
}

}  // namespace simwright::workflows
