#include "cli/scene_posttrain_command.h"

#include <cstdio>
#include <memory>

#include "cli/findings_output.h"
#include "core/error.h"
#include "scene/model/training.h"
#include "workflows/scenes/scene_post_training.h"

namespace simwright::cli {
namespace {

int PostTrain(workflows::ScenePostTrainingRequest request, const CommonOptions& common) {
  request.options.seed = common.seed;
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  workflows::ScenePostTrainingReport report;
  try {
    report = workflows::PostTrainScenes(request, &progress);
  } catch (const core::Cancelled&) {
    if (!std::filesystem::exists(request.output / steering::kRoundsFile)) throw;
    progress.Finish();
    return ReportStopped(request.output);
  }
  if (common.json) {
    PrintJson(workflows::PostTrainingJson(report), report.findings);
    return 0;
  }
  PrintFindings(report.findings, common);
  std::fputs(workflows::PostTrainingTable(report).c_str(), stdout);
  return 0;
}

void AddTrainingOptions(CLI::App* command, steering::PostTrainingOptions* options) {
  command->add_option("--rounds", options->rounds, "Rounds of sampling")->capture_default_str();
  command->add_option("--scenes", options->scenes, "Scenes per round")->capture_default_str();
  command->add_option("--steps", options->steps, "Diffusion steps of a sample")
      ->capture_default_str();
  command
      ->add_option("--gradient-steps", options->gradient_steps,
                   "Diffusion steps with a gradient in an update")
      ->capture_default_str();
  command->add_option("--updates", options->updates, "Updates per round")->capture_default_str();
  command->add_option("--rate", options->trainer.learning_rate, "Learning rate")
      ->capture_default_str();
  command->add_option("--clip", options->clip, "Clip of the importance ratio, around 1")
      ->capture_default_str();
  command->add_option("--data-weight", options->data_weight, "Weight of the loss on data")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--more-slots", options->more_entries,
                   "Slots of a scene beyond those of the model")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000));
  command->add_option("--score-every", options->score_every, "Rounds between checkpoints")
      ->capture_default_str();
  command->add_option("--scored", options->scored_scenes, "Scenes sampled to score a checkpoint")
      ->capture_default_str()
      ->check(CLI::Range(8, 1'000'000));
  command->add_flag("--resume", options->trainer.resume, "Resume from the folder's state");
}

}  // namespace

void AddScenePosttrain(CLI::App* scene, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::ScenePostTrainingRequest>();
  CLI::App* command = scene->add_subcommand(
      "posttrain", "Post-train a model for a reward by policy gradient, held to its data");
  command->footer(
      "Examples:\n  simwright scene posttrain out/model/model.pt --data out/shelves -o out/fuller\n"
      "  simwright scene posttrain out/model/model.pt --data out/pantry -o out/apples \\\n"
      "    --objective \"count(apple) + 2*count(can)\"\n"
      "The reward is \"objects\", \"feasible\" (objects that physics keeps), or an expression of\n"
      "count(NAME) and feasible(NAME) with + - * / ( ) min max. See docs/steering.md.");
  command->add_option("weights", request->weights, "A model written by `simwright scene train`");
  command->add_option("--type", request->type, "The scene type, with its shipped weights");
  command->add_option("--data", request->data, "The dataset that the model was trained on")
      ->required();
  command->add_option("--assets", request->assets, "The folder of the categories' assets")
      ->default_str("the dataset's");
  CLI::Option* const objective =
      command->add_option("--objective", request->objective, "The reward of a scene")
          ->capture_default_str();
  command
      ->add_option("--prompt", request->prompt,
                   "The wanted scene in words; the reward is the agreement with it")
      ->excludes(objective);
  AddTrainingOptions(command, &request->options);
  command
      ->add_option(
          "--largest-accuracy", request->largest_accuracy,
          "A checkpoint is chosen only if a classifier tells its samples from data with at "
          "most this accuracy")
      ->capture_default_str();
  command->add_option("--count", request->compared_scenes, "Samples to compare before and after")
      ->capture_default_str();
  command->add_option("--settled", request->settled_scenes, "How many of them go through physics")
      ->capture_default_str();
  command->add_option("-o,--output", request->output, "The folder for weights and curves")
      ->required();
  AddCommon(command, common);
  AddDevice(command);
  AddForce(command, common);
  command->callback(
      [request, common, run] { *run = [=] { return PostTrain(*request, *common); }; });
}

}  // namespace simwright::cli
