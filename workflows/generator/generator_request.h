#pragma once

#include <string>
#include <string_view>

#include "workflows/generator/generator_options.h"

namespace simwright::workflows {

// The body of a request with a photo.
struct GeneratorRequest {
  std::string content_type;
  std::string body;
};

// Returns {"image": Base64 of `png`} with the options' parameters.
GeneratorRequest JsonGeneratorRequest(std::string_view png, const GeneratorOptions& options);

// Returns multipart/form-data (RFC 7578) with `png` as the file photo.png and the options'
// parameters as texts.
GeneratorRequest MultipartGeneratorRequest(std::string_view png, const GeneratorOptions& options);

}  // namespace simwright::workflows
