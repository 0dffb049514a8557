#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <map>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/usage.h"
#include "core/error.h"
#include "transfer/motion_choice.h"
#include "workflows/export/asset_export.h"
#include "workflows/skills/image_recording.h"
#include "workflows/skills/policy_export.h"
#include "workflows/skills/skill_export.h"
#include "workflows/skills/task_world_export.h"

namespace simwright::cli {
namespace {

using workflows::ExportFormat;
using workflows::PolicyFormat;

const std::map<std::string, ExportFormat> kMotionFormats = {
    {"ros2", ExportFormat::kRos2},
    {"csv", ExportFormat::kCsv},
    {"robomimic", ExportFormat::kRobomimic}};
const std::map<std::string, PolicyFormat> kPolicyFormats = {
    {"onnx", PolicyFormat::kOnnx}, {"torchscript", PolicyFormat::kTorchScript}};

constexpr char kUsd[] = "usd";
constexpr char kGlb[] = "glb";
const std::vector<std::string> kWorldFormats = {"mjcf", "sdf", "drake"};
// Formats of demonstrations with images; robomimic is one only with --cameras.
const std::vector<std::string> kImageFormats = {"lerobot", "mcap"};

struct ExportFlags {
  std::filesystem::path run, output;
  std::string skill, subtask, format, task, robot = "panda";
  bool world = false, sampled = false;
  workflows::ExportRequest motions;
  workflows::ImageRecordingRequest recording;
  bool stated_cameras = false;
  transfer::MotionChoiceRequest choice;  // with --twin
};

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool IsModel(const ExportFlags& flags) {
  return !flags.world && (flags.format == kUsd || flags.format == kGlb);
}

bool HasImages(const ExportFlags& flags) {
  return Contains(kImageFormats, flags.format) ||
         (flags.format == "robomimic" && flags.stated_cameras);
}

// Exports the motion that holds best in a twin.
int ExportChosenMotion(const ExportFlags& flags, const CommonOptions& common) {
  transfer::MotionChoiceRequest request = flags.choice;
  request.run = flags.run;
  request.output = flags.output;
  request.seed = common.seed;
  core::Progress progress(common.ProgressStyle());
  const transfer::MotionChoice choice = transfer::ExportChosenMotion(request, &progress);
  progress.Finish();
  if (common.json) {
    PrintJson(transfer::MotionChoiceJson(choice), {});
    return 0;
  }
  if (!common.quiet) std::fputs(transfer::MotionChoiceTable(choice).c_str(), stdout);
  std::printf("%s\n", choice.file.c_str());
  return 0;
}

int ExportMotions(const ExportFlags& flags, const CommonOptions& common) {
  if (!flags.choice.twin.empty()) return ExportChosenMotion(flags, common);
  workflows::ExportRequest request = flags.motions;
  request.run = flags.run;
  request.output = flags.output;
  request.format = kMotionFormats.at(flags.format);
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

int ExportModels(const ExportFlags& flags, const CommonOptions& common) {
  workflows::PolicyExportRequest request;
  request.run = flags.run;
  request.skill = flags.skill;
  request.subtask = flags.subtask;
  request.format = kPolicyFormats.at(flags.format);
  request.output = flags.output;
  request.force = common.force;
  const workflows::PolicyExportReport report = workflows::ExportPolicies(request);
  if (common.json) {
    PrintJson(workflows::PolicyExportJson(report), {});
    return 0;
  }
  if (!common.quiet) std::fputs(workflows::PolicyExportTable(report).c_str(), stdout);
  std::printf("%s\n", report.output.c_str());
  return 0;
}

int ExportWorld(const ExportFlags& flags, const CommonOptions& common) {
  workflows::TaskWorldExportRequest request;
  request.source = flags.run;
  request.task = flags.task;
  request.subtask = flags.subtask;
  request.robot = flags.robot;
  request.format = flags.format;
  if (flags.sampled) request.start_seed = common.seed;
  request.output = flags.output;
  request.force = common.force;
  const workflows::TaskWorldExportReport report = workflows::ExportTaskWorld(request);
  if (common.json) {
    PrintJson(workflows::TaskWorldJson(report), report.findings);
    return 0;
  }
  if (!common.quiet) std::fputs(workflows::TaskWorldTable(report).c_str(), stdout);
  PrintFindings(report.findings, common);
  std::printf("%s\n", (report.output / report.file).c_str());
  return 0;
}

int ExportModel(const ExportFlags& flags, const CommonOptions& common) {
  const workflows::AssetExportReport report = workflows::ExportAsset(
      {flags.run, flags.output, common.force,
       flags.format == kGlb ? workflows::AssetFormat::kGlb : workflows::AssetFormat::kUsd});
  if (common.json) {
    PrintJson(workflows::AssetExportJson(report), report.findings);
    return 0;
  }
  if (!common.quiet) std::fputs(workflows::AssetExportTable(report).c_str(), stdout);
  PrintFindings(report.findings, common);
  std::printf("%s\n", (report.output / report.file).c_str());
  return 0;
}

int ExportImages(const ExportFlags& flags, const CommonOptions& common) {
  workflows::ImageRecordingRequest request = flags.recording;
  request.run = flags.run;
  request.skill = flags.skill;
  request.format = flags.format;
  request.output = flags.output;
  request.episodes = flags.motions.episodes;
  request.seed = common.seed;
  request.threads = common.threads;
  request.quiet = common.quiet;
  request.json = common.json;
  if (common.force) {
    throw core::Error("is not for data sets with images", "--force", "remove the old one yourself");
  }
  workflows::RecordWithPython(request);
}

int ExportAs(const ExportFlags& flags, const CommonOptions& common) {
  if (flags.world) return ExportWorld(flags, common);
  if (IsModel(flags)) return ExportModel(flags, common);
  if (HasImages(flags)) return ExportImages(flags, common);
  return kPolicyFormats.contains(flags.format) ? ExportModels(flags, common)
                                               : ExportMotions(flags, common);
}

// Throws CLI::ParseError for an option that the chosen kind of export does not use.
void RequireUsedOptions(const CLI::App& command, const ExportFlags& flags) {
  const bool images = HasImages(flags);
  const auto refuse = [&command](std::initializer_list<const char*> options, const char* what) {
    for (const char* option : options) {
      if (command.count(option) > 0) throw CLI::ValidationError(option, what);
    }
  };
  if (!images) {
    refuse({"--image-size", "--look", "--policy", "--keep"},
           "needs --format lerobot or mcap, or --cameras");
  } else {
    refuse({"--joint-names", "--pace"}, "is not for demonstrations with images");
  }
  const bool motion = !images && (flags.format == "ros2" || flags.format == "csv");
  if (!motion) {
    refuse({"--twin"}, "needs --format ros2 or csv");
  } else if (!flags.choice.twin.empty()) {
    refuse({"--joint-names", "--pace", "--episodes"}, "is not for the motion that --twin chooses");
  }
  if (IsModel(flags)) {
    refuse({"--joint-names", "--pace", "--episodes", "--sampled-start"},
           "is not for --format usd and glb");
  }
}

// Throws CLI::ParseError for flags that do not belong together.
void RequireExportSource(const ExportFlags& flags) {
  const bool policy = kPolicyFormats.contains(flags.format);
  const bool world = flags.world || Contains(kWorldFormats, flags.format);
  const bool images = HasImages(flags);
  const auto need = [](bool ok, const char* option, const char* what) {
    if (!ok) throw CLI::ValidationError(option, std::string("needs ") + what);
  };
  need(!flags.world || flags.format == kUsd || Contains(kWorldFormats, flags.format), "--world",
       "--format mjcf, sdf, drake or usd");
  need(flags.world || !world, "--format", "--world for mjcf, sdf and drake");
  need(world || flags.task.empty(), "--task", "--world");
  need(world || flags.robot == "panda", "--robot", "--world");
  need(policy || images || flags.skill.empty(), "--skill",
       "--format onnx, torchscript, lerobot or mcap, or --cameras");
  need(images || !flags.stated_cameras, "--cameras", "--format lerobot, mcap or robomimic");
  need(policy || world || flags.subtask.empty(), "--subtask", "a policy or --world");
  if (flags.run.empty() && flags.skill.empty()) {
    throw CLI::RequiredError(
        world            ? "a folder written by `simwright train`, or a tasks.json with --task NAME"
        : IsModel(flags) ? "the folder of an asset"
        : policy || images ? "a folder written by `simwright train`, or --skill NAME"
                           : "a folder written by `simwright train`");
  }
}

void AddWorldOptions(CLI::App* command, ExportFlags* flags) {
  command->add_flag("--world", flags->world,
                    "Export the robot, furniture and objects of a task as one world (mjcf, sdf, "
                    "drake, usd)");
  command->add_option("--task", flags->task, "With --world: the task")
      ->default_str("the folder's first");
  command->add_option("--robot", flags->robot,
                      "With --world and a tasks.json: panda, panda_on_base, or a URDF");
  command->add_flag("--sampled-start", flags->sampled,
                    "With --world: a start sampled with --seed as in an evaluation, not the start "
                    "that the task describes");
}

void AddMotionOptions(CLI::App* command, workflows::ExportRequest* motions) {
  command->add_option("--joint-names", motions->joint_names,
                      "The controller's joint names: panda, fr3 (also applies that robot's "
                      "limits), or a JSON file; default: the robot's own names");
  command
      ->add_option(
          "--pace", motions->at_recorded_speed,
          "limits: as fast as the limits and the task allow; recorded: at most as recorded")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, bool>{{"limits", false}, {"recorded", true}}))
      ->default_str("limits");
  command->add_option("--episodes", motions->episodes, "Number of successful episodes")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
}

void AddRecordingOptions(CLI::App* command, const std::shared_ptr<ExportFlags>& flags) {
  workflows::ImageRecordingRequest& recording = flags->recording;
  command
      ->add_option(
          "--cameras", recording.cameras,
          "Demonstrations with images: front, wrist, shoulder, several with commas, or none")
      ->default_str("front,wrist; robomimic: no images")
      ->each([flags](const std::string&) { flags->stated_cameras = true; });
  command->add_option("--image-size", recording.image_size, "Pixels a side of the images")
      ->check(CLI::Range(8, 4096))
      ->capture_default_str();
  AddChoice(command, "--look", {"none", "wide"}, "none", "How the looks of images are randomised",
            [flags](const std::string& name) { flags->recording.look = name; });
  AddChoice(command, "--policy", {"expert", "shipped"}, "",
            "What acts in demonstrations with images: the scripted expert, or the trained policy",
            [flags](const std::string& name) { flags->recording.policy = name; });
  AddChoice(command, "--keep", {"successes", "all"}, "successes",
            "Which episodes with images are kept",
            [flags](const std::string& name) { flags->recording.keep = name; });
}

}  // namespace

