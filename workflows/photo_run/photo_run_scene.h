#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/progress.h"

namespace simwright::workflows {

// Throws core::Error if the gripper cannot pick up the asset in `folder`. The message states the
// obstacle, its width and the gripper's opening or its mass, and the height at which it would fit.
void RequireLiftable(const std::filesystem::path& folder);

// A piece of furniture beside an asset.
struct Furniture {
  std::string name;  // its folder's name, such as "drawer_unit_1"
  std::string kind;
  bool holds = false;  // the asset fits into a drawer or behind the door
};

// Makes furniture of `kind` (of library::Kinds; "any": a drawer unit, else a microwave) below
// `output`: the first of a few candidates that holds the asset in `folder` and passes its check; if
// none holds it, the first that passes. Sizes are sampled from the seed. Throws core::Error if none
// passes.
Furniture MakeFurniture(const std::filesystem::path& folder, const std::string& kind,
                        std::uint64_t seed, const std::filesystem::path& output,
                        core::Progress* progress);

}  // namespace simwright::workflows
