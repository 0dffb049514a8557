#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/findings_output.h"
#include "cli/scene_model_commands.h"
#include "pipeline/scene_evaluation.h"
#include "pipeline/scene_feature_training.h"

namespace simwright::cli {
namespace {

int Evaluate(pipeline::SceneEvaluationRequest request, const CommonOptions& common) {
  request.seed = request.sampling.seed = common.seed;
  core::Progress progress(common.ProgressStyle());
  const pipeline::SceneEvaluation evaluation = pipeline::EvaluateScenes(request, &progress);
  if (common.json) {
    PrintJson(pipeline::EvaluationJson(evaluation), evaluation.findings);
    return 0;
  }
  std::fputs(pipeline::EvaluationTable(evaluation).c_str(), stdout);
  PrintFindings(evaluation.findings, common);
  return 0;
}

int TrainFeatures(pipeline::SceneFeatureTrainingRequest request, const CommonOptions& common) {
  request.options.seed = common.seed;
  core::Progress progress(common.ProgressStyle());
  const scene::FeatureTrainingReport report = pipeline::TrainSceneFeatures(request, &progress);
  if (common.json) {
    const nlohmann::ordered_json json = {{"weights", request.weights.string()},
                                         {"parameters", report.parameters},
                                         {"pictures", report.pictures},
                                         {"held_out", report.held_out},
                                         {"error", report.error},
                                         {"error_of_the_mean", report.error_of_the_mean},
                                         {"seconds", report.seconds}};
    PrintJson(json, {});
    return 0;
  }
  std::printf(
      "%s: %lld parameters, %d pictures, %.0f s\ncounts of %d held-out pictures are off by %.3f "
      "objects a class in the mean; saying the mean: by %.3f\n",
      request.weights.c_str(), static_cast<long long>(report.parameters), report.pictures,
      report.seconds, report.held_out, report.error, report.error_of_the_mean);
  return 0;
}

void AddTrainFeatures(CLI::App* features, CommonOptions* common, Run* run) {
  auto request = std::make_shared<pipeline::SceneFeatureTrainingRequest>();
  CLI::App* command = features->add_subcommand(
      "train", "The network by whose features pictures of scenes are compared");
  command->footer(
      "Example:\n  simwright scene features train -o models/scene_features.pt\n"
      "Without a dataset or --type, scenes of all types are drawn, without physics.");
  command->add_option("datasets", request->datasets, "What `simwright scene generate` wrote");
  command->add_option("-o,--output", request->weights, "File of the weights")->required();
  command->add_option("--type", request->types, "Of scenes to draw besides");
  command->add_option("--draws", request->draws, "Scenes of each such type")->capture_default_str();
  command->add_option("--assets", request->assets,
                      "Folders of assets, by name or category; the library's for the rest");
  command->add_option("--steps", request->options.trainer.steps, "Updates")->capture_default_str();
  command->add_option("--batch", request->options.batch, "Pictures of an update")
      ->capture_default_str();
  AddCommon(command, common);
  command->callback(
      [request, common, run] { *run = [=] { return TrainFeatures(*request, *common); }; });
}

}  // namespace

void AddSceneFeatures(CLI::App* scene, CommonOptions* common, Run* run) {
  CLI::App* features = scene->add_subcommand("features", "What pictures of scenes are compared by");
  features->require_subcommand(1);
  AddTrainFeatures(features, common, run);
}

void AddSceneEvaluate(CLI::App* scene, CommonOptions* common, Run* run) {
  auto request = std::make_shared<pipeline::SceneEvaluationRequest>();
  CLI::App* command = scene->add_subcommand(
      "evaluate",
      "How near a model's scenes are to those it learned from, in figures and pictures");
  command->footer(
      "Examples:\n  simwright scene evaluate --type dimsum -o out/evaluated\n"
      "  simwright scene evaluate --model out/dimsum_model/model.pt --data out/dimsum\n"
      "  simwright scene evaluate --samples out/sampled --data out/dimsum --training-scenes 900\n"
      "The first two sample by themselves. docs/scenes.md says what the figures are.");
  command->add_option("--type", request->type, "Of scene: with the weights that are shipped");
  command->add_option("--model", request->weights, "What `simwright scene train` wrote");
  command->add_option("--samples", request->samples, "What `simwright scene sample --raw` wrote");
  command->add_option("--data", request->data,
                      "Dataset to compare with; without one, scenes are generated");
  command->add_option("--training-scenes", request->training_scenes,
                      "The first so many of --data were learned from")
      ->default_str("as --model says");
  command->add_option("--count", request->count, "Scenes of each set, at most")
      ->capture_default_str();
  command->add_option("--assets", request->assets,
                      "Folders of assets, by name or category; the library's for the rest");
  command->add_option("--features", request->features,
                      "TorchScript module whose outputs are compared, instead of our features");
  command
      ->add_option("--feature-side", request->feature_side,
                   "Pixels of its pictures: 299 (Inception), 224 (AlexNet)")
      ->capture_default_str();
  command->add_option("--steps", request->sampling.steps, "Of the diffusion, 0: all")
      ->capture_default_str();
  command->add_option("-o,--output", request->output, "Folder for metrics.json and sheet.png");
  AddCommon(command, common);
  command->callback([request, common, run] { *run = [=] { return Evaluate(*request, *common); }; });
}

}  // namespace simwright::cli
