#include <cstdio>
#include <map>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/number_validators.h"
#include "cli/training_options.h"
#include "cli/usage.h"
#include "core/error.h"
#include "viewer/contents/view.h"
#include "workflows/photo_run/photo_run.h"
#include "workflows/photo_run/photo_run_folder.h"

namespace simwright::cli {
namespace {

struct RunFlags {
  std::filesystem::path mask;
  workflows::PhotoRunRequest request;
};

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
      "run", "Turn a photo into an asset, a task, a trained skill and a trajectory, with one page");
  command->footer(
      "Examples:\n  simwright run examples/apple.jpg --category apple -o apple_run\n"
      "  simwright run mug.png --category mug --task 'put_mug_into_*_and_close_it' -o mug_run\n"
      "Ctrl-C or a crash loses at most half a minute: the same command with --resume continues.\n"
      "See docs/run.md.");
  command->add_option("photo", request->photo, "PNG, JPEG, WebP, TIFF, GIF ... of one object")
      ->required();
  command->add_option("--category", request->category, "The object's category, e.g. apple")
      ->required();
  command->add_option("-o,--output", request->output, "The output folder")
      ->default_str("the photo's name with _run, in the current folder");
  command
      ->add_option("--task", request->task,
                   "One of the generated tasks, '*' matches any characters")
      ->default_str("pick up the asset");
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
  AddTrainingOptions(command, &request->environments, &request->samples, &request->minutes,
                     &request->target, &request->episodes, &request->imitated_samples);
  command->add_flag("--resume", request->resume, "Resume an interrupted run");
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([flags, common, run] {
    if (flags->request.output.empty()) {
      flags->request.output = flags->request.photo.stem().string() + "_run";
    }
    *run = [=] { return RunOnPhoto(*flags, *common); };
  });
}

}  // namespace simwright::cli
