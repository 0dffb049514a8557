#pragma once

#include <memory>

#include "texture/endpoints/endpoint_connection.h"
#include "texture/image_generator.h"

namespace simwright::texture {

// Each returns a generator that speaks one protocol over `connection`. A request with a render is
// answered by inpainting inside its trimap, under the depth where the server can do that; what the
// server cannot use (depth, exemplar, seed, negative prompt) is reported as a finding.
std::unique_ptr<ImageGenerator> MakeWebUiGenerator(EndpointConnection connection);
std::unique_ptr<ImageGenerator> MakeOpenAiImageGenerator(EndpointConnection connection);
// Reads the options' workflow. Throws core::Error if it is no workflow in API format or has no
// placeholder for the prompt.
std::unique_ptr<ImageGenerator> MakeComfyGenerator(EndpointConnection connection);

// Returns the seed as the samplers of the servers accept it: 32 bits.
inline std::uint64_t SamplerSeed(std::uint64_t seed) {
  return seed & 0xffffffffull;
}

// Throws core::Error unless the request is valid and has a prompt.
void RequirePrompt(const ImageRequest& request, const EndpointConnection& connection);

}  // namespace simwright::texture
