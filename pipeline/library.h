#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "pipeline/check.h"

namespace simwright::pipeline {

struct LibraryOptions {
  // Of library::Kinds(), library::RigidKinds() or library::FurnitureKinds(), or all of the first
  // ("all"), of the second ("rigid"), of both ("everything"), of the third ("furniture"); several
  // with commas, "mug,book".
  std::string kind = "all";
  int count = 1;           // of each kind
  std::uint64_t seed = 1;  // of the first; the others follow
  bool force = false;      // replace outputs that exist
  bool check = true;       // check each asset; one that fails is refused
};

struct LibraryOutcome {
  std::string name, kind;
  std::filesystem::path folder;  // where the asset is; empty when refused
  std::string refusal;           // the reason, when refused
  core::Findings findings;       // what was assumed or refused
  int links = 0, joints = 0;     // joints that move; a rigid thing has one link and none
  double mass = 0.0;             // kg
  double seconds = 0.0;
  std::optional<CheckReport> check;
};

// Makes assets in parallel, each into output/KIND_SEED. One that fails its check is
// refused with its reason and does not stop the others. Throws core::Error for an unknown kind, a
// count below 1, or an output that exists where `force` is not set.
std::vector<LibraryOutcome> MakeLibrary(const LibraryOptions& options,
                                        const std::filesystem::path& output,
                                        core::Progress* progress);

// A sheet of what is in the folders of `outcomes`, what has joints closed and open beside each
// other.
core::Image LibrarySheet(const std::vector<LibraryOutcome>& outcomes);

}  // namespace simwright::pipeline
