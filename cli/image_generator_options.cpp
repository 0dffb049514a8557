#include "cli/image_generator_options.h"

#include <cstdlib>
#include <map>

#include "cli/number_validators.h"

namespace simwright::cli {
namespace {

const std::map<std::string, texture::ImageDialect> kDialects = {
    {"auto", texture::ImageDialect::kAuto},
    {"sdwebui", texture::ImageDialect::kSdWebUi},
    {"comfyui", texture::ImageDialect::kComfyUi},
    {"openai", texture::ImageDialect::kOpenAi}};

}  // namespace

void AddImageGenerator(CLI::App* command, ImageGeneratorFlags* flags) {
  CLI::Option* url = command->add_option(
      "--generator", flags->options.url,
      "The address of an image server, e.g. http://localhost:7860. Its key is read from "
      "SIMWRIGHT_IMAGE_KEY");
  const auto needs_server = [&](CLI::Option* option) { return option->needs(url); };
  needs_server(command
                   ->add_option("--dialect", flags->dialect,
                                "Its protocol: sdwebui (Stable Diffusion web UI), comfyui, openai; "
                                "auto: by asking it")
                   ->check(CLI::IsMember(kDialects)))
      ->capture_default_str();
  needs_server(command->add_option("--generator-model", flags->options.model,
                                   "The checkpoint's or model's name"))
      ->default_str("the server's; openai: gpt-image-1");
  needs_server(command->add_option("--workflow", flags->options.workflow,
                                   "ComfyUI: a workflow in API format with {prompt}, {seed} ..."))
      ->default_str("one of ours");
  needs_server(command->add_option("--generator-timeout", flags->options.timeout,
                                   "Time for a picture to arrive, seconds"))
      ->check(Positive())
      ->capture_default_str();
}

std::unique_ptr<texture::ImageGenerator> MakeFlaggedGenerator(const ImageGeneratorFlags& flags,
                                                              const CommonOptions& common) {
  texture::ImageGeneratorOptions options = flags.options;
  options.dialect = kDialects.at(flags.dialect);
  options.jitter_seed = common.seed;
  options = texture::WithEnvironment(options, [](const char* name) { return std::getenv(name); });
  return texture::MakeImageGenerator(options);
}

}  // namespace simwright::cli
