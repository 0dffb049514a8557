#include "steering/search/scene_repair.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "scene/feasibility/contact_groups.h"
#include "scene/feasibility/depenetration.h"

namespace simwright::steering {
namespace {

void RequireFinite(const TokenScene& scene) {
  if (!std::all_of(scene.tokens.begin(), scene.tokens.end(),
                   [](float x) { return std::isfinite(x); })) {
    throw core::Error("the model gives numbers that are not finite", "", "train it again");
  }
}

// Checks one group of touching objects (scene::ContactGroups) while all other objects are held.
// `kept`: flags by the indices of `whole`. The result lacks the objects that moved or disturbed.
scene::ConstrainedScene CheckGroup(const scene::ConstrainedScene& whole,
                                   const std::vector<int>& groups, int group,
                                   const std::vector<char>& kept, const scene::AssetSet& asset_set,
                                   const scene::ConstrainedOptions& options) {
  scene::ConstrainedScene held = whole;
  for (size_t i = 0; i < groups.size(); ++i) {
    held.objects[i].welded = held.objects[i].welded || groups[i] != group;
  }
  CheckFree(kept, asset_set, options, &held);
  return held;
}

// One scene whose synthesized objects look for a place. Objects are numbered as decoded.
class SceneRepairer {
 public:
  SceneRepairer(const std::vector<char>& synthesized, const scene::Vocabulary& vocabulary,
                const scene::AssetSet& asset_set, const RepairOptions& options,
                const TokenScene& scene)
      : asset_set_(asset_set),
        options_(options),
        entries_(scene.ObjectEntries(vocabulary)),
        objects_(scene.Judged(vocabulary).objects) {
    for (const int entry : entries_) kept_.push_back(!synthesized[static_cast<size_t>(entry)]);
  }

  // Returns the objects that found a place, by entry.
  std::vector<std::pair<int, scene::SceneObject>> Run() {
    placed_ = PlaceAmong(objects_, kept_, asset_set_, options_.placing);
    DropFarMoved();
    Separate();
    CheckGroups();
    std::vector<std::pair<int, scene::SceneObject>> found;
    for (size_t i = 0; i < placed_.indices.size(); ++i) {
      const auto index = static_cast<size_t>(placed_.indices[i]);
      if (!kept_[index]) found.emplace_back(entries_[index], placed_.objects[i]);
    }
    return found;
  }

  std::vector<int> UnstableEntries() const {
    std::vector<int> unstable;
    for (const int index : unstable_) unstable.push_back(entries_[static_cast<size_t>(index)]);
    return unstable;
  }

 private:
  void Keep(const std::vector<char>& stays) {
    size_t to = 0;
    for (size_t i = 0; i < stays.size(); ++i) {
      if (!stays[i]) continue;
      placed_.indices[to] = placed_.indices[i];
      placed_.objects[to++] = placed_.objects[i];
    }
    placed_.indices.resize(to);
    placed_.objects.resize(to);
  }

  void DropFarMoved() {
    std::vector<char> stays(placed_.objects.size(), 1);
    for (size_t i = 0; i < stays.size(); ++i) {
      const auto index = static_cast<size_t>(placed_.indices[i]);
      const Eigen::Vector3d moved = placed_.objects[i].world_from_object.translation() -
                                    objects_[index].world_from_object.translation();
      stays[i] = kept_[index] || moved.head<2>().norm() <= options_.most_sideways;
    }
    Keep(stays);
  }

  // Separates the new objects from what they have sunk into while settling, by fractions of a
  // millimetre.
  void Separate() {
    std::vector<scene::ProjectedBody> bodies;
    for (size_t i = 0; i < placed_.objects.size(); ++i) {
      const scene::SceneObject& object = placed_.objects[i];
      const bool fixed = object.welded || kept_[static_cast<size_t>(placed_.indices[i])] != 0;
      bodies.push_back({&asset_set_.At(object.category).parts, object.world_from_object, fixed});
    }
    const scene::Projection apart =
        ResolvePenetrations(bodies, options_.placing.feasibility.projection);
    for (size_t i = 0; i < bodies.size(); ++i) {
      placed_.objects[i].world_from_object.pretranslate(apart.shifts[i]);
    }
  }

  // Checks each group of touching objects that has a new one, while the others are held.
  void CheckGroups() {
    const std::vector<int> groups = ContactGroups(placed_.objects, asset_set_);
    std::set<int> to_check;
    for (size_t i = 0; i < groups.size(); ++i) {
      if (!kept_[static_cast<size_t>(placed_.indices[i])]) to_check.insert(groups[i]);
    }
    to_check.erase(-1);
    std::vector<char> stays(groups.size(), 1);
    for (const int group : to_check) {
      const scene::ConstrainedScene held =
          CheckGroup(placed_, groups, group, kept_, asset_set_, options_.placing);
      const std::set<int> left(held.indices.begin(), held.indices.end());
      for (size_t i = 0; i < groups.size(); ++i) {
        if (left.count(placed_.indices[i]) == 0) stays[i] = 0;
      }
      unstable_.insert(held.unstable.begin(), held.unstable.end());
      if (held.stable) continue;
      for (size_t i = 0; i < groups.size(); ++i) {
        if (groups[i] != group) continue;
        const int index = placed_.indices[i];
        kept_[static_cast<size_t>(index)] ? (void)unstable_.insert(index) : (void)(stays[i] = 0);
      }
    }
    Keep(stays);
  }

