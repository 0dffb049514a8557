#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/language_model_options.h"
#include "cli/number_validators.h"
#include "cli/usage.h"
#include "core/error.h"
#include "core/json.h"
#include "workflows/twin/twin.h"

namespace simwright::cli {
namespace {

struct TwinFlags {
  workflows::TwinRequest request;
  std::vector<std::filesystem::path> photos, objects, depths;  // the latter of each photo, or none
  LanguageModelOptions vision;
};

// Returns the photos with their files, the first in the request itself.
workflows::TwinRequest RequestOf(const TwinFlags& flags) {
  const size_t count = flags.photos.size();
  const auto check = [count](const std::vector<std::filesystem::path>& files, const char* flag) {
    if (files.empty() || files.size() == count) return;
    throw core::Error("there are " + std::to_string(count) + " photos, and " +
                          std::to_string(files.size()) + " of these files",
                      flag, "give one for each photo, in their order");
  };
  check(flags.objects, "--objects");
  check(flags.depths, "--depth");
  workflows::TwinRequest request = flags.request;
  for (size_t i = 0; i < count; ++i) {
    workflows::TwinView view;
    view.photo = flags.photos[i];
    if (!flags.objects.empty()) view.objects = flags.objects[i];
    if (!flags.depths.empty()) view.depth = flags.depths[i];
    if (i == 0) {
      static_cast<workflows::TwinView&>(request) = view;
    } else {
      request.more.push_back(view);
    }
  }
  return request;
}

int Twin(const TwinFlags& flags, const CommonOptions& common) {
  workflows::TwinRequest request = RequestOf(flags);
  std::unique_ptr<llm::ChatModel> model;
  if (flags.vision.given()) model = MakeLanguageModel(flags.vision, common);
  request.model = model.get();
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
  if (model != nullptr && !common.quiet) std::printf("%s\n", UsageLine(model->usage()).c_str());
  std::printf("%s\n", outcome.page.c_str());
  return 0;
}

// Adds what states the camera, in place of what is estimated.
void AddCameraOptions(CLI::App* command, workflows::TwinRequest* request) {
  command->add_option("--camera", request->intrinsics,
                      "Calibration: JSON or YAML with fx, fy, cx, cy, or camera_info of ROS");
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
}

}  // namespace

void AddTwin(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<TwinFlags>();
  workflows::TwinRequest* request = &flags->request;
  CLI::App* command = app->add_subcommand("twin", "Rebuild the objects on a table from photos");
  command->footer(
      "Examples (true sizes, with a camera 62 cm above the table or a depth camera):\n"
      "  simwright twin table.jpg --objects boxes.json --camera-height 0.62 -o twin\n"
      "  simwright twin table.png --depth depth.png --camera camera_info.yaml -o twin\n"
      "  simwright twin table.jpg --llm http://localhost:8080/v1 --assets my_assets -o twin\n"
      "  simwright twin left.png right.png --depth left_depth.png --depth right_depth.png -o twin\n"
      "  simwright view twin/twin.json\n"
      "boxes.json: {\"objects\": [{\"box\": [112, 140, 168, 201], \"category\": \"mug\"}]}");
  command
      ->add_option("photo", flags->photos,
                   "A photo of a table, from above; or several from several sides")
      ->required();
  command->add_option("-o,--output", request->output, "The folder for the twin")->required();
  command
      ->add_option("--objects", flags->objects,
                   "JSON file with boxes, categories and masks, in place of the detector "
                   "(docs/twin.md); of several photos, once for each")
      ->allow_extra_args(false);
  CLI::Option* depth =
      command
          ->add_option("--depth", flags->depths,
                       "Depth image of the photo, 16-bit PNG of the same aspect: gives the table's "
                       "plane, the scale and the objects; of several photos, once for each")
          ->allow_extra_args(false);
  command->add_option("--depth-scale", request->depth_unit, "Metres of one step of --depth")
      ->check(Positive())
      ->needs(depth)
      ->capture_default_str();
  AddCameraOptions(command, request);
  command->add_option("--assets", request->assets,
                      "Asset folders, or folders of them: objects that are among them are found "
                      "again, with their true size");
  command->add_flag("--free-form", request->free_form,
                    "Reconstruct doubtful objects from the photo, about a minute each, in place of "
                    "the nearest kind");
  command
      ->add_option("--detector", request->detector,
                   "Weights of simwright prior train --only detector, in place of --objects")
      ->default_str("the shipped table_detector.pt");
  command->add_option("--most-objects", request->most_objects, "The largest detections are rebuilt")
      ->check(Positive())
      ->capture_default_str();
  AddLanguageModel(command, &flags->vision);
  AddCommon(command, common);
  AddDevice(command);
  AddForce(command, common);
  command->callback([flags, common, run] { *run = [=] { return Twin(*flags, *common); }; });
}

}  // namespace simwright::cli
