#pragma once

#include <string>
#include <vector>

#include "asset_lift/segmentation/salient_network.h"
#include "cli/command.h"
#include "workflows/generator/generator_options.h"
#include "workflows/lift/lift.h"

namespace simwright::cli {

// The flags of a generator and of a segmenter of the user's own, as text.
struct GeneratorFlags {
  std::string format = "auto", up, normalisation = "auto";
  std::vector<std::string> parameters;  // NAME=VALUE
  std::filesystem::path segmenter;
  int segmenter_side = 0;
};

// Adds --generator, --generator-command and their settings, and --segmenter, to `command`. Options
// of the reconstruction, which a generator replaces, exclude a generator: call this after they are
// added.
void AddGenerator(CLI::App* command, GeneratorFlags* flags, workflows::LiftRequest* request);

// Sets the request's generator and segmenter from the flags and, for the key, from the environment.
// Throws core::Error for a network that cannot be used and a parameter without "=".
void ApplyGenerator(const GeneratorFlags& flags, workflows::LiftRequest* request);

}  // namespace simwright::cli
