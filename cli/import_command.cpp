#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/number_validators.h"
#include "cli/stated_options.h"
#include "core/error.h"
#include "core/json.h"
#include "physics_params/size_plausibility.h"
#include "workflows/import/import.h"

namespace simwright::cli {
namespace {

struct ImportFlags {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::string up, unit;
  workflows::ImportOptions options;
  bool no_check = false;
};

// Prefixes the places of findings with the asset's name.
core::Findings Placed(core::Findings findings, const std::string& name) {
  for (core::Finding& finding : findings) {
    if (finding.place.empty()) finding.place = name;
    if (finding.place != name && !finding.place.starts_with(name + ".")) {
      finding.place = name + ": " + finding.place;
    }
  }
  return findings;
}

core::OrderedJson ImportToJson(const workflows::ImportOutcome& outcome) {
  core::OrderedJson json;
  json["name"] = outcome.name;
  json["folder"] = outcome.folder.string();
  if (!outcome.refusal.empty()) json["refused"] = outcome.refusal;
  if (outcome.check) {
    json["passed"] = outcome.check->passed();
    json["grade"] = validation::GradeName(outcome.check->grade());
  }
  if (outcome.kept) json["kept"] = true;
  json["seconds"] = outcome.seconds;
  return json;
}

void PrintImportLine(const workflows::ImportOutcome& outcome) {
  if (!outcome.refusal.empty()) {
    std::printf("refused  %s\n", outcome.name.c_str());
    return;
  }
  if (outcome.kept) {
    std::printf("kept     %s\n", outcome.folder.c_str());
    return;
  }
  const char* const state =
      outcome.check ? validation::GradeSentence(outcome.check->grade()) : "written";
  std::printf("%s  %s  (%.1f s)\n", state, outcome.folder.c_str(), outcome.seconds.at("total"));
}

int CountRefused(const std::vector<workflows::ImportOutcome>& outcomes) {
  return static_cast<int>(std::count_if(outcomes.begin(), outcomes.end(), [](const auto& outcome) {
    return !outcome.refusal.empty();
  }));
}

int PrintOutcomesJson(const std::vector<workflows::ImportOutcome>& outcomes) {
  core::OrderedJson json;
  json["assets"] = core::OrderedJson::array();
  core::Findings all;
  for (const workflows::ImportOutcome& outcome : outcomes) {
    json["assets"].push_back(ImportToJson(outcome));
    const core::Findings placed = Placed(outcome.findings, outcome.name);
    all.insert(all.end(), placed.begin(), placed.end());
  }
  const int refused = CountRefused(outcomes);
  json["refused"] = refused;
  PrintJson(std::move(json), all);
  return refused > 0 ? 1 : 0;
}

int PrintOutcomes(const std::vector<workflows::ImportOutcome>& outcomes,
                  const CommonOptions& common) {
  const bool one = outcomes.size() == 1;
  int notes = 0;
  for (const workflows::ImportOutcome& outcome : outcomes) {
    if (one) {
      PrintFindings(outcome.findings, common);
      if (!outcome.refusal.empty()) return 1;
    } else {
      PrintWarnings(Placed(outcome.findings, outcome.name), common, &notes);
    }
    PrintImportLine(outcome);
  }
  const int refused = CountRefused(outcomes);
  if (one && !common.quiet) {
    std::printf("picture: %s\n", (outcomes[0].folder / "preview.png").c_str());
    const std::filesystem::path page = outcomes[0].folder / "import.html";
    if (std::filesystem::exists(page)) std::printf("report:  %s\n", page.c_str());
  } else if (!one) {
    std::printf("%zu imported, %d refused\n", outcomes.size() - static_cast<size_t>(refused),
                refused);
    if (notes > 0 && !common.quiet) {
      std::printf("%d notes are in the asset.json files and in --json\n", notes);
    }
  }
  return refused > 0 ? 1 : 0;
}

int Import(ImportFlags flags, const CommonOptions& common) {
  flags.options.seed = common.seed;
  flags.options.force = common.force;
  flags.options.check = !flags.no_check;
  flags.options.up = flags.up.empty() ? 0 : flags.up[0];
  flags.options.unit_stated = !flags.unit.empty();
  if (flags.options.unit_stated) {
    flags.options.unit = physics_params::MetresOfUnit(flags.unit);
  }
  asset_build::Validate(flags.options.size);
  Validate(flags.options.stated);
  Validate(flags.options.budget);
  if (!flags.options.category.empty()) physics_params::RequireCategory(flags.options.category);
  core::Progress progress(common.ProgressStyle());
  const std::vector<workflows::ImportItem> items =
      workflows::ListImports(flags.inputs, flags.options);
  const std::vector<workflows::ImportOutcome> outcomes =
      workflows::ImportAll(items, flags.output, flags.options, &progress);
  const bool one = outcomes.size() == 1;
  if (one && !outcomes[0].refusal.empty()) core::CheckCancelled();
  return common.json ? PrintOutcomesJson(outcomes) : PrintOutcomes(outcomes, common);
}

}  // namespace

void AddImport(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<ImportFlags>();
  CLI::App* command =
      app->add_subcommand("import", "Import meshes, URDFs and catalogues as assets");
  command->footer(
      "Example:\n  simwright import chair.glb --category chair -o assets\n"
      "  simwright import generated.glb --category mug --report -o assets\n"
      "  simwright import BlendSwap-CC-0.sh3f --only cup -o cups\n"
      "  simwright import partnet/45267 --height 0.8 -o cabinets\n"
      "Folders of PartNet-Mobility and GAPartNet, and other URDFs with joints, become "
      "articulated\n"
      "assets; without --height the former are scaled by their category.\n"
      "An input whose asset fails its check is refused; the exit code is then 1.");
  command
      ->add_option(
          "inputs", flags->inputs,
          "OBJ, PLY, STL, glTF, GLB, DAE or URDF files, folders of them, or .sh3f catalogues")
      ->required();
  command->add_option("-o,--output", flags->output, "The folder for the asset folders")->required();
  command->add_option("--category", flags->options.category, "The object's category, e.g. mug")
      ->default_str("from meta.json or the file's name");
  command->add_option("--up", flags->up, "The file's up axis")
      ->default_str("from the format, the category's proportions and stability")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command
      ->add_option("--unit", flags->unit,
                   "Unit of the file's coordinates; if given, no resulting size is refused")
      ->default_str("m")
      ->check(CLI::IsMember({"m", "cm", "mm", "in", "ft"}));
  command->add_option("--height", flags->options.height, "Scale to this height, m")
      ->check(Positive())
      ->default_str("from the unit");
  AddStatedOptions(command, &flags->options.size, &flags->options.stated);
  AddPartOptions(command, &flags->options.budget);
  command->get_option("--height")->excludes("--size");
  command
      ->add_option("--only", flags->options.only,
                   "Catalogues: only pieces whose name contains this")
      ->default_str("all");
  command->add_option("--limit", flags->options.limit, "Catalogues: the maximum number of pieces")
      ->check(CLI::NonNegativeNumber)
      ->default_str("all");
  command->add_flag("--resume", flags->options.resume,
                    "Keep existing assets and import the others");
  command->add_flag("--report", flags->options.report,
                    "Write import.html into each asset's folder: what was found and done, with "
                    "numbers and pictures before and after");
  command->add_flag("--no-check", flags->no_check, "Write assets without checking them");
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([flags, common, run] { *run = [=] { return Import(*flags, *common); }; });
}

}  // namespace simwright::cli
