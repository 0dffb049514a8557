#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/number_validators.h"
#include "core/error.h"
#include "core/folder_lock.h"
#include "core/json.h"
#include "workflows/priors/prior_training.h"

namespace simwright::cli {
namespace {

struct PriorFlags {
  workflows::PriorTrainingRequest request;
  bool parametric_only = false;
  bool resume = false;
  int batch = 0, pool = 0, exchange = -1;  // 0 and -1: the defaults
  double rate = 0.0;                       // 0: the defaults
  double library_share = 0.25, parametric_share = 0.4;
  std::string from;
  std::string only;
};

void PrintPriorLine(const workflows::TrainedPrior& prior) {
  std::printf("%s prior, step %d, loss %.4f", prior.name.c_str(), prior.report.step,
              prior.report.loss);
  for (const auto& [metric, value] : prior.report.metrics) {
    std::printf(", %s %.4g", metric.c_str(), value);
  }
  std::printf(", %ld s\n", std::lround(prior.report.seconds));
  std::fflush(stdout);
}

void PrintTrainedJson(const std::vector<workflows::TrainedPrior>& trained) {
  core::OrderedJson json = core::OrderedJson::array();
  for (const workflows::TrainedPrior& prior : trained) {
    core::OrderedJson entry;
    entry["prior"] = prior.name;
    entry["weights"] = prior.weights.string();
    entry["steps"] = prior.report.step;
    entry["loss"] = prior.report.loss;
    for (const auto& [metric, value] : prior.report.metrics) entry["metrics"][metric] = value;
    entry["seconds"] = prior.report.seconds;
    json.push_back(entry);
  }
  PrintJson(core::OrderedJson{{"priors", json}}, {});
}

// Returns true if a training has left a state for --resume, or final weights.
bool HoldsState(const std::filesystem::path& folder) {
  return std::filesystem::exists(workflows::ShapeWeights(folder).string() + ".state") ||
         std::filesystem::exists(workflows::ViewWeights(folder).string() + ".state") ||
         std::filesystem::exists(workflows::LibraryWeights(folder).string() + ".state") ||
         std::filesystem::exists(workflows::DetectorWeights(folder).string() + ".state");
}

int TrainPriors(PriorFlags flags, const CommonOptions& common) {
  core::Progress progress(common.ProgressStyle());
  if (flags.request.catalogues.empty() && !flags.parametric_only) {
    flags.request.catalogues = {workflows::DefaultTrainingCatalogue()};
  }
  flags.request.shape = flags.only.empty() || flags.only == "shape";
  flags.request.view = flags.only.empty() || flags.only == "view";
  flags.request.library = flags.only.empty() || flags.only == "library";
  flags.request.detector = flags.only.empty() || flags.only == "detector";
  for (auto* options : {&flags.request.shape_options, &flags.request.view_options}) {
    options->seed = common.seed;
    options->trainer.resume = flags.resume;
    options->sampler_share = flags.library_share;
    options->parametric_share = flags.parametric_share;
    if (flags.batch > 0) options->batch = flags.batch;
    if (flags.pool > 0) options->pool = flags.pool;
    if (flags.exchange >= 0) options->exchange = flags.exchange;
    if (flags.rate > 0.0) options->trainer.learning_rate = flags.rate;
  }
  library_fit::LibraryTrainingOptions& library = flags.request.library_options;
  library.seed = common.seed;
  library.trainer.resume = flags.resume;
  if (flags.rate > 0.0) library.trainer.learning_rate = flags.rate;
  twin::DetectorTrainingOptions& detector = flags.request.detector_options;
  detector.seed = common.seed;
  detector.trainer.resume = flags.resume;
  if (flags.rate > 0.0) detector.trainer.learning_rate = flags.rate;
  if (!flags.from.empty()) {
    flags.request.shape_options.start = workflows::ShapeWeights(flags.from);
    flags.request.view_options.start = workflows::ViewWeights(flags.from);
    library.start = workflows::LibraryWeights(flags.from);
    detector.start = workflows::DetectorWeights(flags.from);
  }
  std::optional<core::FolderLock> lock;
  if (std::filesystem::exists(flags.request.output)) {
    lock.emplace(flags.request.output, "a training");
  }
  std::vector<workflows::TrainedPrior> trained;
  try {
    trained =
        workflows::TrainPriors(flags.request, &progress, [&](const workflows::TrainedPrior& prior) {
          if (!common.quiet && !common.json) PrintPriorLine(prior);
        });
  } catch (const core::Cancelled&) {
    if (!HoldsState(flags.request.output)) throw;
    progress.Finish();
    return ReportStopped(flags.request.output);
  }
  if (common.json) {
    PrintTrainedJson(trained);
  } else {
    for (const workflows::TrainedPrior& prior : trained) {
      std::printf("weights: %s\n", prior.weights.c_str());
    }
  }
  return 0;
}

}  // namespace

void AddPrior(CLI::App* app, CommonOptions* common, Run* run) {
  CLI::App* prior = app->add_subcommand("prior", "The learned priors of reconstruction");
  prior->require_subcommand(1);
  auto flags = std::make_shared<PriorFlags>();
  CLI::App* command = prior->add_subcommand("train", "Train the priors");
  command->footer(
      "Example (about three hours on two cores, less on a GPU):\n"
      "  simwright prior train -o models");
  command
      ->add_option("catalogues", flags->request.catalogues,
                   "Furniture catalogues (.sh3f) to train on")
      ->default_str("Debian's CC0 catalogue");
  command->add_flag("--parametric-only", flags->parametric_only,
                    "Train without a catalogue, on parametric shapes and the library's kinds");
  command
      ->add_option("--library-share", flags->library_share,
                   "Share of instances of the library's kinds among the objects of shape and view "
                   "prior")
      ->check(CLI::Range(0.0, 0.6))
      ->capture_default_str();
  command
      ->add_option("--parametric-share", flags->parametric_share,
                   "Share of parametric shapes; the rest are models of the catalogues")
      ->check(CLI::Range(0.0, 0.4))
      ->capture_default_str();
  command
      ->add_option("--shape-channels", flags->request.shape_options.shape_channels,
                   "Channels of the shape prior's levels, separated by commas: up to six multiples "
                   "of 8")
      ->delimiter(',')
      ->default_str("48,96,192,256");
  command->add_option("-o,--output", flags->request.output, "The folder for the weights")
      ->required();
  command->add_option("--only", flags->only, "Train only one of the four")
      ->default_str("all")
      ->check(CLI::IsMember({"shape", "view", "library", "detector"}));
  command
      ->add_option("--shape-steps", flags->request.shape_options.trainer.steps,
                   "Steps of the shape prior")
      ->capture_default_str();
  command
      ->add_option("--view-steps", flags->request.view_options.trainer.steps,
                   "Steps of the view prior")
      ->capture_default_str();
  command
      ->add_option("--library-steps", flags->request.library_options.trainer.steps,
                   "Steps of the library prior")
      ->capture_default_str();
  command
      ->add_option("--detector-steps", flags->request.detector_options.trainer.steps,
                   "Steps of the detector of objects on tables")
      ->capture_default_str();
  command
      ->add_option("--detector-pool", flags->request.detector_options.pool,
                   "Pictures in memory for the detector (200 KB each)")
      ->check(Positive())
      ->capture_default_str();
  command
      ->add_option("--photos", flags->request.photos,
                   "Photos, or folders of them, behind and below the objects in the pictures of "
                   "detector and library prior")
      ->default_str("patterns alone");
  command
      ->add_option("--library-pool", flags->request.library_options.pool,
                   "Pictures in memory for the library prior")
      ->check(Positive())
      ->capture_default_str();
  command->add_option("--batch", flags->batch, "Photos per step of shape and view prior")
      ->check(Positive())
      ->default_str("16");
  command->add_option("--pool", flags->pool, "Number of objects in the pool")
      ->check(Positive())
      ->default_str("160");
  command
      ->add_option("--exchange", flags->exchange,
                   "Objects of the pool that each step replaces by new ones")
      ->check(CLI::NonNegativeNumber)
      ->default_str("1");
  command
      ->add_option("--fresh", flags->request.shape_options.fresh,
                   "Photos per step of the shape prior that are newly rendered; 0: all. A GPU "
                   "learns faster than processors render")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--memory", flags->request.shape_options.memory,
                   "Photos kept for later steps, from which --fresh draws (300 KB each)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--library-batch", flags->request.library_options.batch,
                   "Pictures per step of the library prior")
      ->check(Positive())
      ->capture_default_str();
  command
      ->add_option("--library-exchange", flags->request.library_options.exchange,
                   "Pictures of the library prior that each step replaces by new ones")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--table-share", flags->request.library_options.scene_share,
                   "Share of the library prior's pictures that show an object on a table, among "
                   "others")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--rate", flags->rate, "Learning rate")
      ->check(Positive())
      ->default_str("8e-4 shape, 1e-3 view, 1.5e-3 library, 2e-3 detector");
  command->add_option(
      "--from", flags->from,
      "Folder of initial weights of the priors that are trained, to fine-tune them");
  command->add_flag("--resume", flags->resume, "Resume an earlier run in the folder");
  AddCommon(command, common);
  AddDevice(command);
  command->callback([flags, common, run] { *run = [=] { return TrainPriors(*flags, *common); }; });
}

}  // namespace simwright::cli
