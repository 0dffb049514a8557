#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "core/json.h"
#include "viewer/contents/view.h"

namespace simwright::cli {
namespace {

void PrintAddress(const std::string& url, const core::Findings& findings,
                  const CommonOptions& common) {
  if (common.json) {
    PrintJson(core::OrderedJson{{"url", url}}, findings);
  } else {
    PrintFindings(findings, common);
    std::printf("%s  Ctrl-C ends it\n", url.c_str());
  }
  std::fflush(stdout);
}

int View(const viewer::ViewRequest& request, const CommonOptions& common) {
  if (request.html.empty()) {
    viewer::ServeView(request, [&](const std::string& url, const core::Findings& findings) {
      PrintAddress(url, findings, common);
    });
    return 0;
  }
  core::Progress progress(common.ProgressStyle());
  const viewer::ViewReport report = viewer::WriteView(request, &progress);
  progress.Finish();
  if (common.json) {
    PrintJson(viewer::ViewJson(report), report.findings);
  } else {
    std::fputs(viewer::ViewTable(report).c_str(), stdout);
    PrintFindings(report.findings, common);
  }
  return 0;
}

}  // namespace

void AddView(CLI::App* app, CommonOptions* common, Run* run) {
  auto request = std::make_shared<viewer::ViewRequest>();
  CLI::App* command =
      app->add_subcommand("view", "Show assets, scenes, tasks, rollouts and runs in a browser");
  command->footer(
      "Examples:\n"
      "  simwright view out/apple\n"
      "  simwright view out/dimsum --port 8080\n"
      "  simwright view tasks.json --html tasks.html\n"
      "The first serves a page on 127.0.0.1 and prints its address; files that change are read\n"
      "again. --html writes one file instead, which needs no server and no network.\n"
      "See docs/viewer.md.");
  command
      ->add_option("path", request->path,
                   "An asset, URDF, mesh, folder of assets, dataset of scenes, exported scene, "
                   "tasks.json, poses of a rollout, or a folder of `train` or `run`")
      ->required();
  CLI::Option* port =
      command->add_option("--port", request->port, "The port on 127.0.0.1; 0: a free one")
          ->check(CLI::Range(0, 65535))
          ->capture_default_str();
  CLI::Option* html =
      command->add_option("--html", request->html, "Write this file instead of serving")
          ->excludes(port);
  command
      ->add_option("--most", request->most, "Largest number of scenes, tasks or assets in the file")
      ->check(CLI::Range(1, 10000))
      ->needs(html)
      ->capture_default_str();
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([request, common, run] {
    *run = [=] {
      request->force = common->force;
      return View(*request, *common);
    };
  });
}

}  // namespace simwright::cli
