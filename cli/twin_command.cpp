#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/number_validators.h"
#include "cli/usage.h"
#include "core/json.h"
#include "workflows/twin/twin.h"

namespace simwright::cli {
namespace {

int Twin(workflows::TwinRequest request, const CommonOptions& common) {
  request.seed = common.seed;
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  const workflows::TwinOutcome outcome = workflows::MakeTwin(request, &progress);
  if (common.json) {
    core::OrderedJson json = core::ParseOrderedJson(workflows::TwinJson(outcome.record), "twin");
    json["folder"] = outcome.folder.string();
    json["page"] = outcome.page.string();
    json["seconds"] = outcome.seconds;
    PrintJson(json, outcome.findings);
    return 0;
  }
  if (!common.quiet) std::fputs(workflows::TwinTable(outcome).c_str(), stdout);
  PrintFindings(outcome.findings, common);
  std::printf("%s\n", outcome.page.c_str());
  return 0;
}

}  // namespace

void AddTwin(CLI::App* app, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::TwinRequest>();
  CLI::App* command = app->add_subcommand("twin", "Rebuild the objects on a table from one photo");
  command->footer(
      "Example (true sizes, with a camera 62 cm above the table):\n"
      "  simwright twin table.jpg --objects boxes.json --camera-height 0.62 -o twin\n"
      "  simwright view twin/twin.json\n"
      "boxes.json: {\"objects\": [{\"box\": [112, 140, 168, 201], \"category\": \"mug\"}]}");
  command->add_option("photo", request->photo, "A photo of a table, from above")->required();
  command->add_option("-o,--output", request->output, "The folder for the twin")->required();
  command->add_option("--objects", request->objects,
                      "JSON file with boxes, categories and masks, in place of the detector "
                      "(docs/twin.md)");
  command->add_option("--fov", request->camera.fov, "Horizontal field of view, degrees")
      ->default_str("from EXIF, else estimated");
  command
      ->add_option("--elevation", request->camera.elevation,
                   "Degrees by which the camera looks down")
      ->default_str("estimated");
  command
      ->add_option("--camera-height", request->camera.height,
                   "Metres of the camera above the table")
      ->default_str("by the usual sizes of the objects");
  command->add_flag("--upright", request->camera.upright, "The photo is not rolled");
  command
      ->add_option("--detector", request->detector,
                   "Weights of simwright prior train --only detector, in place of --objects")
      ->default_str("table_detector.pt beside the shipped weights; none is shipped yet");
  command->add_option("--most-objects", request->most_objects, "The largest detections are rebuilt")
      ->check(Positive())
      ->capture_default_str();
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([request, common, run] { *run = [=] { return Twin(*request, *common); }; });
}

}  // namespace simwright::cli
