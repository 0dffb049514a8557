#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/image_generator_options.h"
#include "core/error.h"
#include "factory/factory.h"

namespace simwright::cli {
namespace {

struct FactoryFlags {
  factory::FactoryRequest request;
  ImageGeneratorFlags generator;
};

int Factory(const FactoryFlags& flags, const CommonOptions& common) {
  factory::FactoryRequest request = flags.request;
  request.theme.seed = common.seed;
  request.place = core::ThisRank();
  if (flags.generator.given()) request.generator = MakeFlaggedGenerator(flags.generator, common);
  core::Progress progress(common.ProgressStyle());
  try {
    const factory::FactoryReport report = factory::RunFactory(request, &progress);
    if (!request.place.leads()) return report.state.made() > 0 ? 0 : 1;
    if (common.json) {
      PrintJson(factory::FactoryJson(report), report.findings);
    } else {
      int notes = 0;
      PrintWarnings(report.findings, common, &notes);
      if (!common.quiet) std::fputs(factory::FactoryTable(report).c_str(), stdout);
      std::printf("%s\n", report.page.c_str());
    }
    return report.state.made() > 0 ? 0 : 1;
  } catch (const core::Cancelled&) {
    progress.Finish();
    return ReportStopped(request.output);
  }
}

}  // namespace

void AddFactory(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<FactoryFlags>();
  CLI::App* command =
      app->add_subcommand("factory", "Make hundreds of assets and tasks from one line");
  command->footer(
      "Examples:\n  simwright factory --theme kitchen --assets 200 --tasks 500 -o kitchen\n"
      "  simwright factory plan.json -o out\n"
      "  simwright factory --resume -o kitchen\n"
      "The dashboard is kitchen/index.html. More workers join with --resume, also on other "
      "machines\n"
      "that share the folder, or are ranks of mpirun or tasks of a Slurm array (docs/scale.md).\n"
      "See docs/factory.md.");
  factory::FactoryRequest& request = flags->request;
  auto* plan = command->add_option("plan", request.plan, "A plan of sources (docs/factory.md)");
  plan->default_str("none");
  auto* theme =
      command->add_option("--theme", request.theme.theme, "The theme of the library's objects")
          ->excludes(plan)
          ->default_str("none");
  command->add_option("--assets", request.theme.assets, "Number of assets of a theme")
      ->needs(theme)
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--tasks", request.theme.tasks, "Number of verified tasks of a theme")
      ->needs(theme)
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  command
      ->add_option("--variants", request.theme.variants,
                   "Texture variants of each asset of a theme")
      ->needs(theme)
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("-o,--output", request.output, "The factory's folder")->required();
  command->add_flag("--resume", request.resume, "Resume the folder's work, or join it");
  AddImageGenerator(command, &flags->generator);
  AddCommon(command, common);
  AddDevice(command);
  command->callback([flags, common, run] { *run = [=] { return Factory(*flags, *common); }; });
}

}  // namespace simwright::cli