  const scene::AssetSet& asset_set_;
  const RepairOptions& options_;
  std::vector<int> entries_;  // of the objects
  std::vector<scene::SceneObject> objects_;
  std::vector<char> kept_;
  scene::ConstrainedScene placed_;
  std::set<int> unstable_;  // kept objects that move
};

}  // namespace

scene::ConstrainedOptions RepairOptions::DefaultPlacing() {
  scene::ConstrainedOptions options;
  options.feasibility.lowering = 0.25;
  options.feasibility.passes = 1;
  options.feasibility.settling.watch = 0.0;  // CheckFree follows
  const double whole = options.check.watch;
  options.check.watch = 0.25;
  options.check.stable *= options.check.watch / whole;
  options.feasibility.settling.time_step = 2e-3;
  return options;
}

bool RepairOptions::IsValid(std::string* error) const {
  if (!judging.IsValid(error) || !placing.feasibility.IsValid(error) ||
      !placing.check.IsValid(error)) {
    return false;
  }
  if (!(most_sideways > 0.0)) {
    *error = "most_sideways must be above 0 m";
    return false;
  }
  return true;
}

void SetFlags(const scene::Vocabulary& vocabulary, const scene::AssetSet& asset_set,
              const JudgingOptions& options, TokenScene* scene) {
  RequireFinite(*scene);
  const JudgedScene judged = Judge(scene->Judged(vocabulary).objects, asset_set, options);
  const std::vector<int> entries = scene->ObjectEntries(vocabulary);
  std::fill(scene->penetrating.begin(), scene->penetrating.end(), 0);
  std::fill(scene->unstable.begin(), scene->unstable.end(), 0);
  for (size_t i = 0; i < entries.size(); ++i) {
    scene->penetrating[static_cast<size_t>(entries[i])] = judged.penetrating[i];
    scene->unstable[static_cast<size_t>(entries[i])] = judged.unstable[i];
  }
}

void RepairScene(const std::vector<char>& synthesized, const scene::Vocabulary& vocabulary,
                 const scene::AssetSet& asset_set, const RepairOptions& options,
                 TokenScene* scene) {
  if (options.repair == Repair::kNone) {
    return SetFlags(vocabulary, asset_set, options.judging, scene);
  }
  RequireFinite(*scene);
  SceneRepairer repairer(synthesized, vocabulary, asset_set, options, *scene);
  const std::vector<std::pair<int, scene::SceneObject>> found = repairer.Run();
  for (int entry = 0; entry < vocabulary.entries; ++entry) {
    if (synthesized[static_cast<size_t>(entry)]) scene->Set(entry, nullptr, vocabulary);
  }
  for (const auto& [entry, object] : found) scene->Set(entry, &object, vocabulary);
  for (const int entry : repairer.UnstableEntries())
    scene->unstable[static_cast<size_t>(entry)] = 1;
}

bool ConfirmScene(const scene::Vocabulary& vocabulary, const scene::AssetSet& asset_set,
                  const RepairOptions& options, TokenScene* scene) {
  const JudgedScene judged = scene->Judged(vocabulary);
  const std::vector<int> entries = scene->ObjectEntries(vocabulary);
  scene::ConstrainedScene checked;
  std::vector<int> numbers;  // of the checked objects among `entries`
  for (size_t i = 0; i < entries.size(); ++i) {
    if (!judged.IsFeasible(i)) continue;
    checked.indices.push_back(static_cast<int>(numbers.size()));
    checked.objects.push_back(judged.objects[i]);
    numbers.push_back(static_cast<int>(i));
  }
  const std::vector<char> kept(numbers.size(), 0);
  const std::vector<int> groups = ContactGroups(checked.objects, asset_set);
  const int count = groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end()) + 1;
  std::vector<scene::ConstrainedScene> results(static_cast<size_t>(count));
  scene::ConstrainedOptions full = options.placing;
  full.check = scene::ConstrainedOptions::FreeCheckOptions();
  core::ParallelFor(count, [&](int group) {
    results[static_cast<size_t>(group)] = CheckGroup(checked, groups, group, kept, asset_set, full);
  });
  bool confirmed = true;
  for (size_t k = 0; k < numbers.size(); ++k) {
    if (groups[k] < 0) continue;
    const scene::ConstrainedScene& result = results[static_cast<size_t>(groups[k])];
    const bool stays =
        std::binary_search(result.indices.begin(), result.indices.end(), static_cast<int>(k));
    if (result.stable && stays) continue;
    scene->unstable[static_cast<size_t>(entries[static_cast<size_t>(numbers[k])])] = 1;
    confirmed = false;
  }
  return confirmed;
}

}  // namespace simwright::steering
