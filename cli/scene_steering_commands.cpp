#include "cli/scene_steering_commands.h"

#include <cstdio>
#include <memory>
#include <string>

#include "cli/findings_output.h"
#include "cli/scene_sampling_options.h"
#include "workflows/scenes/scene_steering.h"

namespace simwright::cli {
namespace {

int Steer(workflows::SceneSteeringRequest request, const CommonOptions& common) {
  request.sampling.seed = common.seed;
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  const workflows::SceneSteeringReport report = workflows::SteerScenes(request, &progress);
  if (common.json) {
    PrintJson(workflows::SteeringJson(report), report.findings);
  } else {
    PrintFindings(report.findings, common);
    std::fputs(workflows::SteeringTable(report).c_str(), stdout);
  }
  return report.Succeeded() ? 0 : 1;
}

// Adds the options that both commands have.
void AddSteering(CLI::App* command, workflows::SceneSteeringRequest* request,
                 CommonOptions* common) {
  command
      ->add_option("source", request->scene,
                   "A dataset, a scene folder of `scene export`, or a JSON file of poses")
      ->required();
  command->add_option("--scene", request->scenes, "The scenes of a dataset, e.g. 0,3-5")
      ->default_str("0");
  command->add_option("--model", request->weights, "A model written by `simwright scene train`");
  command->add_option("--type", request->type, "The scene type, with its shipped weights")
      ->default_str("the scene's");
  command->add_option("-o,--output", request->output, "The folder for the scenes")->required();
  command->add_option("--attempts", request->attempts, "Most rounds of proposals")
      ->capture_default_str();
  command
      ->add_option("--candidates", request->candidates,
                   "Proposals per scene and round, of which the best is taken")
      ->capture_default_str();
  command
      ->add_option("--assets", request->assets,
                   "The folder of the categories' assets, if not the scene's")
      ->default_str("the scene's, then the library");
  AddSceneSamplingOptions(command, &request->text_encoder, &request->sampling);
  command->add_option("--batch", request->sampling.batch, "Proposals per batch")
      ->capture_default_str();
  command
      ->add_option_function<std::string>(
          "--clamping",
          [request](const std::string& name) {
            request->sampling.clamping =
                name == "clean" ? scene::Clamping::kCleanValues : scene::Clamping::kForwardNoised;
          },
          "How the model sees what is kept: without noise, or noised like the rest")
      ->check(CLI::IsMember({"clean", "noised"}))
      ->default_str("clean");
  AddCommon(command, common);
  AddDevice(command);
  AddForce(command, common);
}

}  // namespace

void AddSceneComplete(CLI::App* scene, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::SceneSteeringRequest>();
  CLI::App* command = scene->add_subcommand("complete", "Add objects to a scene, which stays");
  command->footer(
      "Examples:\n  simwright scene complete out/dimsum --scene 3 --count 4 -o out/completed\n"
      "  simwright scene complete out/worlds/scene_00003 -o out/completed\n"
      "  simwright scene complete out/pantry --prompt \"two apples and a can\" -o out/completed\n"
      "  simwright scene complete out/pantry --prompt \"a can on the top shelf\" -o out/higher\n"
      "  simwright scene complete poses.json --type dimsum --count 2 -o out/completed\n"
      "Objects of the scene keep their poses, and none moves by more than 1 mm once everything is\n"
      "free. The exit code is 1 if the result is not stable. See docs/steering.md.");
  CLI::Option* const count =
      command->add_option("--count", request->goal.count, "The number of objects to add")
          ->default_str("the model's choice")
          ->check(CLI::PositiveNumber);
  command
      ->add_option("--prompt", request->prompt,
                   "What to add, and where, in words: \"two apples and a can next to the bowl\"")
      ->excludes(count);
  AddSteering(command, request.get(), common);
  command->callback([request, common, run] { *run = [=] { return Steer(*request, *common); }; });
}

void AddSceneRearrange(CLI::App* scene, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::SceneSteeringRequest>();
  request->goal.rearrange = true;
  CLI::App* command =
      scene->add_subcommand("rearrange", "Find new poses for the objects of a scene");
  command->footer(
      "Examples:\n  simwright scene rearrange out/dimsum --scene 3 -o out/rearranged\n"
      "  simwright scene rearrange out/worlds/scene_00003 --keep teapot_0,cup_1 -o out/rearranged\n"
      "Furniture stays. The exit code is 1 if the result is not stable, or an object finds no\n"
      "place. See docs/steering.md.");
  command
      ->add_option("--keep", request->goal.keep,
                   "The objects that stay, by name and separated by commas")
      ->delimiter(',')
      ->default_str("none but the furniture");
  AddSteering(command, request.get(), common);
  command->callback([request, common, run] { *run = [=] { return Steer(*request, *common); }; });
}

}  // namespace simwright::cli
