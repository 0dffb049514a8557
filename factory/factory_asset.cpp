#include "factory/factory_asset.h"

#include <chrono>
#include <ctime>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "workflows/import/import.h"
#include "workflows/library/library.h"
#include "workflows/lift/lift.h"
#include "workflows/texture/texturing.h"

namespace simwright::factory {
namespace fs = std::filesystem;
namespace {

constexpr int kAttempts = 3;
constexpr std::uint64_t kSeedStep = 100'000;  // between the attempts
constexpr std::uintmax_t kLeastFreeBytes = 200u << 20;

// The outcome of one attempt.
struct Attempt {
  std::string refusal;  // empty: made
  core::Findings findings;
};

Attempt MakeLibraryAsset(const FactoryItem& item, std::uint64_t seed, const fs::path& target) {
  workflows::LibraryOptions options;
  options.kind = item.kind;
  options.seed = seed;
  options.force = true;
  core::Progress silent;
  const fs::path parent = target.parent_path() / ("." + target.filename().string() + ".making");
  const std::vector<workflows::LibraryOutcome> made =
      workflows::MakeLibrary(options, parent, &silent);
  Attempt attempt{made.front().refusal, made.front().findings};
  if (attempt.refusal.empty()) {
    fs::remove_all(target);
    fs::rename(made.front().folder, target);
  }
  fs::remove_all(parent);
  return attempt;
}

Attempt MakePhotoAsset(const FactoryItem& item, std::uint64_t seed, bool free_form,
                       const fs::path& target) {
  workflows::LiftRequest request;
  request.photo = item.file;
  request.category = item.kind;
  request.shape = free_form ? workflows::LiftShape::kFree : workflows::LiftShape::kAuto;
  request.effort = asset_lift::LiftEffort::kFast;
  request.seed = seed;
  request.output = target;
  request.force = true;
  core::Progress silent;
  return {"", workflows::LiftToFolder(request, &silent).findings};
}

Attempt ImportFactoryAsset(const FactoryItem& item, std::uint64_t seed, const fs::path& target) {
  workflows::ImportOptions options;
  options.category = item.kind;
  options.seed = seed;
  options.force = true;
  core::Progress silent;
  const workflows::ImportItem file{item.file, -1, target.filename().string(), {}};
  const std::vector<workflows::ImportOutcome> made =
      workflows::ImportAll({file}, target.parent_path(), options, &silent);
  return {made.front().refusal, made.front().findings};
}

Attempt TryItem(const FactoryItem& item, int attempt, const fs::path& target) {
  const std::uint64_t seed = item.seed + static_cast<std::uint64_t>(attempt) * kSeedStep;
  try {
    switch (item.source) {
      case FactorySource::kLibrary:
        return MakeLibraryAsset(item, seed, target);
      case FactorySource::kPhoto:
        return MakePhotoAsset(item, seed, attempt + 1 == kAttempts, target);
      case FactorySource::kFile:
        return ImportFactoryAsset(item, seed, target);
    }
  } catch (const core::Error& error) {
    return {error.what(), {}};
  }
  return {"the source is unknown", {}};
}

std::string NextChange(const FactoryItem& item, int attempt) {
  if (attempt + 1 >= kAttempts) return "";
  const std::string seed =
      "seed " + std::to_string(item.seed + static_cast<std::uint64_t>(attempt + 1) * kSeedStep);
  return item.source == FactorySource::kPhoto && attempt + 2 == kAttempts ? seed + ", free form"
                                                                          : seed;
}

// Returns the warnings, which the record keeps.
core::Findings WarningsOf(const core::Findings& findings) {
  core::Findings warnings;
  for (const core::Finding& finding : findings) {
    if (finding.severity != core::Severity::kInfo) warnings.push_back(finding);
  }
  return warnings;
}

void MakeVariants(const FactoryItem& item, const FactoryFolder& folder,
                  const std::shared_ptr<texture::ImageGenerator>& generator, AssetRecord* record) {
  workflows::TextureRequest request;
  request.asset = folder.assets() / item.name;
  request.prompt = item.prompt;
  request.generator = item.prompt.empty() ? nullptr : generator;
  // A generator is asked from one thread at a time.
  static std::mutex asking;
  std::unique_lock<std::mutex> lock(asking, std::defer_lock);
  if (request.generator != nullptr) lock.lock();
  request.variants = item.variants;
  request.seed = item.seed;
  request.output = folder.assets();
  request.force = true;
  core::Progress silent;
  try {
    const workflows::TextureReport report = workflows::TextureAsset(request, &silent);
    if (report.interrupted) throw core::Cancelled();  // the asset is made again with --resume
    for (const workflows::TextureVariant& variant : report.variants) {
      record->variants.push_back("assets/" + variant.folder.filename().string());
    }
  } catch (const core::Error& error) {
    core::CheckCancelled();
    RequireFreeDisk(folder.root);
    record->failures.push_back({std::string("texture: ") + error.what(), ""});
    record->findings.push_back({"factory-variants-failed", core::Severity::kWarning, item.name,
                                std::string("its texture variants failed: ") + error.what(), 0.0,
                                "delete its record in done/ and resume"});
  }
}

}  // namespace

double ThreadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void RequireFreeDisk(const fs::path& folder) {
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (error || space.available >= kLeastFreeBytes) return;
  throw core::Error("the disk is nearly full: less than 200 MB are free", folder.string(),
                    "make room and resume with --resume; finished assets are kept");
}

AssetRecord MakeFactoryAsset(const FactoryItem& item, const FactoryFolder& folder,
                             const std::shared_ptr<texture::ImageGenerator>& generator) {
  RequireFreeDisk(folder.root);
  const auto start = std::chrono::steady_clock::now();
  const double before = ThreadSeconds();
  AssetRecord record;
  record.name = item.name;
  record.category = item.kind;
  record.source = item.source == FactorySource::kLibrary ? "library"
                  : item.source == FactorySource::kPhoto ? "photo"
                                                         : "file";
  for (int attempt = 0; attempt < kAttempts && !record.made(); ++attempt) {
    core::CheckCancelled();
    const Attempt made = TryItem(item, attempt, folder.assets() / item.name);
    core::CheckCancelled();  // library and import report a stop as a refusal
    // A write that failed for want of room is no fault of the asset.
    if (!made.refusal.empty()) RequireFreeDisk(folder.root);
    if (made.refusal.empty()) {
      record.folder = "assets/" + item.name;
      record.findings = WarningsOf(made.findings);
    } else {
      record.failures.push_back({made.refusal, NextChange(item, attempt)});
    }
  }
  if (record.made() && item.variants > 0) MakeVariants(item, folder, generator, &record);
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.cpu_seconds = ThreadSeconds() - before;
  return record;
}

}  // namespace simwright::factory
