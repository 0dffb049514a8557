#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "assets/asset_folder.h"
#include "cli/command.h"
#include "core/error.h"
#include "physics_params/category_resolution.h"
#include "physics_params/physical_parameters.h"

namespace simwright::cli {
namespace {

using physics_params::Estimate;
using physics_params::PhysicalParameters;

struct Flags {
  std::string category;
  std::filesystem::path asset;
};

nlohmann::ordered_json ToJson(const Estimate& e) {
  return {{"min", e.min}, {"max", e.max}, {"sample", e.sample}};
}

void PrintJson(const PhysicalParameters& p) {
  nlohmann::ordered_json json;
  json["category"] = p.category;
  json["resolution"] = p.resolution;
  json["length_m"] = ToJson(p.length);
  json["width_m"] = ToJson(p.width);
  json["height_m"] = ToJson(p.height);
  json["mass_kg"] = ToJson(p.mass);
  json["material"] = p.material;
  json["fill"] = physics_params::FillName(p.fill);
  json["shape"] = physics_params::ShapeName(p.shape);
  json["density_kg_m3"] = ToJson(p.density);
  json["friction"] = ToJson(p.friction);
  json["restitution"] = ToJson(p.restitution);
  json["sources"] = {{"size_and_mass", p.length.source}, {"material", p.density.source}};
  std::printf("%s\n", json.dump(2).c_str());
}

void PrintRow(const char* name, const Estimate& e, const char* unit) {
  std::printf("  %-12s %9.4g to %-9.4g sample %-9.4g %s\n", name, e.min, e.max, e.sample, unit);
}

void PrintTable(const PhysicalParameters& p) {
  std::printf("%s (%s)\n", p.category.c_str(), p.resolution.c_str());
  PrintRow("length", p.length, "m");
  PrintRow("width", p.width, "m");
  PrintRow("height", p.height, "m");
  PrintRow("mass", p.mass, "kg");
  PrintRow("density", p.density,
           ("kg/m3, " + p.material + ", " + physics_params::FillName(p.fill)).c_str());
  PrintRow("friction", p.friction, "");
  PrintRow("restitution", p.restitution, "");
  std::printf("  size and mass: %s\n  material: %s\n", p.length.source.c_str(),
              p.density.source.c_str());
}

int Physics(const Flags& flags, const CommonOptions& common) {
  PhysicalParameters parameters;
  if (!flags.asset.empty()) {
    parameters = assets::ReadAsset(flags.asset).parameters;
  } else if (!flags.category.empty()) {
    const physics_params::Resolution resolution = physics_params::RequireCategory(flags.category);
    parameters = physics_params::SampleParameters(
        *resolution.category, physics_params::KnowledgeBase::Shipped(), common.seed);
    parameters.resolution = resolution.sentence;
  } else {
    throw core::Error("nothing to look up", "", "give --category NAME or an asset's folder");
  }
  if (common.json) {
    PrintJson(parameters);
  } else {
    PrintTable(parameters);
  }
  return 0;
}

}  // namespace

void AddPhysics(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command = app->add_subcommand("physics", "Sizes, mass and contact of a kind of thing");
  command->footer("Example:\n  simwright physics --category mug --seed 3 --json");
  command->add_option("asset", flags->asset, "An asset's folder: prints what it was given");
  command->add_option("--category", flags->category, "A household thing, e.g. 'wine glass'");
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Physics(*flags, *common); }; });
}

}  // namespace simwright::cli
