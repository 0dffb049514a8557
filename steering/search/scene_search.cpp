#include "steering/search/scene_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "core/elapsed_time.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"

namespace simwright::steering {
namespace {

constexpr std::uint64_t kRootStream = 0;  // iteration i has stream i + 1

}  // namespace

bool SearchOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (iterations < 1) return fails("a search needs at least 1 iteration");
  if (branching < 1 || branching > 100) return fails("a node must have 1 to 100 children");
  if (!(exploration >= 0.0) || exploration > 1e6) {
    return fails("the exploration constant must be at least 0");
  }
  if (leaves < 1 || leaves > 100) return fails("1 to 100 leaves can be expanded together");
  if (fill < 0) return fails("the number of entries to fill must be at least 0");
  if (most_objects < 0) return fails("the most objects of a scene must be at least 0");
  return true;
}

SceneSearch::SceneSearch(const scene::Vocabulary& vocabulary, const scene::AssetSet& asset_set,
                         const MaskGenerator& mask, const SceneReward& reward, Inpainter inpainter,
                         const SearchOptions& options, const RepairOptions& repair)
    : vocabulary_(vocabulary),
      asset_set_(asset_set),
      mask_(mask),
      reward_(reward),
      inpainter_(std::move(inpainter)),
      options_(options),
      repair_(repair),
      tree_(options.exploration, options.scaled) {
  std::string error;
  if (!options.IsValid(&error) || !repair.IsValid(&error)) {
    throw core::Error("scene search: " + error);
  }
  const auto classes = static_cast<size_t>(vocabulary.EmptyClass());
  if (!options.allowed.empty() && options.allowed.size() != classes) {
    throw core::Error("scene search: the allowed classes have another number than the classes");
  }
}

double SceneSearch::RewardOf(const TokenScene& scene) const {
  return reward_.Evaluate(scene.Judged(vocabulary_));
}

bool SceneSearch::IsTerminal(const TokenScene& scene) const {
  const std::vector<char> mask = mask_.Mask(scene);
  return std::none_of(mask.begin(), mask.end(), [](char flag) { return flag != 0; });
}

SceneSearch::Draft SceneSearch::UnconditionalDraft() const {
  const std::vector<char> all(static_cast<size_t>(vocabulary_.entries), 1);
  return {TokenScene::Empty(vocabulary_), all, std::vector<char>(all.size(), 0)};
}

// Returns the scene of a leaf with what child number `child` synthesizes again. Masked objects
// become padding first: what is masked says nothing to the model. Where the number of objects is
// limited, they are filled like padding, else the model chooses what they become.
SceneSearch::Draft SceneSearch::DraftOf(int leaf, int child) const {
  Draft draft{state_.scenes[static_cast<size_t>(leaf)], {}, {}};
  draft.synthesized = mask_.Mask(draft.scene);
  draft.filled.assign(draft.synthesized.size(), 0);
  if (options_.fill == 0) return Blanked(std::move(draft));
  const bool limited = options_.most_objects > 0;
  int padding = std::max(1, options_.fill >> std::min(child, 30)), there = 0;
  const JudgedScene judged = draft.scene.Judged(vocabulary_);
  const std::vector<int> entries = draft.scene.ObjectEntries(vocabulary_);
  for (size_t i = 0; i < entries.size(); ++i) {
    const bool masked = draft.synthesized[static_cast<size_t>(entries[i])] != 0;
    there += !judged.objects[i].welded && !masked;
    padding += limited && masked;
  }
  if (limited) padding = std::max(1, std::min(padding, options_.most_objects - there));
  for (int entry = 0; entry < vocabulary_.entries; ++entry) {
    const auto index = static_cast<size_t>(entry);
    if (!draft.synthesized[index] || (!limited && !draft.scene.IsEmpty(entry, vocabulary_))) {
      continue;
    }
    draft.filled[index] = draft.synthesized[index] = padding-- > 0;
    if (!draft.filled[index]) draft.scene.Set(entry, nullptr, vocabulary_);
  }
  return Blanked(std::move(draft));
}

// Returns the draft with what it synthesizes as padding.
SceneSearch::Draft SceneSearch::Blanked(Draft draft) const {
  for (int entry = 0; entry < vocabulary_.entries; ++entry) {
    if (draft.synthesized[static_cast<size_t>(entry)]) {
      draft.scene.Set(entry, nullptr, vocabulary_);
    }
  }
  return draft;
}

