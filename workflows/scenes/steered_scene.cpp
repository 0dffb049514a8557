#include "workflows/scenes/steered_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "core/error.h"
#include "scene/dataset/tokens.h"
#include "scene/feasibility/asked_relations.h"
#include "scene/prompt/object_names.h"
#include "scene/prompt/prompt_agreement.h"
#include "workflows/scenes/scene_prompts.h"

namespace simwright::workflows {
namespace {

// Half-widths of the model's range: a pose farther out is foreign to the model.
constexpr double kMostUnit = 1.2;

// Returns the sentence on how far a pose is out of the model's range; empty if it is within.
std::string FaultOfPose(const Eigen::Isometry3d& pose, const scene::PoseRange& range) {
  float numbers[scene::kPoseWidth], unit[scene::kPoseWidth];
  for (int i = 0; i < 3; ++i) numbers[i] = static_cast<float>(pose.translation()[i]);
  for (int i = 0; i < 9; ++i) numbers[3 + i] = static_cast<float>(pose.linear()(i / 3, i % 3));
  range.ToUnit(numbers, unit);
  size_t worst = 0;
  for (size_t i = 1; i < scene::kPoseWidth; ++i) {
    if (std::abs(unit[i]) > std::abs(unit[worst])) worst = i;
  }
  if (std::abs(unit[worst]) <= kMostUnit) return "";
  if (worst >= 3) return "is turned as in none of the model's scenes";
  const double low = range.low()[worst], high = range.high()[worst];
  const double beyond = std::max(low - numbers[worst], numbers[worst] - high);
  char text[128];
  std::snprintf(text, sizeof text, "is %.3g m beyond the model's range in %c, %.3g to %.3g m",
                beyond, "xyz"[worst], low, high);
  return text;
}

// Drops the objects with these flags.
void DropObjects(const std::vector<char>& gone, scene::ConstrainedScene* placed) {
  size_t to = 0;
  for (size_t i = 0; i < gone.size(); ++i) {
    if (gone[i]) continue;
    placed->indices[to] = placed->indices[i];
    placed->objects[to++] = placed->objects[i];
  }
  placed->dropped += static_cast<int>(gone.size() - to);
  placed->indices.resize(to);
  placed->objects.resize(to);
}

// Drops the objects of a proposal that physics has moved too far sideways, such as through the side
// of a shelf. `objects`: those before physics, of which the first `there` are not of the proposal.
void DropFarMoved(const std::vector<scene::SceneObject>& objects, size_t there,
                  scene::ConstrainedScene* placed) {
  constexpr double kMostSideways = 0.15;  // m, more than a steamer's radius
  std::vector<char> gone(placed->objects.size(), 0);
  for (size_t i = 0; i < gone.size(); ++i) {
    const auto index = static_cast<size_t>(placed->indices[i]);
    if (index < there) continue;
    const Eigen::Vector3d moved = placed->objects[i].world_from_object.translation() -
                                  objects[index].world_from_object.translation();
    gone[i] = moved.head<2>().norm() > kMostSideways;
  }
  DropObjects(gone, placed);
}

// Drops the subject of each relation and tier that does not hold; the object, if the subject is not
// of the proposal. `named`: by index before physics.
void DropBroken(const scene::Prompt& prompt, const std::vector<char>& named, size_t there,
                const scene::CategorySizes& sizes, scene::ConstrainedScene* placed) {
  std::vector<char> left, gone(placed->objects.size(), 0);
  std::vector<scene::SceneObject> objects = placed->objects;
  for (size_t i = 0; i < objects.size(); ++i) {
    const auto index = static_cast<size_t>(placed->indices[i]);
    left.push_back(named[index]);
    objects[i].welded = objects[i].welded || index < there;
  }
  const std::vector<Eigen::Vector3d> still(objects.size(), Eigen::Vector3d::Zero());
  for (const scene::KeptRelation& one : AskedRelations(prompt, objects, sizes, left)) {
    if (HoldsAfter(one, still)) continue;
    const auto subject = static_cast<size_t>(one.subject);
    gone[objects[subject].welded ? static_cast<size_t>(one.object) : subject] = 1;
  }
  DropObjects(gone, placed);
}

// Returns the statements of a prompt that do not hold among the named objects of a scene.
std::vector<std::string> BrokenStatements(const scene::Prompt& prompt,
                                          const std::vector<scene::SceneObject>& objects,
                                          const std::vector<char>& named,
                                          const scene::CategorySizes& sizes) {
  std::vector<scene::SceneObject> meant;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (named[i] || objects[i].welded) meant.push_back(objects[i]);
  }
  const scene::PromptAgreement agreement = AgreementWith(prompt, meant, sizes);
  std::vector<std::string> broken = StatementsOf(prompt);
  size_t to = 0;
  for (size_t i = 0; i < broken.size(); ++i) {
    if (!agreement.holds[i]) broken[to++] = broken[i];
  }
  broken.resize(to);
  return broken;
}

std::string ListOfNames(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

SteeredScene::SteeredScene(const SourceScene& source, const SteeringGoal& goal,
                           const scene::SceneModelMetadata& metadata, SourceAssets* assets,
                           core::Findings* findings)
    : name_(source.name),
      metadata_(metadata),
      rearrange_(goal.rearrange),
      names_(goal.names),
      prompt_(goal.prompt),
      count_(goal.count) {
  const int entries = metadata.vocabulary.entries;
  if (source.objects.size() > static_cast<size_t>(entries)) {
    throw core::Error("the scene has " + std::to_string(source.objects.size()) +
                          " objects, but the model takes at most " + std::to_string(entries),
                      name_);
  }
  const std::set<std::string> keep(goal.keep.begin(), goal.keep.end());
  for (const SourceObject& given : source.objects) {
    const AssetRole& role = assets->RoleOf(given);
    SteeredObject object;
    object.name = given.name;
    object.object.category = role.key;
    object.object.world_from_object = given.world_from_object;
    object.object.welded = role.welded;
    object.model_class = role.model_class;
    object.kept = !goal.rearrange || role.welded || keep.count(given.name) > 0;
    object.placed = object.kept;
    objects_.push_back(object);
    before_.push_back(object.object);
  }
  CheckGoal(goal);
  AddMissingReferred(goal, findings);
  LeaveOutOfRange(findings);
  const int seen = static_cast<int>(Seen().size());
  if (seen == 0) {
    throw core::Error("the model knows no object of this scene", name_,
                      "choose the model of its scene type");
  }
  if (!rearrange_ && count_ > entries - seen) {
    throw core::Error("the scene has " + std::to_string(seen) + " objects and the model room for " +
                          std::to_string(entries - seen) + " more, not " + std::to_string(count_),
                      name_);
  }
  asked_ = rearrange_ ? static_cast<int>(Waiting().size()) : std::max(0, count_);
}

void SteeredScene::CheckGoal(const SteeringGoal& goal) const {
  std::vector<std::string> names;
  for (const SteeredObject& object : objects_) {
    if (!object.object.welded) names.push_back(object.name);
  }
  for (const std::string& name : goal.keep) {
    const bool there = std::any_of(objects_.begin(), objects_.end(),
                                   [&](const SteeredObject& one) { return one.name == name; });
    if (there) continue;
    throw core::Error("there is no object " + name + " to keep", name_,
                      "the objects are " + ListOfNames(names));
  }
  if (rearrange_ && Waiting().empty()) {
    throw core::Error("all objects are kept: there is nothing to rearrange", name_);
  }
}

// Adds the objects that the prompt refers to and the scene lacks to those to add. Throws
// core::Error if nothing is to add.
void SteeredScene::AddMissingReferred(const SteeringGoal& goal, core::Findings* findings) {
  for (const scene::NamedCount& one : goal.referred) {
    const auto there = std::count_if(objects_.begin(), objects_.end(), [&](const auto& object) {
      return !object.object.welded && scene::NameOfCategory(object.object.category) == one.name;
    });
    const int missing = one.count - static_cast<int>(there);
    if (missing <= 0) continue;
    names_.push_back({one.name, missing});
    count_ += missing;
    findings->push_back({kReferenceAdded, core::Severity::kInfo, name_,
                         "the scene lacks what the prompt refers to, which is added: " +
                             scene::CountedName(missing, one.name)});
  }
  if (count_ != 0 || goal.referred.empty()) return;
  throw core::Error("the scene has all objects that the prompt names", name_,
                    "say what to add, as in \"another " + goal.referred.front().name + "\"");
}

void SteeredScene::LeaveOutOfRange(core::Findings* findings) {
  for (SteeredObject& object : objects_) {
    if (object.model_class < 0 || !object.placed) continue;
    const std::string fault = FaultOfPose(object.object.world_from_object, metadata_.range);
    if (fault.empty()) continue;
    object.model_class = -1;
    findings->push_back({"pose-out-of-range", core::Severity::kWarning, name_ + ": " + object.name,
                         "it " + fault + "; it stays, but the model does not see it"});
  }
}

std::vector<scene::SceneObject> SteeredScene::After() const {
  std::vector<scene::SceneObject> after;
  for (const SteeredObject& object : objects_) {
    if (object.placed) after.push_back(object.object);
  }
  return after;
}

std::vector<size_t> SteeredScene::Seen() const {
  std::vector<size_t> seen;
  for (size_t i = 0; i < objects_.size(); ++i) {
    if (objects_[i].model_class >= 0) seen.push_back(i);
  }
  return seen;
}

std::vector<size_t> SteeredScene::Placed() const {
  std::vector<size_t> placed;
  for (size_t i = 0; i < objects_.size(); ++i) {
    if (objects_[i].placed) placed.push_back(i);
  }
  return placed;
}

std::vector<size_t> SteeredScene::Waiting() const {
  std::vector<size_t> waiting;
  for (size_t i = 0; i < objects_.size(); ++i) {
    if (!objects_[i].placed) waiting.push_back(i);
  }
  return waiting;
}

int SteeredScene::Missing() const {
  return rearrange_ ? static_cast<int>(Waiting().size()) : asked_ - added_;
}

std::vector<std::string> SteeredScene::MissingNames() const {
  if (!rearrange_) return NamesToAdd();
  std::vector<std::string> names;
  for (const size_t i : Waiting()) names.push_back(objects_[i].name);
  return names;
}

int SteeredScene::NewEntries() const {
  if (rearrange_) return 0;
  const int room = metadata_.vocabulary.entries - static_cast<int>(Seen().size());
  return count_ < 0 ? room : std::min(room, Missing());
}

std::vector<std::string> SteeredScene::NamesToAdd() const {
  std::vector<std::string> names;
  for (const scene::NamedCount& one : names_) {
    const auto added = std::count_if(objects_.begin(), objects_.end(), [&](const auto& object) {
      return object.added && scene::NameOfCategory(object.object.category) == one.name;
    });
    for (auto i = added; i < one.count; ++i) names.push_back(one.name);
  }
  return names;
}

std::string SteeredScene::PromptText() const {
  if (names_.empty()) return "";
  std::map<std::string, int> counts;
  for (const size_t i : Seen()) {
    const scene::SceneObject& object = objects_[i].object;
    if (!object.welded) ++counts[scene::NameOfCategory(object.category)];
  }
  for (const std::string& name : NamesToAdd()) ++counts[name];
  scene::Prompt prompt;
  for (const auto& [name, count] : counts) prompt.names.push_back({name, count});
  // Ordinals count the objects of the goal, not those of the scene: only statements without them
  // mean the same in the model's prompt.
  for (const scene::RelationStatement& one : prompt_.relations) {
    const bool unique =
        prompt.CountOf(one.subject.name) == 1 && prompt.CountOf(one.object.name) == 1;
    if (unique) prompt.relations.push_back(one);
  }
  for (const scene::TierStatement& one : prompt_.tiers) {
    if (prompt.CountOf(one.subject.name) == 1) prompt.tiers.push_back(one);
  }
  const bool states = !prompt.relations.empty() || !prompt.tiers.empty();
  prompt.kind = states ? scene::PromptKind::kRelations : scene::PromptKind::kNames;
  return prompt.Text();
}

void SteeredScene::AppendProposal(std::vector<float>* tokens, scene::InpaintingMask* mask) const {
  const scene::Vocabulary& vocabulary = metadata_.vocabulary;
  std::vector<scene::SceneObject> seen;
  for (const size_t i : Seen()) {
    seen.push_back(objects_[i].object);
    seen.back().category = vocabulary.categories[static_cast<size_t>(objects_[i].model_class)];
  }
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  tokens->resize(tokens->size() + size);
  EncodeScene(seen, vocabulary, &(*tokens)[tokens->size() - size]);
  const auto first = static_cast<int>(mask->pose.size());
  const auto entries = static_cast<size_t>(vocabulary.entries);
  mask->pose.resize(mask->pose.size() + entries, 0);
  mask->classes.resize(mask->classes.size() + entries, 0);
  int entry = first;
  for (const size_t i : Seen()) {
    mask->pose[static_cast<size_t>(entry++)] = !objects_[i].placed;
  }
  const int last = entry + NewEntries();
  const std::vector<std::string> names = NamesToAdd();
  for (size_t k = 0; entry < last; ++entry, ++k) {
    mask->pose[static_cast<size_t>(entry)] = mask->classes[static_cast<size_t>(entry)] = 1;
    for (int c = 0; c < vocabulary.EmptyClass(); ++c) {
      const auto at = static_cast<size_t>(c);
      const bool named =
          names.empty() || scene::NameOfCategory(vocabulary.categories[at]) == names[k];
      if (vocabulary.welded[at] || !named) mask->Forbid(vocabulary, entry, c);
    }
    if (count_ >= 0) mask->Forbid(vocabulary, entry, vocabulary.EmptyClass());
  }
  if (mask->forbidden.empty()) return;
  mask->forbidden.resize(mask->pose.size() * static_cast<size_t>(vocabulary.ClassCount()), 0);
}

Proposal SteeredScene::Proposed(const float* tokens) const {
  const scene::Vocabulary& vocabulary = metadata_.vocabulary;
  const int width = vocabulary.TokenWidth();
  if (!std::all_of(tokens, tokens + vocabulary.entries * width,
                   [](float x) { return std::isfinite(x); })) {
    throw core::Error("the model gives numbers that are not finite", name_, "train it again");
  }
  scene::Vocabulary single = vocabulary;  // decodes one token
  single.entries = 1;
  const std::vector<size_t> seen = Seen();
  Proposal proposed;
  for (size_t i = 0; i < seen.size(); ++i) {
    const SteeredObject& object = objects_[seen[i]];
    if (object.placed) continue;
    scene::SceneObject moved = object.object;
    const size_t at = i * static_cast<size_t>(width);
    moved.world_from_object = DecodeScene(tokens + at, single).front().world_from_object;
    proposed.push_back({std::move(moved), static_cast<int>(seen[i])});
  }
  const int first = static_cast<int>(seen.size());
  for (int i = first; i < first + NewEntries(); ++i) {
    for (scene::SceneObject& added : DecodeScene(tokens + i * width, single)) {
      proposed.push_back({std::move(added), -1});
    }
  }
  return proposed;
}

Proposal SteeredScene::AtOldPoses() const {
  Proposal proposal;
  for (const size_t i : Waiting()) proposal.push_back({before_[i], static_cast<int>(i)});
  return proposal;
}

Proposal SteeredScene::StillMissing(const Proposal& proposal, const scene::ConstrainedScene& placed,
                                    size_t there) const {
  Proposal missing;
  std::vector<std::string> names = NamesToAdd();
  // Takes one object of the name; returns false if there is none left to add.
  const auto take = [&](const std::string& category) {
    if (names_.empty()) return static_cast<int>(missing.size()) < Missing();
    const auto found = std::find(names.begin(), names.end(), scene::NameOfCategory(category));
    if (found == names.end()) return false;
    names.erase(found);
    return true;
  };
  for (size_t i = 0; i < placed.indices.size(); ++i) {
    const auto index = static_cast<size_t>(placed.indices[i]);
    if (index < there) continue;
    const int slot = proposal[index - there].slot;
    const bool open =
        slot >= 0 ? !objects_[static_cast<size_t>(slot)].placed : take(placed.objects[i].category);
    if (open) missing.push_back({placed.objects[i], slot});
  }
  return missing;
}

scene::ConstrainedScene SteeredScene::Place(const Proposal& proposal,
                                            const scene::AssetSet& asset_set,
                                            const scene::ConstrainedOptions& options,
                                            bool strict) const {
  std::vector<scene::SceneObject> objects = After();
  const size_t there = objects.size();
  std::vector<char> kept(there, 1);
  for (const ProposedObject& one : proposal) objects.push_back(one.object);
  kept.resize(objects.size(), 0);
  scene::ConstrainedOptions asked = options;
  if (HasStatements()) {
    asked.feasibility.prompt = prompt_;
    asked.feasibility.named = Named(proposal.size());
    std::vector<scene::SceneObject> held = objects;
    for (size_t i = 0; i < there; ++i) held[i].welded = true;
    EstablishRelations(prompt_, asset_set.Sizes(), asked.feasibility.named, &held);
    std::copy(held.begin() + static_cast<std::ptrdiff_t>(there), held.end(),
              objects.begin() + static_cast<std::ptrdiff_t>(there));
  }
  scene::ConstrainedScene placed = PlaceAmong(objects, kept, asset_set, asked);
  DropFarMoved(objects, there, &placed);
  if (strict && HasStatements()) {
    DropBroken(prompt_, asked.feasibility.named, there, asset_set.Sizes(), &placed);
  }
  CheckFree(kept, asset_set, asked, &placed);
  return placed;
}

std::vector<char> SteeredScene::Named(size_t added) const {
  std::vector<char> named;
  for (const size_t i : Placed()) {
    const SteeredObject& object = objects_[i];
    const std::string name = scene::NameOfCategory(object.object.category);
    const bool to_add = std::any_of(names_.begin(), names_.end(),
                                    [&](const auto& one) { return one.name == name; });
    named.push_back(!object.object.welded && (object.added || !to_add));
  }
  named.resize(named.size() + added, 1);
  return named;
}

std::vector<std::string> SteeredScene::Broken(const scene::CategorySizes& sizes) const {
  if (!HasStatements()) return {};
  return BrokenStatements(prompt_, After(), Named(0), sizes);
}

int SteeredScene::BrokenCount(const scene::ConstrainedScene& placed, const Proposal& proposal,
                              const scene::CategorySizes& sizes) const {
  if (!HasStatements()) return 0;
  const std::vector<char> all = Named(proposal.size());
  std::vector<char> named;
  for (const int index : placed.indices) named.push_back(all[static_cast<size_t>(index)]);
  return static_cast<int>(BrokenStatements(prompt_, placed.objects, named, sizes).size());
}

void SteeredScene::Accept(const scene::ConstrainedScene& placed, const Proposal& proposal) {
  const std::vector<size_t> there = Placed();
  std::map<std::string, int> counts;
  std::set<std::string> names;
  for (const SteeredObject& object : objects_) names.insert(object.name);
  unstable_.clear();
  for (const int index : placed.unstable) unstable_.push_back(there[static_cast<size_t>(index)]);
  for (size_t i = 0; i < placed.indices.size(); ++i) {
    const auto index = static_cast<size_t>(placed.indices[i]);
    if (index < there.size()) continue;
    const int slot = proposal[index - there.size()].slot;
    if (slot >= 0) {
      objects_[static_cast<size_t>(slot)].object = placed.objects[i];
      objects_[static_cast<size_t>(slot)].placed = true;
      continue;
    }
    SteeredObject added;
    added.object = placed.objects[i];
    const std::string& category = added.object.category;
    do {
      added.name = category + "_" + std::to_string(counts[category]++);
    } while (!names.insert(added.name).second);
    added.model_class = metadata_.vocabulary.ClassOf(category);
    added.kept = false;
    added.added = true;
    objects_.push_back(std::move(added));
    ++added_;
  }
  if (!rearrange_ && count_ < 0) asked_ = std::max(asked_, static_cast<int>(proposal.size()));
  stable_ = placed.stable;
  kept_displacement_ = placed.kept_displacement;
  drift_ = placed.drift;
  penetration_ = placed.penetration;
}

std::vector<std::string> SteeredScene::unstable() const {
  std::vector<std::string> names;
  for (const size_t i : unstable_) names.push_back(objects_[i].name);
  return names;
}

}  // namespace simwright::workflows
