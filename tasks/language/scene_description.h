#pragma once

#include <span>
#include <string>
#include <string_view>

#include "assets/semantic_model.h"
#include "core/finding.h"

namespace simwright::tasks {

// An asset under the name that programs call it by.
struct NamedModel {
  std::string name;
  const assets::SemanticModel* model = nullptr;
};

// How much of a scene a language model is told; 200 parts are some 10,000 tokens.
struct DescriptionBounds {
  int max_assets = 100;
  int max_parts = 200;  // of all assets together; at least max_assets
};

struct SceneDescription {
  std::string text;
  core::Findings findings;  // "description-cut" for each asset of which parts are left out
};

// The scene in words, in Gen2Sim's form (section III-B, 1): assets with their sizes (m, all joints
// at zero), their parts, and for each part link, joint, type and limits (rad or m). Names are
// quoted as Python would, so that none can pass for anything else. Of a scene that passes the
// bounds the largest assets lose parts first: fixed ones without a label, then fixed ones, then
// movable ones without a label. Throws core::Error unless 1 <= max_assets <= max_parts.
SceneDescription DescribeScene(std::span<const NamedModel> scene,
                               const DescriptionBounds& bounds = {});

// `text` between double quotes on one line, as Python and JSON write it.
std::string Quoted(std::string_view text);

}  // namespace simwright::tasks
