#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/progress.h"

namespace simwright::pipeline {

// Throws core::Error where no hand can pick up the asset in `folder`, with what is in the way: its
// width and the gripper's opening, or its mass; and with the height at which it could be.
void RequireLiftable(const std::filesystem::path& folder);

// A piece of furniture beside an asset.
struct Furniture {
  std::string name;  // "drawer_unit_1", of its folder
  std::string kind;
  bool holds = false;  // the asset fits into one of its drawers, or behind its door
};

// Makes furniture of `kind` (of library::Kinds; "any": a drawer unit, else a microwave) below
// `output`, the first of a few that holds the asset in `folder` and passes its check; where none
// holds it, the first that passes. Sizes are drawn by the seed. Throws core::Error where none
// passes.
Furniture MakeFurniture(const std::filesystem::path& folder, const std::string& kind,
                        std::uint64_t seed, const std::filesystem::path& output,
                        core::Progress* progress);

}  // namespace simwright::pipeline
