#pragma once

#include <cstdint>
#include <string>

#include "core/json.h"

namespace simwright::texture {

// The values of a workflow. Pictures are names of uploaded files; empty where there is none.
struct ComfyValues {
  std::string prompt, negative_prompt;
  std::string render, mask, depth, exemplar;
  std::string checkpoint, depth_model;
  int width = 0, height = 0, steps = 0;
  double guidance = 0.0, denoising_strength = 1.0;
  std::uint64_t seed = 0;
};

// Returns a workflow in ComfyUI's API format: text to picture, or inpainting of `render` inside
// `mask` (VAEEncode, SetLatentNoiseMask), with ControlNetApplyAdvanced if there is a depth model.
core::OrderedJson ComfyGraph(const ComfyValues& values);

// Replaces the placeholders {prompt}, {negative_prompt}, {seed}, {width}, {height}, {steps},
// {guidance}, {denoising_strength}, {checkpoint}, {render}, {mask}, {depth} and {exemplar} in all
// texts of `workflow`, but in no replaced text. A text that is a number's placeholder becomes the
// number.
core::OrderedJson FilledWorkflow(const core::OrderedJson& workflow, const ComfyValues& values);

// Returns true if a text of `workflow` has the placeholder {name}.
bool HasPlaceholder(const core::OrderedJson& workflow, const std::string& name);

}  // namespace simwright::texture
