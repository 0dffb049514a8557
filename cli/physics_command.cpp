#include <cstdio>
#include <memory>

#include "assets/asset_folder.h"
#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/language_model_options.h"
#include "cli/stated_options.h"
#include "core/error.h"
#include "core/finding.h"
#include "core/json.h"
#include "physics_params/category_estimate.h"
#include "physics_params/category_resolution.h"
#include "physics_params/physical_parameters.h"

namespace simwright::cli {
namespace {

using physics_params::Estimate;
using physics_params::PhysicalParameters;

struct PhysicsFlags {
  std::string category;
  std::filesystem::path asset;
  physics_params::VariantChoice variant;
  LanguageModelOptions language_model;
};

// The parameters to print, with their findings.
struct Result {
  PhysicalParameters parameters;
  core::Findings findings;
  std::string usage;  // one line; empty if no model was queried
};

core::OrderedJson PhysicsToJson(const Estimate& e) {
  return {{"min", e.min}, {"max", e.max}, {"sample", e.sample}};
}

// Returns the same object as asset.json holds.
core::OrderedJson IntervalsToJson(const physics_params::StatedIntervals& stated) {
  const auto range = [](const physics_params::Interval& one) {
    return core::OrderedJson::array({one.min, one.max});
  };
  return {{"longest_side_m", range(stated.longest_side)},
          {"mass_kg", range(stated.mass)},
          {"friction", range(stated.friction)},
          {"basis", stated.basis}};
}

void PrintResultJson(const Result& result) {
  const PhysicalParameters& p = result.parameters;
  core::OrderedJson json;
  json["category"] = p.category;
  json["resolution"] = p.resolution;
  json["length_m"] = PhysicsToJson(p.length);
  json["width_m"] = PhysicsToJson(p.width);
  json["height_m"] = PhysicsToJson(p.height);
  json["mass_kg"] = PhysicsToJson(p.mass);
  json["material"] = p.material;
  json["fill"] = physics_params::FillName(p.fill);
  json["shape"] = physics_params::ShapeName(p.shape);
  json["density_kg_m3"] = PhysicsToJson(p.density);
  json["friction"] = PhysicsToJson(p.friction);
  json["restitution"] = PhysicsToJson(p.restitution);
  if (p.intervals.probability > 0.0) json["interval_90"] = IntervalsToJson(p.intervals);
  json["sources"] = {{"length", p.length.source},
                     {"width", p.width.source},
                     {"height", p.height.source},
                     {"mass", p.mass.source},
                     {"material", p.density.source}};
  PrintJson(std::move(json), result.findings);
}

void PrintRow(const char* name, const Estimate& e, const char* unit) {
  std::printf("  %-12s %9.4g to %-9.4g sample %-9.4g %s\n", name, e.min, e.max, e.sample, unit);
}

// Prints the intervals that hold with a stated probability, if there are any.
void PrintIntervals(const physics_params::StatedIntervals& stated) {
  if (!(stated.probability > 0.0)) return;
  std::printf("  90 %% intervals %s:\n", stated.basis.c_str());
  const auto print = [](const char* name, const physics_params::Interval& range, const char* unit) {
    std::printf("  %-12s %9.4g to %-9.4g %s\n", name, range.min, range.max, unit);
  };
  print("longest side", stated.longest_side, "m");
  print("mass", stated.mass, "kg");
  print("friction", stated.friction, "");
}

// Prints "size and mass: ..." if all have the same source, else one line per quantity.
void PrintSources(const PhysicalParameters& p) {
  const std::string& one = p.length.source;
  if (p.width.source == one && p.height.source == one && p.mass.source == one) {
    std::printf("  size and mass: %s\n", one.c_str());
  } else {
    std::printf("  length: %s\n  width: %s\n  height: %s\n  mass: %s\n", one.c_str(),
                p.width.source.c_str(), p.height.source.c_str(), p.mass.source.c_str());
  }
  std::printf("  material: %s\n", p.density.source.c_str());
}

void PrintTable(const Result& result, bool quiet) {
  const PhysicalParameters& p = result.parameters;
  std::printf("%s (%s)\n", p.category.c_str(), p.resolution.c_str());
  PrintRow("length", p.length, "m");
  PrintRow("width", p.width, "m");
  PrintRow("height", p.height, "m");
  PrintRow("mass", p.mass, "kg");
  PrintRow("density", p.density,
           ("kg/m3, " + p.material + ", " + physics_params::FillName(p.fill)).c_str());
  PrintRow("friction", p.friction, "");
  PrintRow("restitution", p.restitution, "");
  PrintIntervals(p.intervals);
  PrintSources(p);
  if (quiet) return;
  if (!result.usage.empty()) std::printf("  %s\n", result.usage.c_str());
}

Result AskModel(const PhysicsFlags& flags, const CommonOptions& common) {
  const physics_params::KnowledgeBase& base = physics_params::KnowledgeBase::Shipped();
  const std::unique_ptr<llm::ChatModel> model = MakeLanguageModel(flags.language_model, common);
  core::Progress progress(common.ProgressStyle());
  const physics_params::EstimatedCategory estimate = physics_params::EstimateCategory(
      flags.category, base, physics_params::WordNet::Installed(), model.get(), &progress);
  progress.Finish();
  return {physics_params::SampleEstimate(estimate, base, common.seed), estimate.findings,
          UsageLine(model->usage())};
}

int Physics(const PhysicsFlags& flags, const CommonOptions& common) {
  Result result;
  if (!flags.asset.empty()) {
    if (flags.language_model.given()) {
      throw core::Error("an asset already has its parameters", flags.asset.string(),
                        "--llm and --replay need --category");
    }
    result.parameters = assets::ReadAsset(flags.asset).parameters;
  } else if (flags.category.empty()) {
    throw core::Error("nothing to look up", "", "give --category NAME or an asset folder");
  } else if (flags.language_model.given()) {
    result = AskModel(flags, common);
  } else {
    const physics_params::Resolution resolution = physics_params::RequireCategory(flags.category);
    const physics_params::KnowledgeBase& base = physics_params::KnowledgeBase::Shipped();
    result.parameters = physics_params::SampleParameters(
        physics_params::ChosenRow(resolution, flags.variant, base), base, common.seed);
    result.parameters.resolution = resolution.sentence;
    result.findings = physics_params::ResolutionFindings(resolution, flags.category);
  }
  if (common.json) {
    PrintResultJson(result);
  } else {
    PrintFindings(result.findings, common);
    PrintTable(result, common.quiet);
  }
  return 0;
}

}  // namespace

void AddPhysics(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<PhysicsFlags>();
  CLI::App* command =
      app->add_subcommand("physics", "Print the sizes, mass and contact parameters of a category");
  command->footer(
      "Examples:\n  simwright physics --category mug --seed 3 --json\n"
      "  simwright physics --category 'lava lamp' --llm http://localhost:8080/v1 --record l.jsonl");
  command->add_option("asset", flags->asset, "An asset folder, whose parameters are printed");
  command->add_option("--category", flags->category, "A household object, e.g. 'wine glass'");
  AddVariantOptions(command, &flags->variant);
  AddLanguageModel(command, &flags->language_model);
  AddForce(command, common);
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Physics(*flags, *common); }; });
}

}  // namespace simwright::cli
