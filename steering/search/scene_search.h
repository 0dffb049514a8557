#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scene/model/inpainting_mask.h"
#include "steering/rewards/scene_reward.h"
#include "steering/search/mask_generator.h"
#include "steering/search/scene_repair.h"
#include "steering/search/search_tree.h"

namespace simwright::steering {

struct SearchOptions {
  int iterations = 500;
  int branching = 3;         // children per expanded node, sampled in one batch
  double exploration = 0.2;  // of UctValue; 1.4 in the paper, whose rewards are counts of objects
  bool scaled = true;        // UCT compares rewards on a scale of 0 to 1 (SearchTree)
  // True: the reward of each child is backpropagated, since all are judged for their masks anyway;
  // false: that of one at random, as published.
  bool backs_up_all = true;
  int leaves = 1;  // expanded together in an iteration, as several iterations
  // The most padding entries that the first child of an expansion fills with objects, whose class
  // must not be the empty one; each further child fills half as many, and at least one. 0: all
  // masked padding is synthesized, and the model chooses what becomes an object, as published.
  int fill = 4;
  // The most objects of a scene but furniture that filling aims at; 0: no limit.
  int most_objects = 0;
  // The classes that synthesized entries may have, one flag per class but the empty one; empty:
  // all.
  std::vector<char> allowed = {};
  // Scenes that would be the best so far pass ConfirmScene first.
  bool confirms = true;
  // Draws unconditional samples instead of searching: as many, repaired and judged alike.
  bool random = false;
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

// Synthesizes the masked values of scenes: tokens (count x entries x TokenWidth), their mask, a
// seed.
using Inpainter = std::function<std::vector<float>(const std::vector<float>&,
                                                   const scene::InpaintingMask&, std::uint64_t)>;

// A last check of the objects of a scene that reaches the goal; returns the indices of those that
// move. It may be slow, as a check in a second simulator is.
using FinalCheck = std::function<std::vector<size_t>(const std::vector<scene::SceneObject>&)>;

// An iteration: the expansion of one leaf.
struct SearchRecord {
  double best = 0.0;    // the largest confirmed reward so far
  double reward = 0.0;  // the largest of its children
  int nodes = 0;        // of the tree
  int samples = 0;      // scenes sampled so far, the root included
};

// The state of a search after some iterations; with the same options it continues as if it had not
// stopped, since each iteration draws from a random stream of its own.
struct SearchState {
  std::vector<TreeNode> nodes;
  std::vector<TokenScene> scenes;  // one per node
  std::vector<SearchRecord> records;
  int best = -1;  // the node with the largest confirmed reward
  double best_reward = 0.0;
  int samples = 0;
};

// Searches the tree of partial scenes for the scene with the largest reward (Monte Carlo tree
// search by inpainting, Pfaff et al.): a node is a scene; a leaf is selected by UCT; its children
// are inpaintings of what the mask says, repaired and judged; their rewards are backpropagated. The
// result depends neither on the number of threads nor on interruptions.
class SceneSearch {
 public:
  // All references outlive the search. Throws core::Error for invalid options.
  SceneSearch(const scene::Vocabulary& vocabulary, const scene::AssetSet& asset_set,
              const MaskGenerator& mask, const SceneReward& reward, Inpainter inpainter,
              const SearchOptions& options, const RepairOptions& repair = {});

  // Sets a check that scenes which reach the goal pass after ConfirmScene. The objects that it
  // finds become unstable, and the search goes on.
  void SetFinalCheck(FinalCheck check) { final_check_ = std::move(check); }

  // Starts with an unconditional sample, with a given scene, which is judged but not repaired, or
  // where a search stopped. Throws core::Error for a state that does not fit the vocabulary.
  void Start();
  void StartWith(TokenScene scene);
  void Resume(SearchState state);

  // Returns true if the iterations are used up, the goal of the reward is reached, or nothing is
  // left to expand.
  bool Finished() const;
  // Runs one iteration, or as many as options.leaves.
  void Iterate();

  int IterationCount() const { return static_cast<int>(state_.records.size()); }
  bool ReachedGoal() const;
  const SearchTree& tree() const { return tree_; }
  const std::vector<TokenScene>& scenes() const { return state_.scenes; }
  const std::vector<SearchRecord>& records() const { return state_.records; }
  int best() const { return state_.best; }
  double best_reward() const { return state_.best_reward; }
  SearchState State() const;
  // s, since this object was made, of the model and of physics.
  double model_seconds() const { return model_seconds_; }
  double physics_seconds() const { return physics_seconds_; }

 private:
  // A scene to be synthesized: its tokens, and one flag per entry.
  struct Draft {
    TokenScene scene;
    std::vector<char> synthesized;
    std::vector<char> filled;  // entries whose class must not be the empty one
  };
  void BeginTree(TokenScene root);
  Draft DraftOf(int leaf, int child) const;
  Draft Blanked(Draft draft) const;
  Draft UnconditionalDraft() const;
  void AppendTo(const Draft& draft, std::vector<float>* tokens, scene::InpaintingMask* mask) const;
  // Samples, repairs and judges the drafts.
  void Synthesize(std::uint64_t seed, std::vector<Draft>* drafts);
  // Adds a scene to the tree, below a node, -1: beside it, and returns its number.
  int Add(int parent, TokenScene scene);
  void AddChildren(int leaf, std::vector<Draft> drafts, core::Rng* rng);
  // Makes the node the best one if it is and passes the check; corrects its reward if it does not.
  void Consider(int node);
  // Runs the checks of a scene that would be the best; returns false if they set a flag.
  bool Confirm(TokenScene* scene) const;
  double RewardOf(const TokenScene& scene) const;
  bool IsTerminal(const TokenScene& scene) const;

  scene::Vocabulary vocabulary_;
  const scene::AssetSet& asset_set_;
  const MaskGenerator& mask_;
  const SceneReward& reward_;
  Inpainter inpainter_;
  FinalCheck final_check_;
  SearchOptions options_;
  RepairOptions repair_;
  SearchTree tree_;
  SearchState state_;  // nodes: in tree_
  double model_seconds_ = 0.0, physics_seconds_ = 0.0;
};

}  // namespace simwright::steering
