#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "scene/model/scene_model.h"
#include "workflows/scenes/scene_prompts.h"

namespace simwright::workflows {

// Returns the scene types that a prompt for a model may name: the model's, then the others that
// `scene generate` knows, which are read so that they can be reported.
std::vector<std::string> TypesToRead(const scene::SceneModelMetadata& metadata);

// Chooses the type of the scenes to sample from a model: `asked`, if it is not empty; else the one
// that the prompts name, or, if none does, the one that knows most of the objects that they name,
// with a finding. Another type that a prompt names is a warning. Throws core::Error for a type that
// the model does not have, prompts that name different types, and if nothing decides for a model of
// several types.
std::string ChooseSceneType(const scene::SceneModelMetadata& metadata, const std::string& asked,
                            const RequestedPrompts& prompts, core::Findings* findings);

// Throws core::Error if weights of a single scene type are given together with another type.
// `asked` may be empty; `weights` is named in the message.
void CheckSceneType(const scene::SceneModelMetadata& metadata, const std::string& asked,
                    const std::filesystem::path& weights);

}  // namespace simwright::workflows
