#pragma once

#include <string>
#include <vector>

#include "core/finding.h"
#include "scene/feasibility/constrained_scene.h"
#include "scene/model/scene_model.h"
#include "workflows/scenes/scene_source.h"
#include "workflows/scenes/source_assets.h"
#include "workflows/scenes/steering_goal.h"

namespace simwright::workflows {

// The code of the note that an object which a prompt refers to is added.
inline constexpr char kReferenceAdded[] = "reference-added";

struct SteeredObject {
  std::string name;
  scene::SceneObject object;
  int model_class = -1;  // -1: the model does not see it
  bool kept = true;      // has the pose of the input
  bool placed = true;    // false: its new pose is not found yet
  bool added = false;
};

// An object that a model proposes.
struct ProposedObject {
  scene::SceneObject object;
  int slot = -1;  // the object of the scene that it is the new pose of; -1: an object to add
};
using Proposal = std::vector<ProposedObject>;

// One scene on its way from the input to the goal. In each round the model proposes poses and
// objects for what is missing, given all objects that are placed, and physics accepts a part.
class SteeredScene {
 public:
  // Adds a finding for each object whose pose is outside of the model's range, which the model then
  // does not see. Throws core::Error for a goal that the scene cannot have: unknown names in
  // `keep`, more objects than the model's entries, or no object within its range.
  SteeredScene(const SourceScene& source, const SteeringGoal& goal,
               const scene::SceneModelMetadata& metadata, SourceAssets* assets,
               core::Findings* findings);

  const std::string& name() const { return name_; }
  const std::vector<SteeredObject>& objects() const { return objects_; }
  std::vector<scene::SceneObject> Before() const { return before_; }
  std::vector<scene::SceneObject> After() const;  // the placed objects, as Place keeps them

  // Return the number of objects to add or rearrange, and of those that are still missing.
  int asked() const { return asked_; }
  int Missing() const;
  // Returns the names of the missing ones, one each; those to add have none if any name will do.
  std::vector<std::string> MissingNames() const;

  // Returns the prompt of the scene with everything that is asked for, for a model that reads
  // prompts; empty if the goal has no names.
  std::string PromptText() const;

  // Appends one proposal's input for SceneModel::Inpaint.
  void AppendProposal(std::vector<float>* tokens, scene::InpaintingMask* mask) const;
  // Returns the objects that a sampled proposal holds for the missing ones. Throws core::Error if a
  // number is not finite.
  Proposal Proposed(const float* tokens) const;
  // Returns the missing objects of a rearrangement at their old poses.
  Proposal AtOldPoses() const;
  // Returns the objects of a proposal that found a place among the first `there` objects of
  // `placed`, and that are still missing.
  Proposal StillMissing(const Proposal& proposal, const scene::ConstrainedScene& placed,
                        size_t there) const;

  // Moves a proposal to where the relations of the goal hold, places it among the placed objects
  // (PlaceAmong), drops what has moved far sideways and, if `strict`, one object of each relation
  // that does not hold, and checks the result (CheckFree).
  scene::ConstrainedScene Place(const Proposal& proposal, const scene::AssetSet& asset_set,
                                const scene::ConstrainedOptions& options, bool strict) const;

  // Takes over the objects of `placed`, the result of Place for this proposal, and its figures.
  void Accept(const scene::ConstrainedScene& placed, const Proposal& proposal);

  // Returns the statements of the goal that do not hold for the placed objects, and how many do not
  // for `placed`, the result of Place for this proposal. Statements are about the added objects and
  // those that the goal refers to.
  std::vector<std::string> Broken(const scene::CategorySizes& sizes) const;
  int BrokenCount(const scene::ConstrainedScene& placed, const Proposal& proposal,
                  const scene::CategorySizes& sizes) const;

  // The figures of the last accepted check.
  bool stable() const { return stable_; }
  double kept_displacement() const { return kept_displacement_; }
  double drift() const { return drift_; }
  double penetration() const { return penetration_; }
  std::vector<std::string> unstable() const;  // names of kept objects that move by themselves

 private:
  void CheckGoal(const SteeringGoal& goal) const;
  void LeaveOutOfRange(core::Findings* findings);
  void AddMissingReferred(const SteeringGoal& goal, core::Findings* findings);
  bool HasStatements() const { return !prompt_.relations.empty() || !prompt_.tiers.empty(); }
  // Returns the flags of the placed objects, and of `added` ones behind them, that the statements
  // are about.
  std::vector<char> Named(size_t added) const;
  std::vector<size_t> Seen() const;     // the objects with tokens, in the tokens' order
  std::vector<size_t> Placed() const;   // as in After
  std::vector<size_t> Waiting() const;  // rearranged objects without a new pose
  int NewEntries() const;               // tokens of objects to add
  // Returns the names of the objects that are still to add, one each; empty if any name will do.
  std::vector<std::string> NamesToAdd() const;

  std::string name_;
  const scene::SceneModelMetadata& metadata_;
  std::vector<SteeredObject> objects_;
  std::vector<scene::SceneObject> before_;
  bool rearrange_;
  std::vector<scene::NamedCount> names_;  // to add
  scene::Prompt prompt_;                  // its statements are to hold
  int count_, asked_ = 0, added_ = 0;
  bool stable_ = false;
  double kept_displacement_ = 0.0, drift_ = 0.0, penetration_ = 0.0;
  std::vector<size_t> unstable_;
};

}  // namespace simwright::workflows