void SceneSearch::AppendTo(const Draft& draft, std::vector<float>* tokens,
                           scene::InpaintingMask* mask) const {
  const auto first = static_cast<int>(mask->pose.size());
  tokens->insert(tokens->end(), draft.scene.tokens.begin(), draft.scene.tokens.end());
  mask->pose.insert(mask->pose.end(), draft.synthesized.begin(), draft.synthesized.end());
  mask->classes.insert(mask->classes.end(), draft.synthesized.begin(), draft.synthesized.end());
  const std::vector<int> kept = draft.scene.ObjectEntries(vocabulary_);
  if (kept.empty()) return;  // an unconditional sample, furniture included
  for (int entry = 0; entry < vocabulary_.entries; ++entry) {
    const auto index = static_cast<size_t>(entry);
    if (!draft.synthesized[index]) continue;
    for (int c = 0; c < vocabulary_.EmptyClass(); ++c) {
      const auto at = static_cast<size_t>(c);
      const bool allowed = options_.allowed.empty() || options_.allowed[at] != 0;
      if (vocabulary_.welded[at] || !allowed) mask->Forbid(vocabulary_, first + entry, c);
    }
    if (draft.filled[index]) mask->Forbid(vocabulary_, first + entry, vocabulary_.EmptyClass());
  }
}

void SceneSearch::Synthesize(std::uint64_t seed, std::vector<Draft>* drafts) {
  std::vector<float> tokens;
  scene::InpaintingMask mask;
  for (const Draft& draft : *drafts) AppendTo(draft, &tokens, &mask);
  if (!mask.forbidden.empty()) {
    mask.forbidden.resize(mask.pose.size() * static_cast<size_t>(vocabulary_.ClassCount()), 0);
  }
  {
    const core::ScopedTimer timer(&model_seconds_);
    tokens = inpainter_(tokens, mask, seed);
  }
  const core::ScopedTimer timer(&physics_seconds_);
  const auto size = static_cast<size_t>(vocabulary_.entries * vocabulary_.TokenWidth());
  core::ParallelFor(static_cast<int>(drafts->size()), [&](int i) {
    core::CheckCancelled();
    Draft& draft = (*drafts)[static_cast<size_t>(i)];
    const auto first = tokens.begin() + static_cast<std::ptrdiff_t>(static_cast<size_t>(i) * size);
    draft.scene.tokens.assign(first, first + static_cast<std::ptrdiff_t>(size));
    RepairScene(draft.synthesized, vocabulary_, asset_set_, repair_, &draft.scene);
  });
}

int SceneSearch::Add(int parent, TokenScene scene) {
  const int node = tree_.Add(parent, RewardOf(scene), IsTerminal(scene));
  state_.scenes.push_back(std::move(scene));
  return node;
}

void SceneSearch::BeginTree(TokenScene root) {
  tree_ = SearchTree(options_.exploration, options_.scaled);
  state_ = {};
  Add(-1, std::move(root));
  state_.samples = 1;
  Consider(0);
  if (state_.best < 0) {  // not confirmed: it counts with what the check leaves
    state_.best = 0;
    state_.best_reward = tree_.nodes().front().reward;
  }
  tree_.Backpropagate(0, tree_.nodes().front().reward);
}

void SceneSearch::Start() {
  std::vector<Draft> drafts = {UnconditionalDraft()};
  Synthesize(core::StreamRng(options_.seed, kRootStream)(), &drafts);
  BeginTree(std::move(drafts.front().scene));
}

void SceneSearch::StartWith(TokenScene scene) {
  SetFlags(vocabulary_, asset_set_, repair_.judging, &scene);
  BeginTree(std::move(scene));
}

void SceneSearch::Resume(SearchState state) {
  const auto entries = static_cast<size_t>(vocabulary_.entries);
  const size_t size = entries * static_cast<size_t>(vocabulary_.TokenWidth());
  bool fits = !state.nodes.empty() && state.nodes.size() == state.scenes.size() &&
              state.best >= 0 && state.best < static_cast<int>(state.nodes.size());
  for (const TokenScene& scene : state.scenes) {
    fits = fits && scene.tokens.size() == size && scene.penetrating.size() == entries &&
           scene.unstable.size() == entries;
  }
  if (!fits) throw core::Error("the saved search does not fit the model");
  tree_ = SearchTree(options_.exploration, options_.scaled);
  tree_.Restore(std::move(state.nodes));
  state_ = std::move(state);
  state_.nodes.clear();
}

