#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "core/finding.h"
#include "workflows/grasps/grasp_making.h"
#include "workflows/grasps/pick_test.h"

namespace simwright::cli {
namespace {

int Grasps(workflows::GraspRequest request, const CommonOptions& common) {
  request.seed = common.seed;
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  const std::vector<workflows::GraspReport> reports = workflows::MakeGrasps(request, &progress);
  core::Findings findings;
  for (const workflows::GraspReport& report : reports) {
    findings.insert(findings.end(), report.findings.begin(), report.findings.end());
  }
  if (common.json) {
    PrintJson(workflows::GraspReportsJson(reports), findings);
  } else {
    PrintFindings(findings, common);
    std::fputs(workflows::GraspTable(reports).c_str(), stdout);
  }
  const bool all = std::all_of(reports.begin(), reports.end(),
                               [](const auto& report) { return report.error.empty(); });
  return all ? 0 : 1;
}

int PickTest(const workflows::GraspRequest& request, int poses, const CommonOptions& common) {
  core::Progress progress(common.ProgressStyle());
  const auto rows = workflows::RunPickTest({request.assets, poses, common.seed}, &progress);
  if (common.json) {
    PrintJson(workflows::PickTestJson(rows), {});
  } else {
    std::fputs(workflows::PickTestTable(rows).c_str(), stdout);
  }
  return 0;
}

}  // namespace

void AddGrasps(CLI::App* app, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::GraspRequest>();
  CLI::App* command = app->add_subcommand(
      "grasps", "Find grasps of assets and prove them in simulation, in two engines");
  command->footer(
      "Examples:\n  simwright grasps mug -o mug_grasps.json\n"
      "  simwright grasps library/*_1 --count 50\n"
      "  simwright grasps library/cabinet_1 --count 60\n"
      "  simwright grasps mug --gripper robotiq.urdf --format isaac -o mug.yaml\n"
      "Each grasp closes, lifts by 20 cm, is shaken and holds for 2 s, in Bullet and in MuJoCo, at "
      "the low end of the object's friction. A grasp at the handle of an articulated asset moves "
      "its "
      "joint over 80 % of the range instead. A picture is written beside the file. The exit code "
      "is 1 if an asset has no grasp.");
  command->add_option("assets", request->assets, "Folders of assets, rigid or articulated")
      ->required();
  command
      ->add_option("--gripper", request->gripper,
                   "panda, or the URDF of a gripper with two sliding fingers")
      ->capture_default_str();
  command
      ->add_option("--count", request->count, "Proved grasps per asset, at most; joints share them")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--format", request->format,
                   "json (as GraspGen's), isaac (YAML), acronym (HDF5), mjcf (sites), usd (curves)")
      ->check(CLI::IsMember({"json", "isaac", "acronym", "mjcf", "usd"}))
      ->default_str("that of the file");
  command->add_option("-o,--output", request->output, "The file to write, for one asset")
      ->default_str("grasps.json in each asset's folder");
  auto poses = std::make_shared<int>(0);
  command
      ->add_option("--pick-test", *poses,
                   "Make no grasps: plan and simulate so many picks of each object by the Panda, "
                   "with its grasps.json and with grasps of the planner's own")
      ->check(CLI::Range(1, 1000))
      ->default_str("none");
  AddForce(command, common);
  AddCommon(command, common);
  command->callback([=] {
    *run = [=] {
      return *poses > 0 ? PickTest(*request, *poses, *common) : Grasps(*request, *common);
    };
  });
}

}  // namespace simwright::cli
