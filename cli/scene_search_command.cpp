#include "cli/scene_search_command.h"

#include <cstdio>
#include <memory>
#include <string>

#include "cli/findings_output.h"
#include "cli/scene_sampling_options.h"
#include "workflows/scenes/scene_search.h"

namespace simwright::cli {
namespace {

int SearchForScene(workflows::SceneSearchRequest request, const CommonOptions& common) {
  request.search.seed = common.seed;
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  const workflows::SceneSearchReport report = workflows::SearchScenes(request, &progress);
  if (common.json) {
    PrintJson(workflows::SearchJson(report), report.findings);
  } else {
    PrintFindings(report.findings, common);
    std::fputs(workflows::SearchTable(report).c_str(), stdout);
  }
  if (report.interrupted) return ReportStopped(request.output);
  return report.Succeeded() ? 0 : 1;
}

void AddSearchGoal(CLI::App* command, workflows::SceneSearchRequest* request) {
  CLI::Option* const objective =
      command
          ->add_option(
              "--objective", request->objective.objective,
              "feasible, objects, solvable, hard-but-solvable, or an expression of counts: "
              "\"feasible(cup) - count(plate)\"")
          ->capture_default_str();
  command->add_option("--task", request->objective.task,
                      "A robot's task that is to be solvable: \"bring the apple to the front\"");
  command
      ->add_option("--prompt", request->objective.prompt,
                   "The wanted scene in words, instead of an objective")
      ->excludes(objective);
  command
      ->add_option("--mask", request->objective.mask,
                   "The objects to sample again: empty, penetrating, unstable, separated by commas")
      ->capture_default_str();
  command->add_option("--start", request->start,
                      "A scene to start from: a dataset, a scene folder of `scene export`, or a "
                      "JSON file of poses");
  command->add_option("--start-scene", request->start_scene, "The scene of a dataset to start from")
      ->default_str("0");
}

void AddSearchSettings(CLI::App* command, workflows::SceneSearchRequest* request) {
  steering::SearchOptions& search = request->search;
  command->add_option("--iterations", search.iterations, "Most expansions of a scene")
      ->capture_default_str();
  command->add_option("--branching", search.branching, "Children per expansion")
      ->capture_default_str();
  command
      ->add_option("--exploration", search.exploration,
                   "The weight c of rarely visited scenes in the selection")
      ->capture_default_str();
  command
      ->add_option("--fill", search.fill,
                   "Most objects that an expansion adds; 0: as many as the model chooses")
      ->capture_default_str();
  command->add_option("--leaves", search.leaves, "Scenes that are expanded together")
      ->capture_default_str();
  command
      ->add_option_function<std::string>(
          "--repair",
          [request](const std::string& name) {
            const bool none = name == "none";
            request->repair.repair = none ? steering::Repair::kNone : steering::Repair::kProject;
            request->search.confirms = !none;
          },
          "project: find new objects a place before they are judged; none: judge them as sampled")
      ->check(CLI::IsMember({"none", "project"}))
      ->default_str("project");
  command
      ->add_option_function<std::string>(
          "--rollout",
          [request](const std::string& name) { request->search.backs_up_all = name == "all"; },
          "The children whose rewards are backpropagated: all, or one at random")
      ->check(CLI::IsMember({"all", "one"}))
      ->default_str("all");
  command->add_flag("!--unscaled", search.scaled,
                    "Select by the rewards as they are, not on a scale of 0 to 1");
  command->add_flag("--random", request->random,
                    "Also draw as many unconditional samples, as a comparison");
  AddSceneSamplingOptions(command, &request->text_encoder, &request->sampling);
}

}  // namespace

void AddSceneSearch(CLI::App* scene, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::SceneSearchRequest>();
  CLI::App* command = scene->add_subcommand(
      "search", "Search for the scene that fulfils an objective best, by tree search");
  command->footer(
      "Examples:\n  simwright scene search --type dimsum -o out/full\n"
      "  simwright scene search --type dimsum --objective \"feasible(steamer)\" -o out/steamers\n"
      "  simwright scene search --type pantry_shelf --prompt \"two apples and a can\" -o out/two\n"
      "  simwright scene search --type pantry_shelf --objective hard-but-solvable \\\n"
      "    --task \"bring the apple to the front\" -o out/hard\n"
      "  simwright scene search --type dimsum --start out/dimsum --start-scene 3 -o out/fuller\n"
      "  simwright scene search --type dimsum --exploration 1.4 --unscaled --fill 0 --rollout one "
      "\\"
      "\n    --repair none -o out/published\n"
      "The exit code is 1 if the result is not stable. --resume continues a stopped search. See\n"
      "docs/steering.md.");
  command->add_option("weights", request->weights, "A model written by `simwright scene train`");
  command->add_option("--type", request->type, "The scene type, with its shipped weights");
  command->add_option("-o,--output", request->output, "The folder for the scene")->required();
  AddSearchGoal(command, request.get());
  AddSearchSettings(command, request.get());
  command
      ->add_option("--assets", request->assets,
                   "A folder of asset folders, matched by name or category")
      ->default_str("the start scene's, then the library");
  command->add_option("--save-every", request->save_every, "Iterations between two saved states")
      ->capture_default_str();
  command->add_flag("--resume", request->resume, "Continue the search in the output folder");
  AddCommon(command, common);
  AddDevice(command);
  AddForce(command, common);
  command->callback(
      [request, common, run] { *run = [=] { return SearchForScene(*request, *common); }; });
}

}  // namespace simwright::cli
