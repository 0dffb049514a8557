#include <cstdio>
#include <memory>

#include "assets/asset_folder.h"
#include "cli/command.h"
#include "core/error.h"
#include "pipeline/check.h"

namespace simwright::cli {
namespace {

struct Flags {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path root;
};

int Check(const Flags& flags, const CommonOptions& common) {
  bool all_pass = true;
  std::string json;
  for (const std::filesystem::path& input : flags.inputs) {
    if (!std::filesystem::exists(input)) throw core::Error("no such file or folder", input);
    const bool folder = std::filesystem::is_directory(input);
    if (folder && !assets::IsAssetFolder(input)) {
      throw core::Error("holds no asset.json", input.string(),
                        "give an asset's folder or a .urdf file");
    }
    const pipeline::CheckReport report =
        folder ? pipeline::CheckAsset(input) : pipeline::CheckUrdf(input, flags.root);
    all_pass = all_pass && report.passed();
    if (common.json) {
      json += (json.empty() ? "[" : ",\n") + pipeline::CheckJson(report);
    } else {
      std::fputs(pipeline::CheckTable(report).c_str(), stdout);
    }
  }
  if (common.json) std::printf("%s]\n", json.c_str());
  return all_pass ? 0 : 1;
}

}  // namespace

void AddCheck(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command =
      app->add_subcommand("check", "Geometry, inertia, readers, a drop test, and how joints swing");
  command->footer(
      "Example:\n  simwright check apple\n"
      "Exit code 1 when a property fails.");
  command->add_option("inputs", flags->inputs, "Asset folders or URDF files")->required();
  command->add_option("--root", flags->root,
                      "URDF: no file outside this folder is read; default: the URDF's own");
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Check(*flags, *common); }; });
}

}  // namespace simwright::cli
