#include "workflows/scenes/scene_assets.h"

#include <cctype>
#include <chrono>
#include <map>
#include <thread>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "library/rigid/rigid_kinds.h"
#include "manipulation/grasp_file.h"
#include "scene/dataset/shard_claim.h"
#include "workflows/library/library.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

// A library asset's name: "apple_2" is the apple of seed 2.
struct Named {
  std::string kind;
  std::uint64_t seed = 1;
};

Named KindOfSlot(const std::string& category) {
  static const std::map<std::string, std::string> others = {{"can", "soda_can"}};
  const auto other = others.find(category);
  if (other != others.end()) return {other->second, 1};
  const size_t bar = category.rfind('_');
  const bool seeded = bar != std::string::npos && bar + 2 == category.size() &&
                      std::isdigit(static_cast<unsigned char>(category.back()));
  if (!seeded) return {category, 1};
  return {category.substr(0, bar), static_cast<std::uint64_t>(category.back() - '0')};
}

// Copies grasps that were proved after the asset was copied.
void CopyGrasps(const fs::path& from, const fs::path& to) {
  const fs::path source = from / manipulation::kGraspFileName;
  if (!fs::is_regular_file(source) || fs::equivalent(from, to)) return;
  core::WriteFile(to / manipulation::kGraspFileName, core::ReadFile(source));
}

void Copy(const fs::path& from, const fs::path& to) {
  if (!assets::IsAssetFolder(from)) {
    throw core::Error("this is not an asset folder", from.string(),
                      "make one with `simwright lift`, `import` or `library`");
  }
  if (fs::exists(to)) {
    if (core::ContentHashOf(to / "asset.json") == core::ContentHashOf(from / "asset.json")) {
      CopyGrasps(from, to);
      return;
    }
    throw core::Error("another asset is already used for this category", to.string(),
                      "generate into a new folder");
  }
  core::StagedFolder staged(to, false);
  fs::copy(from, staged.staging(), fs::copy_options::recursive);
  staged.Commit();
}

void MakeMissing(const std::vector<std::string>& categories, const fs::path& kept,
                 core::Progress* progress) {
  // One call per seed, because a library call makes one seed of each kind.
  std::map<std::uint64_t, std::vector<std::string>> by_seed;
  for (const std::string& category : categories) {
    if (!fs::exists(kept / category)) by_seed[KindOfSlot(category).seed].push_back(category);
  }
  for (const auto& [seed, wanted] : by_seed) {
    LibraryOptions options;
    options.kind.clear();
    for (const std::string& category : wanted) {
      const std::string kind = KindOfSlot(category).kind;
      if (library::FindRigidKind(kind) == nullptr) {
        throw core::Error("no asset fits this category, and the library has no such kind", category,
                          "give one with --asset " + category + "=FOLDER");
      }
      options.kind += (options.kind.empty() ? "" : ",") + kind;
    }
    options.seed = seed;
    options.force = true;  // leftovers of a killed run
    const fs::path making = kept / ".making";
    const std::vector<LibraryOutcome> made = MakeLibrary(options, making, progress);
    // Finished assets are kept even if others failed.
    for (size_t i = 0; i < made.size(); ++i) {
      if (made[i].refusal.empty()) fs::rename(made[i].folder, kept / wanted[i]);
    }
    fs::remove_all(making);
    core::CheckCancelled();
    for (const LibraryOutcome& one : made) {
      if (!one.refusal.empty()) throw core::Error(one.refusal, one.name);
    }
  }
}

std::string Listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

// Explains why scenes can use none of the assets in a user's folder.
std::string UnusedReason(const fs::path& folder) {
  if (assets::IsAssetFolder(folder)) return "it is itself an asset, not a folder of assets";
  int rigid = 0, jointed = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!assets::IsAssetFolder(entry.path())) continue;
    ++(assets::IsArticulatedAssetFolder(entry.path()) ? jointed : rigid);
  }
  if (rigid + jointed == 0) return "it has no asset folders";
  return "of its " + std::to_string(rigid) + " rigid assets none matches a category by name" +
         (jointed > 0 ? ", and its " + std::to_string(jointed) + " with joints are not used" : "");
}

void ReportUse(const fs::path& folder, const scene::CategoryFolders& used,
               const std::vector<std::string>& categories, core::Findings* findings) {
  if (findings == nullptr) return;
  if (used.empty()) {
    findings->push_back({"assets-unused", core::Severity::kWarning, folder.string(),
                         "none of these assets is used: " + UnusedReason(folder), 0.0,
                         "--asset SLOT=FOLDER uses one; the categories are " + Listed(categories)});
    return;
  }
  std::vector<std::string> taken;
  for (const auto& [category, path] : used) {
    const std::string name = path.filename().string();
    taken.push_back(category == name ? category : category + " (" + name + ")");
  }
  findings->push_back({"assets-used", core::Severity::kInfo, folder.string(),
                       "used for " + std::to_string(used.size()) + " of " +
                           std::to_string(categories.size()) + " categories: " + Listed(taken),
                       static_cast<double>(used.size())});
}

}  // namespace

scene::CategoryFolders GatherSceneAssets(const SceneAssetsRequest& request,
                                         core::Progress* progress) {
  fs::create_directories(request.kept);
  std::unique_ptr<scene::ShardClaim> claim;
  for (;;) {
    claim = std::make_unique<scene::ShardClaim>(request.kept / "assets");
    if (claim->held()) break;
    core::CheckCancelled();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  scene::CategoryFolders found = request.chosen;
  for (const fs::path& folder : request.folders) {
    scene::CategoryFolders here = scene::FoldersForCategories(folder, request.categories);
    scene::CategoryFolders used;
    for (const auto& [category, path] : here) {
      if (found.emplace(category, path).second) used.emplace(category, path);
    }
    // Without a word on a folder whose assets come from another one.
    if (here.empty() || !used.empty()) {
      ReportUse(folder, used, request.categories, request.findings);
    }
  }
  scene::CategoryFolders folders;
  for (const std::string& category : request.categories) {
    folders[category] = request.kept / category;
    const auto one = found.find(category);
    if (one != found.end()) Copy(one->second, folders[category]);
  }
  for (const auto& [category, folder] : request.chosen) {
    if (folders.count(category) == 0) {
      throw core::Error("scenes of this type have no such category", category);
    }
  }
  MakeMissing(request.categories, request.kept, progress);
  return folders;
}

}  // namespace simwright::workflows
