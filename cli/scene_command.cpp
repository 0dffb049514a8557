#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/scene_export_command.h"
#include "cli/scene_model_commands.h"
#include "cli/slot_folders.h"
#include "core/error.h"
#include "pipeline/scene_generation.h"
#include "scene/grammar/scene_types.h"

namespace simwright::cli {
namespace {

struct GenerateFlags {
  pipeline::SceneGenerationRequest request;
  std::vector<std::string> chosen;  // "apple=out/my_apple"
  bool list = false;
};

int List(const CommonOptions& common) {
  nlohmann::ordered_json types = nlohmann::ordered_json::array();
  for (const scene::SceneType& type : scene::SceneTypes()) {
    types.push_back({{"type", type.name}, {"what", type.what}});
    if (!common.json) std::printf("%-18s %s\n", type.name.c_str(), type.what.c_str());
  }
  if (common.json) PrintJson(nlohmann::ordered_json{{"types", types}}, {});
  return 0;
}

int Generate(GenerateFlags flags, const CommonOptions& common) {
  if (flags.list) return List(common);
  if (flags.request.type.empty() || flags.request.output.empty()) {
    throw core::Error("scenes need a type and a place", "", "--type dimsum -o FOLDER, or --list");
  }
  flags.request.seed = common.seed;
  flags.request.chosen = SlotFoldersOf(flags.chosen, "--asset");
  core::Progress progress(common.ProgressStyle());
  const pipeline::SceneStatistics statistics = pipeline::GenerateScenes(flags.request, &progress);
  if (common.json) {
    PrintJson(pipeline::StatisticsJson(statistics), statistics.findings);
    return 0;
  }
  PrintFindings(statistics.findings, common);
  std::fputs(pipeline::StatisticsTable(statistics).c_str(), stdout);
  return 0;
}

void AddGenerate(CLI::App* scene, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<GenerateFlags>();
  pipeline::SceneGenerationRequest& request = flags->request;
  CLI::App* command = scene->add_subcommand(
      "generate", "Scenes from a grammar, moved apart, settled, and written as a dataset");
  command->footer(
      "Example:\n  simwright scene generate --type dimsum --count 100 -o out/dimsum\n"
      "  simwright scene generate --type pantry_shelf --count 20 --asset apple=out/apple -o "
      "pantry\n"
      "Several at once may write into one folder; one that was stopped goes on when it is called\n"
      "again. docs/scenes.md says more.");
  command->add_option("--type", request.type, "Of scene, see --list");
  command->add_option("--count", request.count, "Scenes that the dataset is to have")
      ->capture_default_str();
  command->add_option("-o,--output", request.output, "Folder of the dataset");
  command->add_option("--assets", request.assets,
                      "Folders of assets to take before the library's, by name or category")
      ->default_str("the library's alone");
  command->add_option("--asset", flags->chosen, "SLOT=FOLDER: this asset for this slot");
  command->add_option("--hull", request.hulls,
                      "Slots whose things collide as their convex hulls: nothing goes in");
  command->add_option("--part", request.part, "Scenes of a part, which one worker makes at a time")
      ->capture_default_str();
  command->add_option("--step", request.time_step, "s of a step of physics")
      ->default_str("as measured to hold");
  command->add_flag("--list", flags->list, "Say what types there are");
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Generate(*flags, *common); }; });
}

}  // namespace

void AddScene(CLI::App* app, CommonOptions* common, Run* run) {
  CLI::App* scene = app->add_subcommand("scene", "Cluttered scenes that hold in simulation");
  scene->require_subcommand(1);
  scene->footer(
      "Example:\n  simwright scene generate --type dimsum --count 100 -o out/dimsum\n"
      "Each subcommand has its own --help with an example; docs/scenes.md says more.");
  AddGenerate(scene, common, run);
  AddSceneTrain(scene, common, run);
  AddSceneSample(scene, common, run);
  AddSceneEvaluate(scene, common, run);
  AddSceneFeatures(scene, common, run);
  AddSceneExport(scene, common, run);
  AddSceneView(scene, common, run);
}

}  // namespace simwright::cli
