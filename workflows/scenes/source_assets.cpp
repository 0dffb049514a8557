#include "workflows/scenes/source_assets.h"

#include <algorithm>
#include <cctype>

#include "assets/asset.h"
#include "assets/asset_folder.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

// Returns the name without a seed: "apple" of "apple_7".
std::string WithoutSeed(const std::string& name) {
  const size_t bar = name.rfind('_');
  const bool seeded =
      bar != std::string::npos && bar > 0 && bar + 1 < name.size() &&
      std::all_of(name.begin() + static_cast<std::ptrdiff_t>(bar) + 1, name.end(),
                  [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; });
  return seeded ? name.substr(0, bar) : name;
}

}  // namespace

int SourceAssets::ClassOf(const SourceObject& object) const {
  const std::string name = object.asset.filename().string();
  for (const std::string& one : {object.slot, name, WithoutSeed(name)}) {
    const int found = vocabulary_->ClassOf(one);
    if (found >= 0) return found;
  }
  return vocabulary_->ClassOf(assets::ReadAsset(object.asset).parameters.category);
}

// Returns a name that no other asset has.
std::string SourceAssets::KeyOf(const std::string& base) const {
  const auto taken = [&](const std::string& key) {
    return folders_.count(key) > 0 || vocabulary_->ClassOf(key) >= 0;
  };
  std::string key = base;
  for (int i = 2; taken(key); ++i) key = base + "-" + std::to_string(i);
  return key;
}

const AssetRole& SourceAssets::RoleOf(const SourceObject& object) {
  const auto known = classes_.find(object.asset);
  const int found = known != classes_.end() ? known->second : ClassOf(object);
  classes_[object.asset] = found;
  const bool furniture = found >= 0 && vocabulary_->welded[static_cast<size_t>(found)];
  const bool welded = found < 0 || object.welded.value_or(furniture);
  const auto there = roles_.find({object.asset, welded});
  if (there != roles_.end()) return there->second;
  AssetRole role;
  role.model_class = found;
  role.welded = welded;
  if (found >= 0 && welded == furniture) {
    const std::string& category = vocabulary_->categories[static_cast<size_t>(found)];
    role.key = folders_.count(category) == 0 ? category : KeyOf(category);
  } else {
    role.key = KeyOf(found >= 0 ? vocabulary_->categories[static_cast<size_t>(found)]
                                : assets::FileSafeName(object.asset.filename().string()));
  }
  folders_[role.key] = object.asset;
  return roles_.emplace(std::pair(object.asset, welded), role).first->second;
}

core::Findings SourceAssets::UnknownFindings() const {
  std::string unknown, known;
  int count = 0;
  for (const auto& [place, role] : roles_) {
    if (role.model_class >= 0) continue;
    unknown += (unknown.empty() ? "" : ", ") + role.key;
    ++count;
  }
  if (count == 0) return {};
  for (const std::string& category : vocabulary_->categories) {
    known += (known.empty() ? "" : ", ") + category;
  }
  return {{"asset-unseen", core::Severity::kWarning, unknown,
           "the model does not know these assets: their objects stay where they are, fixed, and "
           "only physics takes them into account",
           static_cast<double>(count), "the model knows " + known}};
}

scene::Vocabulary SourceAssets::ExtendedVocabulary(int entries) const {
  scene::Vocabulary extended = *vocabulary_;
  extended.entries = std::max(extended.entries, entries);
  for (const auto& [place, role] : roles_) {
    if (extended.ClassOf(role.key) >= 0) continue;
    const auto at =
        std::lower_bound(extended.categories.begin(), extended.categories.end(), role.key) -
        extended.categories.begin();
    extended.categories.insert(extended.categories.begin() + at, role.key);
    extended.welded.insert(extended.welded.begin() + at, role.welded);
  }
  return extended;
}

}  // namespace simwright::workflows
