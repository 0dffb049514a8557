#include <cstdio>
#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/image_generator_options.h"
#include "core/finding.h"
#include "workflows/texture/texturing.h"

namespace simwright::cli {
namespace {

struct TextureFlags {
  workflows::TextureRequest request;
  ImageGeneratorFlags generator;
  std::string as = "folders";
};

int Texture(const TextureFlags& flags, const CommonOptions& common) {
  workflows::TextureRequest request = flags.request;
  request.as_materials = flags.as == "materials";
  if (flags.generator.given()) request.generator = MakeFlaggedGenerator(flags.generator, common);
  request.seed = common.seed;
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  const workflows::TextureReport report = workflows::TextureAsset(request, &progress);
  if (common.json) {
    PrintJson(workflows::TextureReportJson(report), report.findings);
  } else {
    PrintFindings(report.findings, common);
    std::fputs(workflows::TextureTable(report).c_str(), stdout);
  }
  if (!report.interrupted) return 0;
  std::fprintf(stderr, "error: stopped; %zu of %d variants are finished and kept in %s\n",
               report.variants.size(), request.variants, request.output.c_str());
  return kInterrupted;
}

}  // namespace

void AddTexture(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<TextureFlags>();
  workflows::TextureRequest* request = &flags->request;
  CLI::App* command = app->add_subcommand(
      "texture", "Give an asset new textures: by words, from a photo or from another asset");
  command->footer(
      "Examples:\n  simwright texture mug --variants 4 -o mugs\n"
      "  simwright texture mug --prompt \"a blue glazed mug with a white inside\"\n"
      "  simwright texture cabinet --prompt \"walnut with brass handles\" --variants 8\n"
      "  simwright texture bowl --exemplar granite.jpg\n"
      "  simwright texture chair --like cabinet\n"
      "Without words or a picture the materials follow from the asset's category and parts. Words "
      "that change nothing are reported. Geometry, mass and collision parts stay as they are.");
  command->add_option("asset", request->asset, "The folder of an asset, rigid or articulated")
      ->required();
  auto* prompt = command->add_option("--prompt", request->prompt,
                                     "Materials, colours, patterns and finishes in words");
  prompt->default_str("none");
  auto* exemplar = command->add_option(
      "--exemplar", request->exemplar,
      "A photo of the look: its object, or all of it, gives the patches of the texture");
  exemplar->default_str("none");
  auto* like =
      command->add_option("--like", request->like, "The folder of an asset that has the look");
  like->default_str("none");
  like->excludes(exemplar);
  command->add_option("--variants", request->variants, "Variants, each with the next seed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--size", request->size, "Texels per side of the texture")
      ->check(CLI::Range(64, 4096))
      ->capture_default_str();
  command
      ->add_option("--as", flags->as,
                   "folders: an asset per variant; materials: one rigid asset with the maps of all "
                   "variants (\"appearances\" in asset.json)")
      ->check(CLI::IsMember({"folders", "materials"}))
      ->capture_default_str();
  AddImageGenerator(command, &flags->generator);
  command->add_option("-o,--output", request->output, "The folder for the variants")
      ->capture_default_str();
  AddForce(command, common);
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Texture(*flags, *common); }; });
}

}  // namespace simwright::cli
