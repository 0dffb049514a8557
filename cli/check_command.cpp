#include <algorithm>
#include <cstdio>
#include <memory>

#include "assets/asset_folder.h"
#include "assets/mesh_import.h"
#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/usage.h"
#include "core/error.h"
#include "core/json.h"
#include "validation/check.h"
#include "validation/check_folder.h"
#include "workflows/check/sim_ready_check.h"

namespace simwright::cli {
namespace {

struct CheckFlags {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path root;
  bool sim_ready = false;
};

// The reports of all inputs; `many` is true if an input is a folder of assets.
struct Checked {
  std::vector<validation::CheckReport> reports;
  bool many = false;
};

void CheckInput(const std::filesystem::path& input, const CheckFlags& flags,
                core::Progress* progress, Checked* checked) {
  if (!std::filesystem::exists(input)) throw core::Error("no such file or folder", input);
  if (!std::filesystem::is_directory(input)) {
    if (assets::HasMeshExtension(input)) {
      throw core::Error("is a mesh, not an asset or a URDF", input.string(),
                        "import it first: simwright import " + input.string() + " -o out");
    }
    checked->reports.push_back(validation::CheckUrdf(input, flags.root));
    return;
  }
  const auto check = [&flags](const std::filesystem::path& folder) {
    return flags.sim_ready ? workflows::CheckSimReady(folder) : validation::CheckAsset(folder);
  };
  if (assets::IsAssetFolder(input)) {
    checked->reports.push_back(check(input));
    return;
  }
  const std::vector<std::filesystem::path> folders = validation::AssetFoldersIn(input);
  if (folders.empty()) {
    throw core::Error("has no asset.json, and neither has any folder in it", input.string(),
                      "give an asset folder, a folder of asset folders, or a .urdf file");
  }
  checked->many = true;
  for (validation::CheckReport& report : validation::CheckFolders(folders, progress, check)) {
    checked->reports.push_back(std::move(report));
  }
}

int PrintReportsJson(const std::vector<validation::CheckReport>& reports, bool passed) {
  core::OrderedJson json = {{"passed", passed}};
  json["reports"] = core::OrderedJson::array();
  core::Findings findings;
  for (const validation::CheckReport& report : reports) {
    json["reports"].push_back(core::ParseOrderedJson(validation::CheckJson(report), "the report"));
    const core::Findings rows = validation::NotableResults(report);
    findings.insert(findings.end(), rows.begin(), rows.end());
  }
  PrintJson(std::move(json), findings);
  return passed ? 0 : 1;
}

int Check(const CheckFlags& flags, const CommonOptions& common) {
  core::Progress progress(common.ProgressStyle());
  Checked checked;
  for (const std::filesystem::path& input : flags.inputs) {
    CheckInput(input, flags, &progress, &checked);
  }
  const std::vector<validation::CheckReport>& reports = checked.reports;
  const bool passed = std::all_of(reports.begin(), reports.end(),
                                  [](const auto& report) { return report.passed(); });
  if (common.json) return PrintReportsJson(reports, passed);
  if (checked.many) {
    std::fputs(validation::CheckSummary(reports).c_str(), stdout);
  } else {
    for (const validation::CheckReport& report : reports) {
      std::fputs(validation::CheckTable(report).c_str(), stdout);
    }
  }
  return passed ? 0 : 1;
}

}  // namespace

void AddCheck(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<CheckFlags>();
  CLI::App* command = app->add_subcommand(
      "check", "Check geometry, inertia, file readers, a drop test, and joint motion");
  command->footer(
      "Examples:\n  simwright check apple\n  simwright check assets\n"
      "  simwright check assets --profile simready\n"
      "A folder of assets gives one line per asset. The exit code is 1 if a check fails.");
  command
      ->add_option("inputs", flags->inputs,
                   "Asset folders, folders of asset folders, or URDF files")
      ->required();
  command->add_option("--root", flags->root, "URDF: do not read files outside this folder")
      ->default_str("the URDF's own folder");
  AddChoice(command, "--profile", {"asset", "simready"}, "asset",
            "What is examined: simready adds a drop from 10 cm, slopes, a stack and grasps, in "
            "Bullet and MuJoCo",
            [flags](const std::string& name) { flags->sim_ready = name == "simready"; });
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Check(*flags, *common); }; });
}

}  // namespace simwright::cli
