#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/number_validators.h"
#include "core/error.h"
#include "core/image.h"
#include "core/json.h"
#include "library/articulated/articulated_kinds.h"
#include "library/rigid/rigid_kinds.h"
#include "workflows/library/library.h"

namespace simwright::cli {
namespace {

struct LibraryFlags {
  workflows::LibraryOptions options;
  std::filesystem::path output, sheet;
  bool list = false, no_check = false;
};

template <typename Kinds>
void ListKinds(const Kinds& kinds, const char* heading, bool rigid, bool as_json,
               core::OrderedJson* json) {
  if (!as_json) std::printf("%s:\n", heading);
  for (const auto& kind : kinds) {
    if (as_json) {
      json->push_back({{"kind", kind.name}, {"what", kind.what}, {"rigid", rigid}});
    } else {
      std::printf("  %-17s %s\n", kind.name.c_str(), kind.what.c_str());
    }
  }
}

int ListKinds(bool as_json) {
  core::OrderedJson kinds = core::OrderedJson::array();
  ListKinds(library::Kinds(), "articulated", false, as_json, &kinds);
  ListKinds(library::RigidKinds(), "\nrigid", true, as_json, &kinds);
  ListKinds(library::FurnitureKinds(), "\nfurniture", true, as_json, &kinds);
  if (as_json) PrintJson(core::OrderedJson{{"kinds", kinds}}, {});
  return 0;
}

core::OrderedJson KindToJson(const workflows::LibraryOutcome& outcome) {
  core::OrderedJson json;
  json["name"] = outcome.name;
  json["kind"] = outcome.kind;
  json["folder"] = outcome.folder.string();
  if (!outcome.refusal.empty()) json["refused"] = outcome.refusal;
  if (outcome.check) {
    json["passed"] = outcome.check->passed();
    json["grade"] = validation::GradeName(outcome.check->grade());
  }
  json["links"] = outcome.links;
  json["joints"] = outcome.joints;
  json["mass_kg"] = outcome.mass;
  json["seconds"] = outcome.seconds;
  return json;
}

void PrintKindLine(const workflows::LibraryOutcome& outcome) {
  if (!outcome.refusal.empty()) {
    std::printf("refused  %s\n", outcome.name.c_str());
    return;
  }
  const char* const state =
      outcome.check ? validation::GradeSentence(outcome.check->grade()) : "written";
  if (outcome.joints == 0) {
    std::printf("%s  %s  %.3f kg  (%.1f s)\n", state, outcome.folder.c_str(), outcome.mass,
                outcome.seconds);
    return;
  }
  std::printf("%s  %s  %d links, %d joints, %.2f kg  (%.1f s)\n", state, outcome.folder.c_str(),
              outcome.links, outcome.joints, outcome.mass, outcome.seconds);
}

int Library(LibraryFlags flags, const CommonOptions& common) {
  if (flags.list) return ListKinds(common.json);
  if (flags.output.empty()) {
    throw core::Error("no output folder is given", "", "give -o FOLDER, or --list");
  }
  flags.options.seed = common.seed;
  flags.options.force = common.force;
  flags.options.check = !flags.no_check;
  core::Progress progress(common.ProgressStyle());
  const std::vector<workflows::LibraryOutcome> outcomes =
      workflows::MakeLibrary(flags.options, flags.output, &progress);
  int refused = 0;
  int notes = 0;  // about the kinds, the same in every run
  core::Findings findings;
  core::OrderedJson json;
  json["assets"] = core::OrderedJson::array();
  for (const workflows::LibraryOutcome& outcome : outcomes) {
    refused += !outcome.refusal.empty();
    findings.insert(findings.end(), outcome.findings.begin(), outcome.findings.end());
    if (common.json) {
      json["assets"].push_back(KindToJson(outcome));
    } else {
      PrintWarnings(outcome.findings, common, &notes);
      PrintKindLine(outcome);
    }
  }
  if (common.json) {
    json["refused"] = refused;
    PrintJson(std::move(json), findings);
  } else if (outcomes.size() > 1) {
    std::printf("%zu made, %d refused\n", outcomes.size() - refused, refused);
  }
  if (!flags.sheet.empty()) core::WritePng(flags.sheet, workflows::LibrarySheet(outcomes));
  return refused > 0 ? 1 : 0;
}

}  // namespace

void AddLibrary(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<LibraryFlags>();
  CLI::App* command =
      app->add_subcommand("library", "Generate parametric household assets, articulated and rigid");
  command->footer(
      "Example:\n  simwright library --kind microwave --count 10 -o kitchen\n"
      "  simwright library --kind all -o library --sheet library.png\n"
      "  simwright library --kind mug --count 5 -o mugs\n"
      "An asset that fails its check is refused; the exit code is then 1.");
  command
      ->add_option("--kind", flags->options.kind,
                   "The kinds (see --list): all articulated ones (all), all rigid ones (rigid), "
                   "everything, the furniture of scenes (furniture), or several like mug,book")
      ->capture_default_str();
  command
      ->add_option("--count", flags->options.count,
                   "Number of assets per kind, with consecutive seeds")
      ->capture_default_str()
      ->check(Positive());
  command->add_option("-o,--output", flags->output, "The folder for the asset folders");
  command->add_option("--sheet", flags->sheet,
                      "Also write a contact sheet of all assets, articulated ones closed and open");
  command->add_flag("--list", flags->list, "List the kinds");
  command->add_flag("--no-check", flags->no_check, "Write assets without checking them");
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([flags, common, run] { *run = [=] { return Library(*flags, *common); }; });
}

}  // namespace simwright::cli
