#pragma once

#include <memory>
#include <string>

#include "cli/command.h"
#include "texture/endpoints/make_image_generator.h"

namespace simwright::cli {

// The flags of every subcommand that may ask an image server.
struct ImageGeneratorFlags {
  std::string dialect = "auto";
  texture::ImageGeneratorOptions options;

  bool given() const { return !options.url.empty(); }
};

// Adds --generator, --dialect, --generator-model, --workflow and --generator-timeout.
void AddImageGenerator(CLI::App* command, ImageGeneratorFlags* flags);

// Makes the generator that the flags and, for the key, the environment describe. Throws core::Error
// if the server does not answer, and for options that cannot be used.
std::unique_ptr<texture::ImageGenerator> MakeFlaggedGenerator(const ImageGeneratorFlags& flags,
                                                              const CommonOptions& common);

}  // namespace simwright::cli
