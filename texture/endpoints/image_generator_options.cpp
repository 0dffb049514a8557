#include "texture/endpoints/image_generator_options.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "llm/http_client.h"
#include "texture/endpoints/endpoint_connection.h"

namespace simwright::texture {
namespace {

std::string OptionsFault(const ImageGeneratorOptions& o) {
  constexpr double kDay = 86400.0;  // s
  const auto in_range = [](double value, double low, double high) {
    return std::isfinite(value) && value >= low && value <= high;
  };
  if (o.url.empty()) return "no image server is given";
  try {
    llm::SplitUrl(o.url, ImageServerUrl());
  } catch (const core::Error& error) {
    return error.what();
  }
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  const bool blank = std::any_of(o.key.begin(), o.key.end(),
                                 [&](unsigned char c) { return c == ' ' || is_control(c); });
  if (blank) return "the image server's key contains a blank or a line break";
  if (std::any_of(o.model.begin(), o.model.end(), is_control)) {
    return "the model's name contains a line break";
  }
  if (o.steps < 1 || o.steps > 1000) return "the steps must lie in 1 to 1000";
  if (!in_range(o.guidance, 0.0, 100.0)) return "the guidance must lie in 0 to 100";
  if (!in_range(o.denoising_strength, 0.0, 1.0)) {
    return "the denoising strength must lie in 0 to 1";
  }
  if (!in_range(o.connect_timeout, 0.001, kDay) || !in_range(o.timeout, 0.001, kDay)) {
    return "the timeouts must lie between a millisecond and a day";
  }
  if (!in_range(o.first_wait, 0.0, kDay) || !in_range(o.longest_wait, o.first_wait, kDay) ||
      !in_range(o.poll_wait, 0.0, kDay)) {
    return "the waits must be positive, and longest_wait no less than first_wait";
  }
  if (o.max_attempts < 1 || o.max_attempts > 100) return "max_attempts must lie in 1 to 100";
  if (o.max_answer_bytes < 1 || o.max_picture_pixels < 1) return "the limits must be positive";
  return "";
}

}  // namespace

bool ImageGeneratorOptions::IsValid(std::string* error) const {
  const std::string fault = OptionsFault(*this);
  if (error != nullptr) *error = fault;
  return fault.empty();
}

const char* DialectName(ImageDialect dialect) {
  switch (dialect) {
    case ImageDialect::kSdWebUi:
      return "sdwebui";
    case ImageDialect::kComfyUi:
      return "comfyui";
    case ImageDialect::kOpenAi:
      return "openai";
    case ImageDialect::kAuto:
      break;
  }
  return "auto";
}

ImageGeneratorOptions WithEnvironment(ImageGeneratorOptions options,
                                      const std::function<const char*(const char*)>& variable) {
  const auto fill = [&](const char* name) {
    const char* text = variable(name);
    if (options.key.empty() && text != nullptr) options.key = text;
  };
  fill("SIMWRIGHT_IMAGE_KEY");
  if (options.key.empty() && !options.url.empty()) {
    const llm::UrlParts parts = llm::SplitUrl(options.url, ImageServerUrl());
    if (parts.scheme == "https" && parts.host == "api.openai.com") fill("OPENAI_API_KEY");
  }
  return options;
}

}  // namespace simwright::texture
