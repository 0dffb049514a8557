#pragma once

#include <memory>

#include "texture/endpoints/image_generator_options.h"
#include "texture/image_generator.h"

namespace simwright::llm {
class Clock;
}  // namespace simwright::llm

namespace simwright::texture {

// Creates the generator of an image server. With ImageDialect::kAuto it asks the server for what
// only one of the dialects answers. Throws core::Error if the options are invalid, the server does
// not answer or speaks none of the dialects, or the workflow cannot be used.
std::unique_ptr<ImageGenerator> MakeImageGenerator(const ImageGeneratorOptions& options);
// The same with a clock of the caller's, which must outlive the generator.
std::unique_ptr<ImageGenerator> MakeImageGenerator(const ImageGeneratorOptions& options,
                                                   llm::Clock& clock);

}  // namespace simwright::texture
