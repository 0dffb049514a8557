#include <cstdio>
#include <memory>

#include "cli/category_folders.h"
#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/scene_certify_command.h"
#include "cli/scene_export_command.h"
#include "cli/scene_model_commands.h"
#include "cli/scene_posttrain_command.h"
#include "cli/scene_search_command.h"
#include "cli/scene_steering_commands.h"
#include "core/error.h"
#include "core/json.h"
#include "scene/scene_types/scene_types.h"
#include "workflows/scenes/scene_generation.h"

namespace simwright::cli {
namespace {

struct GenerateFlags {
  workflows::SceneGenerationRequest request;
  std::vector<std::string> chosen;  // "apple=out/my_apple"
  bool list = false;
};

int ListSceneTypes(const CommonOptions& common) {
  core::OrderedJson types = core::OrderedJson::array();
  for (const scene::SceneType& type : scene::SceneTypes()) {
    types.push_back({{"type", type.name}, {"what", type.what}});
    if (!common.json) std::printf("%-18s %s\n", type.name.c_str(), type.what.c_str());
  }
  if (common.json) PrintJson(core::OrderedJson{{"types", types}}, {});
  return 0;
}

// Reports the end of a task of a Slurm array before the last one.
int ReportElsewhere(int shards, const CommonOptions& common) {
  if (common.json) {
    PrintJson(core::OrderedJson{{"parts_elsewhere", shards}}, {});
  } else {
    std::printf("%d shards are being made by other tasks; the last task reports the dataset\n",
                shards);
  }
  return 0;
}

int Generate(GenerateFlags flags, const CommonOptions& common) {
  if (flags.list) return ListSceneTypes(common);
  if (flags.request.type.empty() || flags.request.output.empty()) {
    throw core::Error("scenes need a type and an output", "",
                      "give --type dimsum -o FOLDER, or --list");
  }
  flags.request.seed = common.seed;
  flags.request.place = core::ThisRank();
  flags.request.chosen = ParseCategoryFolders(flags.chosen, "--asset");
  core::Progress progress(common.ProgressStyle());
  const workflows::SceneStatistics statistics = workflows::GenerateScenes(flags.request, &progress);
  if (!flags.request.place.leads()) return 0;
  if (!statistics.reported) return ReportElsewhere(statistics.elsewhere, common);
  if (common.json) {
    PrintJson(workflows::StatisticsJson(statistics), statistics.findings);
    return 0;
  }
  PrintFindings(statistics.findings, common);
  std::fputs(workflows::StatisticsTable(statistics).c_str(), stdout);
  return 0;
}

void AddGenerate(CLI::App* scene, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<GenerateFlags>();
  workflows::SceneGenerationRequest& request = flags->request;
  CLI::App* command = scene->add_subcommand(
      "generate", "Generate a dataset of physically valid scenes from a grammar");
  command->footer(
      "Example:\n  simwright scene generate --type dimsum --count 100 -o out/dimsum\n"
      "  simwright scene generate --type pantry_shelf --count 20 --asset apple=out/apple -o "
      "pantry\n"
      "Several processes may write into one folder, also ranks of mpirun and tasks of a Slurm "
      "array\n"
      "(docs/scale.md); an interrupted one continues when called again. See docs/scenes.md.");
  command->add_option("--type", request.type, "The scene type, see --list");
  command->add_option("--count", request.count, "Number of scenes in the dataset")
      ->capture_default_str();
  command->add_option("-o,--output", request.output, "The dataset folder");
  command
      ->add_option("--assets", request.assets,
                   "Asset folders, matched by name or category and preferred to the library")
      ->default_str("only the library");
  command->add_option("--asset", flags->chosen, "SLOT=FOLDER: use this asset for this category");
  command->add_option("--hull", request.hulls,
                      "Categories whose assets collide as convex hulls, without cavities");
  command->add_option("--part", request.part, "Scenes per shard, the unit of work of one worker")
      ->capture_default_str();
  command->add_option("--step", request.time_step, "Time step of the physics, s")
      ->default_str("validated default");
  command->add_flag("--raw", request.raw,
                    "Keep the grammar's scenes without physics, for the training of models: they "
                    "take milliseconds, but interpenetrate a little and do not rest");
  command->add_flag("--list", flags->list, "List the types");
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Generate(*flags, *common); }; });
}

}  // namespace

void AddScene(CLI::App* app, CommonOptions* common, Run* run) {
  CLI::App* scene = app->add_subcommand("scene", "Cluttered, physically valid scenes");
  scene->require_subcommand(1);
  scene->footer(
      "Example:\n  simwright scene generate --type dimsum --count 100 -o out/dimsum\n"
      "Each subcommand has its own --help with an example. See docs/scenes.md.");
  AddGenerate(scene, common, run);
  AddSceneTrain(scene, common, run);
  AddSceneSample(scene, common, run);
  AddSceneComplete(scene, common, run);
  AddSceneRearrange(scene, common, run);
  AddScenePosttrain(scene, common, run);
  AddSceneCertify(scene, common, run);
  AddSceneSearch(scene, common, run);
  AddSceneEvaluate(scene, common, run);
  AddSceneFeatures(scene, common, run);
  AddSceneExport(scene, common, run);
  AddSceneView(scene, common, run);
}

}  // namespace simwright::cli
