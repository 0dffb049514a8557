#include <cstdio>
#include <map>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/usage.h"
#include "workflows/skills/skill_export.h"

namespace simwright::cli {
namespace {

int ExportSkillOrAsset(const workflows::ExportRequest& given, const CommonOptions& common) {
  workflows::ExportRequest request = given;
  request.seed = common.seed;
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  const workflows::ExportReport report = workflows::Export(request, &progress);
  progress.Finish();
  if (common.json) {
    PrintJson(workflows::ExportJson(report), report.findings);
    return 0;
  }
  if (!common.quiet) std::fputs(workflows::ExportTable(report).c_str(), stdout);
  PrintFindings(report.findings, common);
  std::printf("%s\n", report.output.c_str());
  return 0;
}

}  // namespace

void AddExport(CLI::App* app, CommonOptions* common, Run* run) {
  using workflows::ExportFormat;
  static const std::map<std::string, ExportFormat> formats = {
      {"ros2", ExportFormat::kRos2},
      {"csv", ExportFormat::kCsv},
      {"robomimic", ExportFormat::kRobomimic}};
  auto request = std::make_shared<workflows::ExportRequest>();
  CLI::App* command = app->add_subcommand(
      "export", "Export trained skills as robot trajectories or demonstrations");
  command->footer(
      "Examples:\n  simwright export open --format ros2 --joint-names fr3 -o open.yaml\n"
      "  simwright export open --format robomimic --episodes 50 -o open.hdf5\n"
      "Trajectories respect the robot's limits, at 1 kHz from rest to rest. `simwright replay`\n"
      "verifies them. See docs/export.md.");
  command->add_option("run", request->run, "A folder written by `simwright train`")->required();
  AddChoice(command, "--format", {"ros2", "csv", "robomimic"}, "",
            "ros2 (YAML, or JSON by the extension), csv, robomimic",
            [request](const std::string& name) { request->format = formats.at(name); })
      ->required();
  command
      ->add_option("-o,--output", request->output,
                   "The output file, or a folder for several trajectories")
      ->required();
  command->add_option("--joint-names", request->joint_names,
                      "The controller's joint names: panda, fr3 (also applies that robot's "
                      "limits), or a JSON file; default: the robot's own names");
  command
      ->add_option(
          "--pace", request->at_recorded_speed,
          "limits: as fast as the limits and the task allow; recorded: at most as recorded")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, bool>{{"limits", false}, {"recorded", true}}))
      ->default_str("limits");
  command->add_option("--episodes", request->episodes, "Number of successful episodes")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  AddCommon(command, common);
  AddForce(command, common);
  command->callback(
      [request, common, run] { *run = [=] { return ExportSkillOrAsset(*request, *common); }; });
}

}  // namespace simwright::cli
