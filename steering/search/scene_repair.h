#pragma once

#include <string>
#include <vector>

#include "scene/asset_set/asset_set.h"
#include "scene/feasibility/constrained_scene.h"
#include "steering/search/token_scene.h"

namespace simwright::steering {

// The treatment of synthesized objects before they are judged.
enum class Repair {
  kNone,     // they are judged as they are (Pfaff et al.)
  kProject,  // they are separated from what stands, lowered, settled and checked
};

struct RepairOptions {
  Repair repair = Repair::kProject;
  JudgingOptions judging;  // of kNone, and of a scene that a search starts from
  scene::ConstrainedOptions placing = DefaultPlacing();
  // m: an object that repair moves farther sideways is dropped, such as through the side of a
  // shelf.
  double most_sideways = 0.15;

  // Returns options that lower by up to 0.25 m, about a shelf spacing, and settle at most 0.6 s at
  // 2 ms, once and without a check of their own. The check of what touches takes a quarter of a
  // second, with the speed that the full check of two seconds allows.
  static scene::ConstrainedOptions DefaultPlacing();
  bool IsValid(std::string* error) const;
};

// Judges the scene with physics, object by object, and sets its flags. Thread-safe. Throws
// core::Error as Judge does.
void SetFlags(const scene::Vocabulary& vocabulary, const scene::AssetSet& asset_set,
              const JudgingOptions& options, TokenScene* scene);

// Repairs and judges the synthesized entries of a scene (flags, one per entry). With kProject, each
// finds a place among the others, which keep their tokens bit by bit, or becomes padding: it is
// dropped if it penetrates, falls, topples or moves, or makes what it touches move, in a check of
// `placing`. Only the group of objects that touch a new one is free in
// that check; the others are at rest already. Thread-safe. Throws core::Error for poses that are
// not finite or a category without an asset.
void RepairScene(const std::vector<char>& synthesized, const scene::Vocabulary& vocabulary,
                 const scene::AssetSet& asset_set, const RepairOptions& options, TokenScene* scene);

// Checks the feasible objects of a scene for two seconds with all of them free, and sets the flag
// `unstable` of those that move or disturb. Returns true if there are none.
bool ConfirmScene(const scene::Vocabulary& vocabulary, const scene::AssetSet& asset_set,
                  const RepairOptions& options, TokenScene* scene);

}  // namespace simwright::steering
