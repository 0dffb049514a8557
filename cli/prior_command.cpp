#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "pipeline/prior_training.h"

namespace simwright::cli {
namespace {

struct Flags {
  pipeline::PriorTrainingRequest request;
  bool parametric_only = false;
};

int Train(Flags flags, const CommonOptions& common) {
  core::Progress progress(common.ProgressStyle());
  if (flags.request.catalogues.empty() && !flags.parametric_only) {
    flags.request.catalogues = {pipeline::DefaultTrainingCatalogue()};
  }
  flags.request.shape.seed = common.seed;
  pipeline::TrainPriors(flags.request, &progress, [&](const std::string& line) {
    if (!common.quiet) std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  });
  std::printf("weights: %s\n", flags.request.output.c_str());
  return 0;
}

}  // namespace

void AddPrior(CLI::App* app, CommonOptions* common, Run* run) {
  CLI::App* prior = app->add_subcommand("prior", "The learned priors of the lift");
  prior->require_subcommand(1);
  auto flags = std::make_shared<Flags>();
  CLI::App* command = prior->add_subcommand("train", "Train their weights anew");
  command->footer("Example (as the shipped weights were made):\n  simwright prior train -o models");
  command->add_option("catalogues", flags->request.catalogues,
                      "Furniture catalogues (.sh3f) to learn from; default: the CC0 one of Debian");
  command->add_flag("--parametric-only", flags->parametric_only,
                    "Learn from parametric shapes alone");
  command->add_option("-o,--output", flags->request.output, "Folder of the weights")->required();
  command->add_option("--steps", flags->request.shape.steps, "Steps of the shape prior")
      ->check(CLI::PositiveNumber);
  command->add_option("--batch", flags->request.shape.batch, "Photos a step")
      ->check(CLI::PositiveNumber);
  command->add_option("--pool", flags->request.shape.pool, "Objects kept ready")
      ->check(CLI::PositiveNumber);
  command->add_flag("--resume", flags->request.shape.resume,
                    "Go on from what an earlier run left in the folder");
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Train(*flags, *common); }; });
}

}  // namespace simwright::cli
