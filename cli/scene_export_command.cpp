#include "cli/scene_export_command.h"

#include <cstdio>
#include <memory>

#include "cli/findings_output.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "workflows/scenes/scene_export.h"

namespace simwright::cli {
namespace {

int ExportScenes(workflows::SceneExportRequest request, const std::vector<std::string>& formats,
                 const CommonOptions& common) {
  request.formats = {formats.begin(), formats.end()};
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  const workflows::SceneExportReport report = workflows::ExportScenes(request, &progress);
  if (common.json) {
    PrintJson(workflows::ExportJson(report), {});
  } else {
    std::fputs(workflows::ExportTable(report).c_str(), stdout);
  }
  return report.StableFraction() < 1.0 ? 1 : 0;
}

struct ViewFlags {
  std::filesystem::path dataset, assets, output;
  int scene = 0, size = 700;
};

int View(const ViewFlags& flags, const CommonOptions& common) {
  if (std::filesystem::exists(flags.output) && !common.force) {
    throw core::Error("already exists", flags.output.string(), "--force replaces it");
  }
  core::WritePng(flags.output,
                 workflows::SceneView(flags.dataset, flags.assets, flags.scene, flags.size));
  if (common.json) {
    PrintJson(core::OrderedJson{{"picture", flags.output.string()}}, {});
  } else if (!common.quiet) {
    std::printf("picture: %s\n", flags.output.c_str());
  }
  return 0;
}

}  // namespace

void AddSceneExport(CLI::App* scene, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::SceneExportRequest>();
  auto formats = std::make_shared<std::vector<std::string>>(1, "all");
  CLI::App* command =
      scene->add_subcommand("export", "Export scenes of a dataset as world files for simulators");
  command->footer(
      "Example:\n  simwright scene export out/dimsum --scene 0,3-5 --format all -o out/worlds\n"
      "--check simulates each scene for 2 s in MuJoCo and Bullet; the exit code is 1 if one is\n"
      "not stable. See docs/formats.md for the files.");
  command
      ->add_option("dataset", request->dataset, "A dataset written by `simwright scene generate`")
      ->required();
  CLI::Option* const scenes =
      command->add_option("--scene", request->scenes, "The scenes' indices, e.g. 0,3-5")
          ->default_str("all");
  command->add_option("--count", request->count, "The number of leading scenes")
      ->default_str("all")
      ->excludes(scenes);
  command
      ->add_option("--format", *formats,
                   "urdf, sdf, mjcf, drake, usd or all; several separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("-o,--output", request->output, "The folder for the world files")->required();
  command->add_option("--assets", request->assets,
                      "The folder of the categories' assets, if not the dataset's");
  command->add_flag("--check", request->check, "Check which scenes are stable in both engines");
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([request, formats, common, run] {
    *run = [=] { return ExportScenes(*request, *formats, *common); };
  });
}

void AddSceneView(CLI::App* scene, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<ViewFlags>();
  CLI::App* command = scene->add_subcommand("view", "Render a scene from above and from the side");
  command->footer("Example:\n  simwright scene view out/dimsum --scene 3 -o scene.png");
  command->add_option("dataset", flags->dataset, "A dataset written by `simwright scene generate`")
      ->required();
  command->add_option("--scene", flags->scene, "The scene's index")->capture_default_str();
  command->add_option("-o,--output", flags->output, "The output image (PNG)")->required();
  command->add_option("--assets", flags->assets,
                      "The folder of the categories' assets, if not the dataset's");
  command->add_option("--size", flags->size, "Side of each view, pixels")->capture_default_str();
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([flags, common, run] { *run = [=] { return View(*flags, *common); }; });
}

}  // namespace simwright::cli
