#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "workflows/skills/skill_replay.h"

namespace simwright::cli {
namespace {

int Replay(const workflows::ReplayRequest& request, const CommonOptions& common) {
  core::Progress progress(common.ProgressStyle());
  const workflows::ReplayReport report = workflows::Replay(request, &progress);
  progress.Finish();
  if (common.json) {
    PrintJson(workflows::ReplayJson(report), {});
  } else {
    std::fputs(workflows::ReplayTable(report).c_str(), stdout);
  }
  return report.successes > 0 ? 0 : 1;
}

}  // namespace

void AddReplay(CLI::App* app, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::ReplayRequest>();
  CLI::App* command =
      app->add_subcommand("replay", "Replay exported motions and demonstrations in simulation");
  command->footer(
      "Examples:\n  simwright replay open.yaml\n  simwright replay open.hdf5 --run open\n"
      "The exit code is 1 if none succeeds. See docs/export.md.");
  command
      ->add_option(
          "files", request->files,
          "Files written by `simwright export` (YAML, JSON, CSV, HDF5), or folders of them")
      ->required();
  command->add_option("--run", request->run, "The folder written by `simwright train`")
      ->default_str("from the file");
  AddCommon(command, common);
  command->callback([request, common, run] { *run = [=] { return Replay(*request, *common); }; });
}

}  // namespace simwright::cli
