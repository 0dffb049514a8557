#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "core/error.h"
#include "pipeline/import.h"

namespace simwright::cli {
namespace {

struct Flags {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::string up, unit = "m";
  pipeline::ImportOptions options;
  bool no_check = false;
};

double MetresPer(const std::string& unit) {
  if (unit == "mm") return 0.001;
  if (unit == "cm") return 0.01;
  if (unit == "in") return 0.0254;
  if (unit == "ft") return 0.3048;
  return 1.0;
}

nlohmann::ordered_json ToJson(const pipeline::ImportOutcome& outcome) {
  nlohmann::ordered_json json;
  json["name"] = outcome.name;
  json["folder"] = outcome.folder.string();
  if (!outcome.refusal.empty()) json["refused"] = outcome.refusal;
  if (outcome.check) {
    json["passed"] = outcome.check->passed();
    json["grade"] = pipeline::GradeName(outcome.check->grade());
  }
  if (outcome.kept) json["kept"] = true;
  json["seconds"] = outcome.seconds;
  return json;
}

void PrintLine(const pipeline::ImportOutcome& outcome) {
  if (!outcome.refusal.empty()) {
    std::printf("refused  %s: %s\n", outcome.name.c_str(), outcome.refusal.c_str());
    return;
  }
  if (outcome.kept) {
    std::printf("kept     %s\n", outcome.folder.c_str());
    return;
  }
  std::printf("%s  %s  (%.1f s)\n", outcome.check ? pipeline::GradeSentence(outcome.check->grade()) : "written", outcome.folder.c_str(),
              outcome.seconds.at("total"));
}

int Import(Flags flags, const CommonOptions& common) {
  flags.options.seed = common.seed;
  flags.options.force = common.force;
  flags.options.check = !flags.no_check;
  flags.options.up = flags.up.empty() ? 0 : flags.up[0];
  flags.options.unit = MetresPer(flags.unit);
  if (!flags.options.category.empty()) physics_params::RequireCategory(flags.options.category);
  core::Progress progress(common.ProgressStyle());
  const std::vector<pipeline::ImportItem> items =
      pipeline::ListImports(flags.inputs, flags.options);
  const std::vector<pipeline::ImportOutcome> outcomes =
      pipeline::ImportAll(items, flags.output, flags.options, &progress);
  if (outcomes.size() == 1 && !outcomes[0].refusal.empty()) {
    core::CheckCancelled();
    throw core::Error(outcomes[0].refusal);
  }
  int refused = 0;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const pipeline::ImportOutcome& outcome : outcomes) {
    refused += !outcome.refusal.empty();
    if (common.json) {
      list.push_back(ToJson(outcome));
    } else {
      PrintLine(outcome);
    }
  }
  if (common.json) {
    std::printf("%s\n", list.dump(2).c_str());
  } else if (outcomes.size() > 1) {
    std::printf("%zu imported, %d refused\n", outcomes.size() - refused, refused);
  } else if (!common.quiet) {
    std::printf("picture: %s\n", (outcomes[0].folder / "preview.png").c_str());
  }
  return refused > 0 ? 1 : 0;
}

}  // namespace

void AddImport(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command = app->add_subcommand("import", "Meshes, URDFs and catalogues become assets");
  command->footer(
      "Example:\n  simwright import chair.glb --category chair -o assets\n"
      "  simwright import BlendSwap-CC-0.sh3f --only cup -o cups\n"
      "  simwright import partnet/45267 --height 0.8 -o cabinets\n"
      "PartNet-Mobility's and GAPartNet's folders, and other URDFs with joints, become "
      "articulated\n"
      "assets; without --height the former are scaled by their category.\n"
      "A mesh whose asset would fail its check is refused. Exit code 1 when any was.");
  command
      ->add_option("inputs", flags->inputs,
                   "OBJ, PLY, STL, glTF, GLB, DAE, URDF, folders of them, or .sh3f catalogues")
      ->required();
  command->add_option("-o,--output", flags->output, "Folder for the assets, one folder each")
      ->required();
  command->add_option("--category", flags->options.category,
                      "What it is; default: by meta.json or the file's name");
  command->add_option("--up", flags->up, "Axis that points up in the file")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command->add_option("--unit", flags->unit, "Unit of the file's coordinates")
      ->capture_default_str()
      ->check(CLI::IsMember({"m", "cm", "mm", "in", "ft"}));
  command->add_option("--height", flags->options.height, "Scale to this height, m")
      ->check(CLI::PositiveNumber);
  command->add_option("--only", flags->options.only, "Catalogues: pieces with this in the name");
  command->add_option("--limit", flags->options.limit, "Catalogues: at most so many pieces")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--resume", flags->options.resume,
                    "Keep assets that are there, import the others");
  command->add_flag("--no-check", flags->no_check, "Write assets unchecked, good or not");
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([flags, common, run] { *run = [=] { return Import(*flags, *common); }; });
}

}  // namespace simwright::cli
