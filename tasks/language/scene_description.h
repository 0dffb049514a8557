#pragma once

#include <span>
#include <string>
#include <string_view>

#include "assets/semantic_model.h"
#include "core/finding.h"

namespace simwright::tasks {

// An asset and the name by which programs refer to it.
struct NamedModel {
  std::string name;
  const assets::SemanticModel* model = nullptr;
};

// The limits on the part of a scene that a prompt describes; 200 parts are some 10,000 tokens.
struct DescriptionBounds {
  int max_assets = 100;
  int max_parts = 200;  // total over all assets; at least max_assets
};

struct SceneDescription {
  std::string text;
  core::Findings findings;  // "description-cut" for each asset with omitted parts
};

// Returns a text description of the scene in Gen2Sim's form (section III-B, 1): each asset with its
// size (m, all joints at zero) and its parts, and for each part its link, joint, joint type and
// limits (rad or m). Names are quoted as in Python, so a name cannot pass for another element of
// the prompt. If a scene exceeds the bounds, the largest assets lose parts first: unlabelled fixed
// parts, then fixed parts, then unlabelled movable parts. Throws core::Error unless 1 <= max_assets
// <= max_parts.
SceneDescription DescribeScene(std::span<const NamedModel> scene,
                               const DescriptionBounds& bounds = {});

// Returns `text` in double quotes on one line, escaped as in Python and JSON.
std::string Quoted(std::string_view text);

}  // namespace simwright::tasks
