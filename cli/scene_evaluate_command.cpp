#include <cstdio>
#include <memory>

#include "cli/findings_output.h"
#include "cli/scene_model_commands.h"
#include "core/json.h"
#include "workflows/scenes/scene_evaluation.h"
#include "workflows/scenes/scene_feature_training.h"

namespace simwright::cli {
namespace {

int Evaluate(workflows::SceneEvaluationRequest request, const CommonOptions& common) {
  request.seed = request.sampling.seed = common.seed;
  core::Progress progress(common.ProgressStyle());
  const workflows::SceneEvaluation evaluation = workflows::EvaluateScenes(request, &progress);
  if (common.json) {
    PrintJson(workflows::EvaluationJson(evaluation), evaluation.findings);
    return 0;
  }
  std::fputs(workflows::EvaluationTable(evaluation).c_str(), stdout);
  PrintFindings(evaluation.findings, common);
  return 0;
}

int TrainFeatures(workflows::SceneFeatureTrainingRequest request, const CommonOptions& common) {
  request.options.seed = common.seed;
  core::Progress progress(common.ProgressStyle());
  const scene::FeatureTrainingReport report = workflows::TrainSceneFeatures(request, &progress);
  if (common.json) {
    const core::OrderedJson json = {{"weights", request.weights.string()},
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
      "%s: %lld parameters, %d images, %.0f s\nmean error of the counts in %d held-out images: "
      "%.3f objects per class; of predicting the mean: %.3f\n",
      request.weights.c_str(), static_cast<long long>(report.parameters), report.pictures,
      report.seconds, report.held_out, report.error, report.error_of_the_mean);
  return 0;
}

void AddTrainFeatures(CLI::App* features, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::SceneFeatureTrainingRequest>();
  CLI::App* command = features->add_subcommand(
      "train", "Train the network whose features compare images of scenes");
  command->footer(
      "Example:\n  simwright scene features train -o models/scene_features.pt\n"
      "Without a dataset or --type, scenes of all types are sampled, without physics.");
  command->add_option("datasets", request->datasets,
                      "Datasets written by `simwright scene generate`");
  command->add_option("-o,--output", request->weights, "The weights file")->required();
  command->add_option("--type", request->types, "Scene types to sample in addition");
  command->add_option("--draws", request->samples, "Number of scenes per such type")
      ->capture_default_str();
  command->add_option("--assets", request->assets,
                      "Asset folders, matched by name or category; the library provides the rest");
  command->add_option("--steps", request->options.trainer.steps, "Number of updates")
      ->capture_default_str();
  command->add_option("--batch", request->options.batch, "Images per update")
      ->capture_default_str();
  AddCommon(command, common);
  AddDevice(command);
  command->callback(
      [request, common, run] { *run = [=] { return TrainFeatures(*request, *common); }; });
}

}  // namespace

void AddSceneFeatures(CLI::App* scene, CommonOptions* common, Run* run) {
  CLI::App* features =
      scene->add_subcommand("features", "The features that compare images of scenes");
  features->require_subcommand(1);
  AddTrainFeatures(features, common, run);
}

void AddSceneEvaluate(CLI::App* scene, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::SceneEvaluationRequest>();
  CLI::App* command =
      scene->add_subcommand("evaluate", "Compare a model's scenes with its training data");
  command->footer(
      "Examples:\n  simwright scene evaluate --type dimsum -o out/evaluated\n"
      "  simwright scene evaluate --model out/dimsum_model/model.pt --data out/dimsum\n"
      "  simwright scene evaluate --samples out/sampled --data out/dimsum --training-scenes 900\n"
      "  simwright scene evaluate --model out/pantry_model/model.pt --data out/pantry --prompts\n"
      "The first two sample scenes themselves. See docs/scenes.md for the metrics.");
  command->add_option("--type", request->type, "The scene type, with its shipped weights");
  command->add_option("--model", request->weights, "A model written by `simwright scene train`");
  command->add_option("--samples", request->samples,
                      "Scenes written by `simwright scene sample --raw`");
  command->add_option("--data", request->data,
                      "The dataset to compare with; without it, scenes are generated");
  command
      ->add_option("--training-scenes", request->training_scenes,
                   "Number of leading scenes of --data that are training scenes")
      ->default_str("from --model");
  command->add_option("--count", request->count, "Maximum number of scenes per set")
      ->capture_default_str();
  command->add_option("--assets", request->assets,
                      "Asset folders, matched by name or category; the library provides the rest");
  command->add_option("--features", request->features,
                      "A TorchScript feature extractor, instead of ours");
  command
      ->add_option("--feature-side", request->feature_side,
                   "Side of its images, pixels: 299 (Inception), 224 (AlexNet)")
      ->capture_default_str();
  command->add_flag("--prompts", request->prompted,
                    "Sample with the prompts of held-out scenes, and measure how well the samples "
                    "agree with them");
  command->add_flag("--free-counts", request->free_counts,
                    "Let the network alone decide how many objects of each name there are, instead "
                    "of holding the samples to the counts of the prompt");
  command
      ->add_option("--guidance", request->sampling.guidance,
                   "Weight of classifier-free guidance; 0: none")
      ->capture_default_str();
  command->add_option(
      "--text-encoder", request->text_encoder,
      "The TorchScript text encoder that the model was trained with, if it has one");
  command->add_option("--steps", request->sampling.steps, "Diffusion steps; 0: all")
      ->capture_default_str();
  command->add_option("-o,--output", request->output, "The folder for metrics.json and sheet.png");
  AddCommon(command, common);
  AddDevice(command);
  command->callback([request, common, run] { *run = [=] { return Evaluate(*request, *common); }; });
}

}  // namespace simwright::cli
