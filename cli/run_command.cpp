#include <cstdio>
#include <map>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/number_validators.h"
#include "cli/training_options.h"
#include "cli/twin_options.h"
#include "cli/usage.h"
#include "core/error.h"
#include "transfer/twin_run.h"
#include "viewer/contents/view.h"
#include "workflows/photo_run/photo_run.h"
#include "workflows/photo_run/photo_run_folder.h"

namespace simwright::cli {
namespace {

struct RunFlags {
  std::filesystem::path mask;
  workflows::PhotoRunRequest request;
  transfer::TwinRunRequest twin;
  RobotBaseFlag robot;
};

// Takes the flags that both kinds of run share.
transfer::TwinRunRequest TwinRequestOf(const RunFlags& flags, const CommonOptions& common) {
  transfer::TwinRunRequest request = flags.twin;
  request.task = flags.request.task;
  request.robot = flags.robot.base();
  request.train.environments = flags.request.environments;
  request.train.samples = flags.request.samples;
  request.train.minutes = flags.request.minutes;
  request.train.target = flags.request.target;
  request.train.episodes = flags.request.episodes;
  request.train.imitated_samples = flags.request.imitated_samples;
  request.seed = common.seed;
  request.output = flags.request.output;
  request.resume = flags.request.resume;
  request.force = common.force;
  return request;
}

int RunOnTwin(const RunFlags& flags, const CommonOptions& common) {
  const transfer::TwinRunRequest request = TwinRequestOf(flags, common);
  core::Progress progress(common.ProgressStyle());
  try {
    const transfer::TwinRunOutcome outcome = transfer::RunTwin(request, &progress);
    if (common.json) {
      PrintJson(transfer::TwinRunJson(outcome), outcome.findings);
    } else {
      PrintFindings(outcome.findings, common);
      std::fputs(transfer::TwinRunTable(outcome).c_str(), stdout);
    }
  } catch (const core::Cancelled&) {
    progress.Finish();
    if (!std::filesystem::exists(request.output)) throw;
    return ReportStopped(request.output);
  }
  return 0;
}

// Throws CLI::ParseError unless a photo with its category, or a twin, is given.
void RequireRunSource(const CLI::App& command, const RunFlags& flags) {
  if (!flags.twin.twin.empty()) {
    for (const char* option : {"--mask", "--height", "--lift", "--furniture", "--category"}) {
      if (command.count(option) > 0) throw CLI::ValidationError(option, "is not for --twin");
    }
    return;
  }
  if (command.count("--no-randomization") > 0) {
    throw CLI::ValidationError("--no-randomization", "is for --twin");
  }
  if (flags.request.photo.empty()) throw CLI::RequiredError("photo, or --twin");
  if (flags.request.category.empty()) throw CLI::RequiredError("--category");
}

// Adds the options of a run on a twin.
void AddTwinRunOptions(CLI::App* command, CLI::Option* photo, RunFlags* flags) {
  CLI::Option* twin =
      command
          ->add_option("--twin", flags->twin.twin,
                       "A folder of `simwright twin`, in place of a photo: a task with its "
                       "objects is trained, exported and checked (docs/twin.md)")
          ->excludes(photo)
          ->default_str("none");
  AddRobotBase(command, &flags->robot)->needs(twin);
  AddSigmas(command, &flags->twin.sigmas)->needs(twin);
  AddNoRandomization(command, &flags->twin.train.randomized);
  command->add_option("--worlds", flags->twin.worlds, "Perturbed twins of the transfer check")
      ->check(CLI::Range(1, 100000))
      ->needs(twin)
      ->capture_default_str();
}

// Writes the page in 3D beside the run's page. The run is complete without it, so that its faults
// are warnings.
void WriteViewer(const workflows::PhotoRunRequest& request, core::Findings* findings) {
  viewer::ViewRequest view;
  view.path = request.output;
  view.html = workflows::PhotoRunFolder{request.output, ""}.Viewer();
  view.force = true;
  core::Progress silent;
  try {
    const viewer::ViewReport report = viewer::WriteView(view, &silent);
    findings->insert(findings->end(), report.findings.begin(), report.findings.end());
  } catch (const core::Error& error) {
    findings->push_back(
        {"run-no-viewer", core::Severity::kWarning, "", error.what(), 0.0, "see simwright view"});
  }
}

int RunOnPhoto(const RunFlags& flags, const CommonOptions& common) {
  workflows::PhotoRunRequest request = flags.request;
  if (!flags.mask.empty()) request.mask = flags.mask;
  request.seed = common.seed;
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  try {
    workflows::PhotoRunOutcome outcome = workflows::RunPhoto(request, &progress);
    WriteViewer(request, &outcome.findings);
    if (common.json) {
      PrintJson(outcome.json, outcome.findings);
    } else {
      PrintFindings(outcome.findings, common);
      std::fputs(workflows::PhotoRunTable(outcome).c_str(), stdout);
    }
  } catch (const core::Cancelled&) {
    if (!std::filesystem::exists(request.output)) throw;
    return ReportStopped(request.output);
  }
  return 0;
}

}  // namespace

void AddRun(CLI::App* app, CommonOptions* common, Run* run) {
  using asset_lift::LiftEffort;
  static const std::map<std::string, LiftEffort> efforts = {
      {"outline", LiftEffort::kOutline}, {"fast", LiftEffort::kFast}, {"full", LiftEffort::kFull}};
  auto flags = std::make_shared<RunFlags>();
  workflows::PhotoRunRequest* request = &flags->request;
  CLI::App* command = app->add_subcommand(
      "run", "Turn a photo, or a twin, into a task, a trained skill and a trajectory");
  command->footer(
      "Examples:\n  simwright run examples/apple.jpg --category apple -o apple_run\n"
      "  simwright run mug.png --category mug --task 'put_mug_into_*_and_close_it' -o mug_run\n"
      "  simwright run --twin twin --task pick_up_mug_1 -o mug_run\n"
      "Ctrl-C or a crash loses at most half a minute: the same command with --resume continues.\n"
      "See docs/run.md.");
  CLI::Option* photo =
      command->add_option("photo", request->photo, "PNG, JPEG, WebP, TIFF, GIF ... of one object")
          ->default_str("none: --twin");
  command->add_option("--category", request->category, "The object of the photo, e.g. apple")
      ->default_str("none");
  command->add_option("-o,--output", request->output, "The output folder")
      ->default_str("the name of the photo or twin with _run, in the current folder");
  command
      ->add_option("--task", request->task,
                   "One of the generated tasks, '*' matches any characters")
      ->default_str("pick up the asset, or an object of the twin");
  command->add_option("--mask", flags->mask, "Image that is bright where the object is");
  command->add_option("--height", request->height, "The object's true height, m")
      ->check(Positive())
      ->default_str("sampled from the category");
  AddChoice(command, "--lift", {"outline", "fast", "full"}, "fast",
            "Effort of the reconstruction (docs/lift.md)",
            [flags](const std::string& name) { flags->request.effort = efforts.at(name); });
  command
      ->add_option("--furniture", request->furniture,
                   "drawer_unit, microwave, or any: the first that fits")
      ->check(CLI::IsMember({"any", "drawer_unit", "microwave"}))
      ->capture_default_str();
  AddTwinRunOptions(command, photo, flags.get());
  AddTrainingOptions(command, &request->environments, &request->samples, &request->minutes,
                     &request->target, &request->episodes, &request->imitated_samples);
  command->add_flag("--resume", request->resume, "Resume an interrupted run");
  AddCommon(command, common);
  AddDevice(command);
  AddForce(command, common);
  command->callback([command, flags, common, run] {
    RequireRunSource(*command, *flags);
    const bool on_twin = !flags->twin.twin.empty();
    if (flags->request.output.empty()) {
      const std::filesystem::path source = on_twin ? flags->twin.twin : flags->request.photo;
      flags->request.output = (source / "").parent_path().stem().string() + "_run";
    }
    *run = [=] { return on_twin ? RunOnTwin(*flags, *common) : RunOnPhoto(*flags, *common); };
  });
}

}  // namespace simwright::cli