void AddExport(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<ExportFlags>();
  CLI::App* command = app->add_subcommand("export",
                                          "Export skills as trajectories, demonstrations or "
                                          "networks, tasks as worlds, and assets as USD or GLB");
  command->footer(
      "Examples:\n  simwright export open --format ros2 --joint-names fr3 -o open.yaml\n"
      "  simwright export open --format robomimic --episodes 50 -o open.hdf5\n"
      "  simwright export --skill pick_up_cup --format onnx -o pick_up_cup.onnx\n"
      "  simwright export --skill open_drawer --format lerobot --episodes 50 -o drawers\n"
      "  simwright export tasks.json --task open_drawer_unit_1_drawer_1 --world --format mjcf -o "
      "w\n"
      "  simwright export pick --format ros2 --twin twin -o pick.yaml\n"
      "  simwright export lib/mug_1 --format usd -o mug_usd\n"
      "  simwright export lib/mug_1 --format glb -o mug.glb\n"
      "Trajectories respect the robot's limits, at 1 kHz from rest to rest. `simwright replay`\n"
      "verifies them. Networks map an observation to an action (docs/export.md). Demonstrations\n"
      "with images (lerobot, mcap, robomimic with --cameras) are written by the Python package\n"
      "(docs/demonstrations.md).");
  CLI::Option* folder = command
                            ->add_option("run", flags->run,
                                         "A folder written by `simwright train`; with --world also "
                                         "a tasks.json; for usd and glb "
                                         "the folder of an asset")
                            ->default_str("none");
  command
      ->add_option("--skill", flags->skill,
                   "A shipped policy instead of a folder (onnx, torchscript, or images)")
      ->excludes(folder);
  command->add_option("--subtask", flags->subtask, "Only the policy or world of this subtask");
  AddWorldOptions(command, flags.get());
  AddChoice(command, "--format",
            {"ros2", "csv", "robomimic", "lerobot", "mcap", "onnx", "torchscript", "usd", "glb",
             "mjcf", "sdf", "drake"},
            "",
            "ros2 (YAML, or JSON by the extension), csv, robomimic, onnx, torchscript; with images "
            "lerobot, mcap; of an asset usd, glb; with --world mjcf, sdf, drake, usd",
            [flags](const std::string& name) { flags->format = name; })
      ->required();
  command
      ->add_option("-o,--output", flags->output,
                   "The output file, or a folder for a world or several files")
      ->required();
  AddMotionOptions(command, &flags->motions);
  command
      ->add_option("--twin", flags->choice.twin,
                   "The twin of the run's task: of the motions of 16 episodes, the one that holds "
                   "in most perturbed twins (docs/twin.md)")
      ->default_str("none: the first successful episodes");
  AddRecordingOptions(command, flags);
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([command, flags, common, run] {
    RequireExportSource(*flags);
    RequireUsedOptions(*command, *flags);
    *run = [=] { return ExportAs(*flags, *common); };
  });
}

}  // namespace simwright::cli
