#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "validation/check.h"

namespace simwright::workflows {

struct LibraryOptions {
  // The kinds to make: one or several, separated by commas ("mug,book"), of library::Kinds(),
  // library::RigidKinds() or library::FurnitureKinds(); or all of the first ("all"), the second
  // ("rigid"), the first two ("everything") or the third ("furniture").
  std::string kind = "all";
  int count = 1;           // assets per kind
  std::uint64_t seed = 1;  // the first asset's; the others count up
  bool force = false;      // replaces existing outputs
  bool check = true;       // checks each asset and refuses one that fails
};

struct LibraryOutcome {
  std::string name, kind;
  std::filesystem::path folder;  // the asset's folder; empty if refused
  std::string refusal;           // the reason, if refused
  core::Findings findings;       // assumptions and refusals
  int links = 0, joints = 0;     // moving joints; a rigid object has one link and no joint
  double mass = 0.0;             // kg
  double seconds = 0.0;
  std::optional<validation::CheckReport> check;
};

// Makes assets in parallel, each into output/KIND_SEED. An asset that fails its check is refused
// with its reason and does not stop the others. Throws core::Error for an unknown kind, a count
// below 1, or an existing output unless `force` is set.
std::vector<LibraryOutcome> MakeLibrary(const LibraryOptions& options,
                                        const std::filesystem::path& output,
                                        core::Progress* progress);

// Renders a contact sheet of the assets in the folders of `outcomes`. Articulated assets appear
// closed and open side by side.
core::Image LibrarySheet(const std::vector<LibraryOutcome>& outcomes);

}  // namespace simwright::workflows
