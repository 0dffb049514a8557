#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/image_generator_options.h"
#include "cli/language_model_options.h"
#include "proposals/proposals.h"

namespace simwright::cli {
namespace {

struct ProposeFlags {
  proposals::ProposalRequest request;
  LanguageModelOptions language;
  ImageGeneratorFlags generator;
};

int ProposeCategories(const ProposeFlags& flags, const CommonOptions& common) {
  proposals::ProposalRequest request = flags.request;
  request.seed = common.seed;
  request.force = common.force;
  std::unique_ptr<llm::ChatModel> model;
  if (flags.language.given()) model = MakeLanguageModel(flags.language, common);
  request.model = model.get();
  std::unique_ptr<texture::ImageGenerator> generator;
  if (flags.generator.given()) generator = MakeFlaggedGenerator(flags.generator, common);
  request.generator = generator.get();
  core::Progress progress(common.ProgressStyle());
  const proposals::ProposalReport report = proposals::Propose(request, &progress);
  progress.Finish();
  const int code = report.interrupted ? kInterrupted : 0;
  if (report.interrupted) {
    std::fprintf(stderr, "error: stopped; %d pictures so far are kept in %s\n",
                 report.kept() + report.refused(), report.output.c_str());
  }
  if (common.json) {
    PrintJson(proposals::ProposalJson(request, report), report.findings);
    return code;
  }
  if (!common.quiet) std::fputs(proposals::ProposalTable(report).c_str(), stdout);
  PrintFindings(report.findings, common);
  if (model != nullptr && !common.quiet) std::printf("%s\n", UsageLine(model->usage()).c_str());
  std::printf("%zu categories, %d pictures kept, %d refused: %s\n", report.proposals.size(),
              report.kept(), report.refused(), (report.output / "proposals.json").c_str());
  return code;
}

}  // namespace

void AddPropose(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<ProposeFlags>();
  CLI::App* command = app->add_subcommand(
      "propose", "Propose categories of objects for a theme, with prompts and pictures");
  command->footer(
      "Examples:\n  simwright propose --theme kitchen --count 50 -o kitchen\n"
      "  simwright propose --theme workshop --generator http://localhost:7860 -o workshop\n"
      "  simwright propose --theme kitchen --images photos -o kitchen\n"
      "Pictures are kept if they show one whole object before an even background. See\n"
      "docs/propose.md.");
  proposals::ProposalRequest& request = flags->request;
  command
      ->add_option("--theme", request.theme,
                   "kitchen, dining, office, bathroom, workshop, toys, living room, grocery, "
                   "garden, or any noun")
      ->required();
  command->add_option("--count", request.count, "Number of categories")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--pictures", request.pictures, "Number of pictures of each category")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--size", request.size, "Pixels a side of fetched pictures")
      ->check(CLI::Range(64, 4096))
      ->capture_default_str();
  AddImageGenerator(command, &flags->generator);
  command
      ->add_option("--images", request.images,
                   "A folder of pictures instead: mug/*.jpg or mug_1.jpg")
      ->excludes("--generator");
  command->add_option("-o,--output", request.output, "The folder to write")->required();
  AddLanguageModel(command, &flags->language);
  AddCommon(command, common);
  AddForce(command, common);
  command->callback(
      [flags, common, run] { *run = [=] { return ProposeCategories(*flags, *common); }; });
}

}  // namespace simwright::cli
