#include "cli/scene_certify_command.h"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/findings_output.h"
#include "core/error.h"
#include "workflows/scenes/scene_certification.h"

namespace simwright::cli {
namespace {

struct CertifyFlags {
  workflows::SceneCertificationRequest request;
  std::vector<double> base;
};

int Certify(CertifyFlags flags, const CommonOptions& common) {
  workflows::SceneCertificationRequest& request = flags.request;
  request.seed = common.seed;
  request.force = common.force;
  if (!flags.base.empty()) {
    if (flags.base.size() != 4) {
      throw core::Error("the base needs four numbers, not " + std::to_string(flags.base.size()),
                        "--base", "give x,y,z,yaw in metres and radians");
    }
    request.base.emplace(flags.base[0], flags.base[1], flags.base[2], flags.base[3]);
  }
  core::Progress progress(common.ProgressStyle());
  const workflows::SceneCertificationReport report = workflows::CertifyScenes(request, &progress);
  if (common.json) {
    PrintJson(workflows::CertificationJson(report, true), report.findings);
  } else {
    PrintFindings(report.findings, common);
    std::fputs(workflows::CertificationTable(report).c_str(), stdout);
  }
  return 0;
}

}  // namespace

void AddSceneCertify(CLI::App* scene, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<CertifyFlags>();
  workflows::SceneCertificationRequest& request = flags->request;
  CLI::App* command = scene->add_subcommand(
      "certify", "Prove that a robot can do a task in a scene, or name what is in the way");
  command->footer(
      "Examples:\n  simwright scene certify out/pantry --task \"bring the apple to the front\" -o "
      "out/proof\n"
      "  simwright scene certify out/dimsum --scene 0-9 --task \"bring the cup to the teapot\" -o "
      "out/proof\n"
      "  simwright scene certify out/worlds/scene_00003 --task \"lift the second can\" -o "
      "out/proof\n"
      "The exit code is 0 for unsolvable scenes, too: certificate.json has the verdicts. See\n"
      "docs/steering.md.");
  command
      ->add_option("source", request.scene,
                   "A dataset, a scene folder of `scene export`, or a JSON file of poses")
      ->required();
  command->add_option("--scene", request.scenes, "The scenes of a dataset, e.g. 0,3-5")
      ->default_str("0");
  command->add_option("--task", request.task, "The task, e.g. \"bring the apple to the front\"")
      ->required();
  command->add_option("-o,--output", request.output, "The folder for the certificates")->required();
  command
      ->add_option("--base", flags->base,
                   "The robot's base: x,y,z in metres and the yaw in radians")
      ->delimiter(',')
      ->default_str("chosen for the furniture");
  command
      ->add_option("--candidates", request.candidates,
                   "Most grasps per object that are tried with the arm")
      ->capture_default_str();
  command->add_flag("--every", request.every,
                    "Certify each object that the task may mean, not only the easiest one");
  command->add_flag("--all-free", request.all_free,
                    "Let all objects move in the replays, also those far from the robot");
  command->add_flag("!--no-pictures", request.pictures, "Write no certificates.png");
  command
      ->add_option("--assets", request.assets,
                   "The folder of the categories' assets, if not the scene's")
      ->default_str("the scene's");
  command
      ->add_option("--grasps", request.grasps,
                   "The folder with NAME/grasps.json or NAME.json for each asset folder NAME (see "
                   "`simwright grasps`), or none: the planner samples all grasps")
      ->default_str("grasps.json in the assets' folders");
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([flags, common, run] { *run = [=] { return Certify(*flags, *common); }; });
}

}  // namespace simwright::cli
