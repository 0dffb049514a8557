#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"

namespace simwright::factory {

// The way an asset of a factory is made.
enum class FactorySource { kLibrary, kPhoto, kFile };

// One asset of a factory.
struct FactoryItem {
  std::string name;  // of its folder: "mug_3"
  FactorySource source = FactorySource::kLibrary;
  std::string kind;            // of the library; otherwise the category, which may be empty
  std::filesystem::path file;  // a photo, a mesh or a URDF
  std::uint64_t seed = 1;
  std::string prompt;  // of its texture variants; may be empty
  int variants = 0;    // texture variants beside the asset
};

// The work of a factory, the same for every worker.
struct FactoryPlan {
  std::string theme;  // may be empty
  std::vector<FactoryItem> items;
  int tasks = 0;            // verified, in all
  int tasks_per_part = 25;  // of one unit of work
  std::uint64_t seed = 1;
};

struct FactoryThemeRequest {
  std::string theme;
  int assets = 200, tasks = 500, variants = 0;
  std::uint64_t seed = 1;
};

// Returns the plan of a theme: the library's kinds of the categories that a theme proposes
// (proposals/category_proposals.h), in turn with growing seeds, and for every tenth asset an
// articulated kind, since most tasks need one. `findings` names categories without a kind. Throws
// core::Error for an unknown theme, or one without any kind.
FactoryPlan PlanOfTheme(const FactoryThemeRequest& request, core::Findings* findings);

// Reads the plan of a user (docs/factory.md): a theme or sources of assets. Paths are relative to
// the file. Throws core::Error, naming the member, for an unknown kind, a missing file or folder,
// a wrong number, or a plan without assets.
FactoryPlan ReadFactoryPlan(const std::filesystem::path& file, core::Findings* findings);

// Write and read the plan as its items, DIR/plan.json, which every worker of a folder shares.
std::string PlanText(const FactoryPlan& plan);
FactoryPlan ReadPlanText(const std::filesystem::path& file);

// Returns the number of parts of the tasks, and the items whose assets part `part` uses.
int PartCount(const FactoryPlan& plan);
std::vector<int> ItemsOfPart(const FactoryPlan& plan, int part);

}  // namespace simwright::factory
