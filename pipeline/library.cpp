#include "pipeline/library.h"

#include <atomic>
#include <chrono>

#include "assets/articulated_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "library/kinds.h"
#include "pipeline/articulated_preview.h"

namespace simwright::pipeline {
namespace fs = std::filesystem;
namespace {

struct Item {
  const library::Kind* kind;
  library::Options options;
};

std::vector<Item> ItemsOf(const LibraryOptions& options) {
  if (options.count < 1) throw core::Error("a library needs a count of at least 1");
  std::vector<const library::Kind*> kinds;
  if (options.kind == "all") {
    for (const library::Kind& kind : library::Kinds()) kinds.push_back(&kind);
  } else {
    kinds.push_back(&library::KindNamed(options.kind));
  }
  std::vector<Item> items;
  for (const library::Kind* kind : kinds) {
    for (int i = 0; i < options.count; ++i) {
      const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(i);
      items.push_back({kind, {seed, kind->name + "_" + std::to_string(seed)}});
    }
  }
  return items;
}

void Make(const Item& item, const fs::path& target, const LibraryOptions& options,
          LibraryOutcome* outcome) {
  const assets::ArticulatedAsset asset = item.kind->make(item.options);
  outcome->links = static_cast<int>(asset.links.size());
  for (const assets::UrdfJoint& joint : asset.joints) outcome->joints += joint.Moves();
  for (const assets::ArticulatedLink& link : asset.links) outcome->mass += link.inertial.mass;
  core::StagedFolder staged(target, options.force);
  assets::WriteArticulatedAsset(asset, staged.staging());
  core::WritePng(staged.staging() / "preview.png", ArticulatedPreview(asset));
  if (options.check) {
    outcome->check = CheckAsset(staged.staging());
    RequirePassed(*outcome->check, asset.name);
  }
  staged.Commit();
  outcome->folder = target;
}

}  // namespace

std::vector<LibraryOutcome> MakeLibrary(const LibraryOptions& options, const fs::path& output,
                                        core::Progress* progress) {
  const std::vector<Item> items = ItemsOf(options);
  for (const Item& item : items) {
    const fs::path target = output / item.options.name;
    if (!options.force && fs::exists(target)) {
      throw core::Error("the output exists already", target.string(),
                        "choose another place, or replace it with --force");
    }
  }
  std::vector<LibraryOutcome> outcomes(items.size());
  progress->Stage("library", static_cast<int>(items.size()));
  core::ParallelFor(static_cast<int>(items.size()), [&](int i) {
    const Item& item = items[static_cast<size_t>(i)];
    LibraryOutcome& outcome = outcomes[static_cast<size_t>(i)];
    outcome.name = item.options.name;
    outcome.kind = item.kind->name;
    const auto start = std::chrono::steady_clock::now();
    try {
      core::CheckCancelled();
      Make(item, output / item.options.name, options, &outcome);
    } catch (const core::Error& error) {
      outcome.refusal = error.what();
    } catch (const core::Cancelled&) {
      outcome.refusal = "stopped before it was done";
    }
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!core::CancelRequested()) progress->Advance();
  });
  progress->Finish();
  return outcomes;
}

core::Image LibrarySheet(const std::vector<LibraryOutcome>& outcomes) {
  std::vector<core::Image> pictures;
  for (const LibraryOutcome& outcome : outcomes) {
    if (outcome.folder.empty()) continue;
    const assets::ArticulatedAsset asset = assets::ReadArticulatedAsset(outcome.folder);
    for (const bool open : {false, true}) {
      pictures.push_back(ArticulatedView(asset, open ? 0.85 : 0.0, 210));
    }
  }
  if (pictures.empty()) throw core::Error("there is no asset to draw");
  return core::ContactSheet(pictures, 8);
}

}  // namespace simwright::pipeline
