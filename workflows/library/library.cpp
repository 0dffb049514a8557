#include "workflows/library/library.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <sstream>

#include "asset_build/articulated_preview.h"
#include "asset_build/asset_builder.h"
#include "asset_build/preview.h"
#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "core/finding_text.h"
#include "core/free_memory.h"
#include "core/parallel.h"
#include "library/articulated/articulated_kinds.h"
#include "library/rigid/rigid_kinds.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kSheetSize = 210;  // pixels

// One kind, articulated or rigid.
struct Item {
  const library::Kind* jointed = nullptr;
  const library::RigidKind* rigid = nullptr;
  library::Options options;
};

void AddKind(const std::string& kind, std::vector<Item>* items) {
  if (kind == "all" || kind == "everything") {
    for (const library::Kind& one : library::Kinds()) items->push_back({&one, nullptr, {}});
  }
  if (kind == "rigid" || kind == "everything") {
    for (const library::RigidKind& one : library::RigidKinds()) {
      items->push_back({nullptr, &one, {}});
    }
  }
  if (kind == "furniture") {
    for (const library::RigidKind& one : library::FurnitureKinds()) {
      items->push_back({nullptr, &one, {}});
    }
  }
  if (kind == "all" || kind == "rigid" || kind == "everything" || kind == "furniture") return;
  const library::RigidKind* rigid = library::FindRigidKind(kind);
  items->push_back(rigid != nullptr ? Item{nullptr, rigid, {}}
                                    : Item{&library::KindNamed(kind), nullptr, {}});
}

// Returns the kinds of a comma-separated list, without duplicates.
std::vector<Item> KindsOf(const std::string& kinds) {
  std::vector<Item> named, items;
  std::istringstream list(kinds);
  for (std::string kind; std::getline(list, kind, ',');) AddKind(kind, &named);
  for (const Item& item : named) {
    const bool known = std::any_of(items.begin(), items.end(), [&](const Item& other) {
      return other.jointed == item.jointed && other.rigid == item.rigid;
    });
    if (!known) items.push_back(item);
  }
  if (items.empty()) throw core::Error("no kind is named", kinds, "see --list");
  return items;
}

std::string NameOf(const Item& item) {
  return item.rigid != nullptr ? item.rigid->name : item.jointed->name;
}

std::vector<Item> ItemsOf(const LibraryOptions& options) {
  if (options.count < 1) throw core::Error("a library needs a count of at least 1");
  std::vector<Item> items;
  for (Item item : KindsOf(options.kind)) {
    for (int i = 0; i < options.count; ++i) {
      const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(i);
      item.options = {seed, NameOf(item) + "_" + std::to_string(seed)};
      items.push_back(item);
    }
  }
  return items;
}

void WriteJointed(const Item& item, const fs::path& folder, LibraryOutcome* outcome) {
  const assets::ArticulatedAsset asset = item.jointed->make(item.options);
  outcome->findings = asset.findings;
  outcome->links = static_cast<int>(asset.links.size());
  for (const assets::Joint& joint : asset.joints) outcome->joints += joint.Moves();
  for (const assets::ArticulatedLink& link : asset.links) outcome->mass += link.inertial.mass;
  assets::WriteArticulatedAsset(asset, folder);
  core::WritePng(folder / "preview.png", asset_build::ArticulatedPreview(asset));
}

void WriteRigid(const Item& item, const fs::path& folder, LibraryOutcome* outcome) {
  const library::RigidObject object = library::MakeRigidObject(*item.rigid, item.options.seed);
  asset_build::BuildRequest request;
  request.name = item.options.name;
  request.source = "library/" + item.rigid->name;
  request.category = physics_params::RequireCategory(item.rigid->category);
  request.seed = item.options.seed;
  request.parts = object.parts;
  core::Progress silent;
  const assets::Asset asset = asset_build::BuildAsset(object.visual, request, &silent).asset;
  outcome->findings = asset.findings;
  outcome->links = 1;
  outcome->mass = asset.inertial.mass;
  assets::WriteAsset(asset, folder);
  core::WritePng(folder / "preview.png", asset_build::AssetPreview(asset));
}

void MakeObject(const Item& item, const fs::path& target, const LibraryOptions& options,
                LibraryOutcome* outcome) {
  core::StagedFolder staged(target, options.force);
  (item.rigid != nullptr ? WriteRigid : WriteJointed)(item, staged.staging(), outcome);
  if (options.check) {
    outcome->check = validation::CheckBeforeKeeping(staged.staging(), item.options.name);
    const core::Findings warnings = outcome->check->Warnings();
    outcome->findings.insert(outcome->findings.end(), warnings.begin(), warnings.end());
  }
  staged.Commit();
  outcome->folder = target;
}

void RefuseObject(const core::Error& error, LibraryOutcome* outcome) {
  outcome->refusal = error.what();
  outcome->findings.push_back(core::FindingOf(error));
}

}  // namespace

std::vector<LibraryOutcome> MakeLibrary(const LibraryOptions& options, const fs::path& output,
                                        core::Progress* progress) {
  const std::vector<Item> items = ItemsOf(options);
  for (const Item& item : items) {
    const fs::path target = output / item.options.name;
    if (!options.force && fs::exists(target)) {
      throw core::Error("the output exists already", target.string(),
                        "choose another folder, or replace it with --force");
    }
  }
  std::vector<LibraryOutcome> outcomes(items.size());
  progress->Stage("library", static_cast<int>(items.size()));
  core::ParallelFor(static_cast<int>(items.size()), [&](int i) {
    const Item& item = items[static_cast<size_t>(i)];
    LibraryOutcome& outcome = outcomes[static_cast<size_t>(i)];
    outcome.name = item.options.name;
    outcome.kind = NameOf(item);
    const auto start = std::chrono::steady_clock::now();
    try {
      core::CheckCancelled();
      MakeObject(item, output / item.options.name, options, &outcome);
    } catch (const validation::CheckFailed& error) {
      RefuseObject(error, &outcome);
      outcome.findings.insert(outcome.findings.end(), error.results().begin(),
                              error.results().end());
    } catch (const core::Error& error) {
      RefuseObject(error, &outcome);
    } catch (const core::Cancelled&) {
      RefuseObject(core::Error("stopped before it was done", outcome.name), &outcome);
    }
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    core::ReturnFreeMemory();
    if (!core::CancelRequested()) progress->Advance();
  });
  progress->Finish();
  return outcomes;
}

core::Image LibrarySheet(const std::vector<LibraryOutcome>& outcomes) {
  std::vector<core::Image> pictures;
  for (const LibraryOutcome& outcome : outcomes) {
    if (outcome.folder.empty()) continue;
    if (!assets::IsArticulatedAssetFolder(outcome.folder)) {
      pictures.push_back(asset_build::RigidView(assets::ReadAsset(outcome.folder), kSheetSize));
      continue;
    }
    const assets::ArticulatedAsset asset = assets::ReadArticulatedAsset(outcome.folder);
    for (const bool open : {false, true}) {
      pictures.push_back(asset_build::ArticulatedView(asset, open ? 0.85 : 0.0, kSheetSize));
    }
  }
  if (pictures.empty()) throw core::Error("there is no asset to render");
  return core::ContactSheet(pictures, 8);
}

}  // namespace simwright::workflows
