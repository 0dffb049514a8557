#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "pipeline/skill_replay.h"

namespace simwright::cli {
namespace {

int Replay(const pipeline::ReplayRequest& request, const CommonOptions& common) {
  core::Progress progress(common.ProgressStyle());
  const pipeline::ReplayReport report = pipeline::Replay(request, &progress);
  progress.Finish();
  if (common.json) {
    PrintJson(pipeline::ReplayJson(report), {});
  } else {
    std::fputs(pipeline::ReplayTable(report).c_str(), stdout);
  }
  return report.successes > 0 ? 0 : 1;
}

}  // namespace

void AddReplay(CLI::App* app, CommonOptions* common, Run* run) {
  auto request = std::make_shared<pipeline::ReplayRequest>();
  CLI::App* command = app->add_subcommand(
      "replay", "Whether exported motions and demonstrations do their task, in simulation");
  command->footer(
      "Examples:\n  simwright replay open.yaml\n  simwright replay open.hdf5 --run open\n"
      "Exit code 1 where none succeeds. docs/export.md says more.");
  command
      ->add_option("files", request->files,
                   "What `simwright export` wrote: YAML, JSON, CSV, HDF5, or folders of them")
      ->required();
  command->add_option("--run", request->run,
                      "The folder of `simwright train`")
      ->default_str("where the file says");
  AddCommon(command, common);
  command->callback([request, common, run] { *run = [=] { return Replay(*request, *common); }; });
}

}  // namespace simwright::cli
