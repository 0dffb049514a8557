#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace simwright::texture {

// The protocol of an image server.
enum class ImageDialect {
  kAuto,     // found by asking the server, when the generator is made
  kSdWebUi,  // Stable Diffusion web UI (AUTOMATIC1111, Forge, SD.Next): /sdapi/v1
  kComfyUi,  // ComfyUI: /upload/image, /prompt, /history, /view
  kOpenAi    // OpenAI's images/generations and images/edits, which LocalAI also speaks
};

// An image server of the user's own, and how it is asked.
struct ImageGeneratorOptions {
  std::string url;  // http(s)://host[:port][/path]; OpenAI's usually ends in /v1
  ImageDialect dialect = ImageDialect::kAuto;
  std::string key;  // sent as a bearer token; empty: none
  // The model: a checkpoint's name (kSdWebUi, kComfyUi) or a model's (kOpenAi). Empty: the server's
  // current one, ComfyUI's first one, "gpt-image-1".
  std::string model;
  // The ControlNet model for depth; empty: the server's first whose name has "depth".
  std::string depth_model;
  // ComfyUI: the user's workflow in API format (JSON) with placeholders; empty: a workflow of ours.
  std::filesystem::path workflow;
  int steps = 30;                   // of the sampler
  double guidance = 7.0;            // classifier-free guidance scale
  double denoising_strength = 1.0;  // inside the mask; 1: nothing of the render stays

  double connect_timeout = 10.0;                 // s
  double timeout = 600.0;                        // s for a picture, retries included
  double poll_wait = 1.0;                        // s between two questions about a queued picture
  std::size_t max_answer_bytes = 128ull << 20;   // of an answer
  std::int64_t max_picture_pixels = 64'000'000;  // of a picture
  int max_attempts = 5;                          // of a request
  double first_wait = 1.0;                       // s before the second attempt; doubled each time
  double longest_wait = 30.0;                    // s
  std::uint64_t jitter_seed = 1;

  // Returns false, with a reason that never contains the key, unless all values can be used.
  bool IsValid(std::string* error) const;
};

// Returns "sdwebui", "comfyui", "openai" or "auto".
const char* DialectName(ImageDialect dialect);

// Fills an unset key from the environment: SIMWRIGHT_IMAGE_KEY, and OPENAI_API_KEY only if the host
// is api.openai.com, over https. `variable` returns an environment variable's value or null
// (std::getenv).
ImageGeneratorOptions WithEnvironment(ImageGeneratorOptions options,
                                      const std::function<const char*(const char*)>& variable);

}  // namespace simwright::texture