SearchState SceneSearch::State() const {
  SearchState state = state_;
  state.nodes = tree_.nodes();
  return state;
}

bool SceneSearch::ReachedGoal() const {
  return state_.best >= 0 && state_.best_reward >= reward_.Goal();
}

bool SceneSearch::Finished() const {
  return IterationCount() >= options_.iterations || ReachedGoal() ||
         (!options_.random && tree_.Select() < 0);
}

bool SceneSearch::Confirm(TokenScene* scene) const {
  if (!ConfirmScene(vocabulary_, asset_set_, repair_, scene)) return false;
  if (!final_check_ || RewardOf(*scene) < reward_.Goal()) return true;
  const JudgedScene judged = scene->Judged(vocabulary_);
  const std::vector<int> entries = scene->ObjectEntries(vocabulary_);
  std::vector<scene::SceneObject> objects;
  std::vector<int> checked;  // their entries
  for (size_t i = 0; i < entries.size(); ++i) {
    if (!judged.IsFeasible(i)) continue;
    objects.push_back(judged.objects[i]);
    checked.push_back(entries[i]);
  }
  const std::vector<size_t> moving = final_check_(objects);
  for (const size_t i : moving) scene->unstable[static_cast<size_t>(checked[i])] = 1;
  return moving.empty();
}

void SceneSearch::Consider(int node) {
  const double claimed = tree_.nodes()[static_cast<size_t>(node)].reward;
  if (state_.best >= 0 && claimed <= state_.best_reward) return;
  if (options_.confirms) {
    const core::ScopedTimer timer(&physics_seconds_);
    TokenScene& scene = state_.scenes[static_cast<size_t>(node)];
    if (!Confirm(&scene)) {
      tree_.SetReward(node, RewardOf(scene), IsTerminal(scene));
    }
  }
  const double reward = tree_.nodes()[static_cast<size_t>(node)].reward;
  if (state_.best >= 0 && reward <= state_.best_reward) return;
  state_.best = node;
  state_.best_reward = reward;
}

void SceneSearch::AddChildren(int leaf, std::vector<Draft> drafts, core::Rng* rng) {
  std::vector<int> children;
  for (Draft& draft : drafts) children.push_back(Add(leaf, std::move(draft.scene)));
  state_.samples += static_cast<int>(children.size());
  std::vector<int> order = children;
  const auto reward_of = [&](int node) { return tree_.nodes()[static_cast<size_t>(node)].reward; };
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return reward_of(a) > reward_of(b); });
  for (const int child : order) Consider(child);
  double largest = -HUGE_VAL;
  for (const int child : children) largest = std::max(largest, reward_of(child));
  if (leaf >= 0 && !options_.backs_up_all) {
    const auto one =
        static_cast<size_t>(core::UniformIndex(*rng, static_cast<std::int64_t>(children.size())));
    tree_.Backpropagate(children[one], reward_of(children[one]));
  } else if (leaf >= 0) {
    for (const int child : children) tree_.Backpropagate(child, reward_of(child));
  }
  state_.records.push_back(
      {state_.best_reward, largest, static_cast<int>(tree_.nodes().size()), state_.samples});
}

void SceneSearch::Iterate() {
  core::Rng rng = core::StreamRng(options_.seed, static_cast<std::uint64_t>(IterationCount()) + 1);
  const std::uint64_t seed = rng();
  const int most = std::min(options_.leaves, options_.iterations - IterationCount());
  const std::vector<int> leaves =
      options_.random ? std::vector<int>(static_cast<size_t>(most), -1) : tree_.SelectSeveral(most);
  std::vector<Draft> drafts;
  for (const int leaf : leaves) {
    for (int child = 0; child < options_.branching; ++child) {
      drafts.push_back(leaf < 0 ? UnconditionalDraft() : DraftOf(leaf, child));
    }
  }
  Synthesize(seed, &drafts);
  const SearchState before = State();
  try {
    for (size_t i = 0; i < leaves.size(); ++i) {
      const auto first = std::make_move_iterator(drafts.begin() + static_cast<std::ptrdiff_t>(i) *
                                                                      options_.branching);
      AddChildren(leaves[i], {first, first + options_.branching}, &rng);
    }
  } catch (...) {  // a check was interrupted: the iteration has not happened
    Resume(before);
    throw;
  }
}

}  // namespace simwright::steering
