#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "core/error.h"
#include "transfer/transfer_check.h"
#include "workflows/skills/skill_replay.h"

namespace simwright::cli {
namespace {

struct ReplayFlags {
  workflows::ReplayRequest request;
  std::filesystem::path twin;
  int worlds = transfer::TransferRequest().worlds;
};

// Checks the transfer of a motion: the exit code is 1 if it succeeds in no perturbed twin.
int CheckTransfer(const ReplayFlags& flags, const CommonOptions& common) {
  if (flags.request.files.size() != 1) {
    throw core::Error("--twin checks one motion at a time",
                      std::to_string(flags.request.files.size()) + " files", "name one file");
  }
  core::Progress progress(common.ProgressStyle());
  transfer::TransferRequest request;
  request.motion = flags.request.files.front();
  request.twin = flags.twin;
  request.run = flags.request.run;
  request.worlds = flags.worlds;
  request.seed = common.seed;
  const transfer::TransferReport report = transfer::CheckTransfer(request, &progress);
  progress.Finish();
  if (common.json) {
    PrintJson(transfer::TransferJson(report), report.findings);
  } else {
    std::fputs(transfer::TransferTable(report).c_str(), stdout);
    PrintFindings(report.findings, common);
  }
  return report.replay.rate.successes > 0 ? 0 : 1;
}

int Replay(const ReplayFlags& flags, const CommonOptions& common) {
  if (!flags.twin.empty()) return CheckTransfer(flags, common);
  const workflows::ReplayRequest& request = flags.request;
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
  auto flags = std::make_shared<ReplayFlags>();
  CLI::App* command =
      app->add_subcommand("replay", "Replay exported motions and demonstrations in simulation");
  command->footer(
      "Examples:\n  simwright replay open.yaml\n  simwright replay open.hdf5 --run open\n"
      "  simwright replay pick.yaml --twin twin --worlds 200\n"
      "With --twin the motion, and the policy that it comes from, are tried in worlds that differ\n"
      "from the twin as far as it is uncertain: the transfer check of docs/twin.md, of one motion "
      "file.\n"
      "The exit code is 1 if no replay succeeds. See docs/export.md.");
  command
      ->add_option(
          "files", flags->request.files,
          "Files written by `simwright export` (YAML, JSON, CSV, HDF5), or folders of them")
      ->required();
  command->add_option("--run", flags->request.run, "The folder written by `simwright train`")
      ->default_str("from the file");
  CLI::Option* twin =
      command
          ->add_option("--twin", flags->twin,
                       "Check the transfer: replay in this twin, perturbed within its uncertainty")
          ->default_str("none");
  command->add_option("--worlds", flags->worlds, "Perturbed twins of the transfer check")
      ->check(CLI::Range(1, 100000))
      ->needs(twin)
      ->capture_default_str();
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Replay(*flags, *common); }; });
}

}  // namespace simwright::cli
