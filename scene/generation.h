#pragma once

#include <string>

#include "core/progress.h"
#include "scene/dataset/scene_part.h"
#include "scene/feasible_scene.h"
#include "scene/grammar/grammar.h"
#include "scene/palette.h"

namespace simwright::scene {

// What is common to all parts of a dataset that is drawn from a grammar.
struct Generation {
  Grammar grammar;
  const Palette* palette = nullptr;  // not null; outlives it
  FeasibilityOptions feasibility;
  // Attempts a sound scene, at most, over a part: what yields less is given up.
  int attempts_a_scene = 50;
};

// Draws scenes, moves them apart and leaves them to gravity until `part` has `scenes` sound ones;
// goes on where it stands, in parallel, and is the same for any number of threads and of
// interruptions. `part` has its vocabulary and origin. Attempt k of part p draws from stream
// p 2^32 + k of the seed. Advances `progress` by one for each new scene; where that throws
// core::Cancelled, the part holds what was made before. Throws core::Error for a slot without an
// asset, and where sound scenes are too rare, with what became of them.
void ExtendPart(const Generation& generation, int scenes, ScenePart* part,
                core::Progress* progress);

// The settings as JSON: of two that are alike, scenes are.
std::string SettingsText(const Generation& generation);

}  // namespace simwright::scene
