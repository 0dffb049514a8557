#pragma once

#include <vector>

#include "scene/feasibility/kept_relation.h"
#include "scene/grammar/category_size.h"
#include "scene/grammar/scene_sample.h"
#include "scene/prompt/prompt.h"

namespace simwright::scene {

// Returns the relations that a prompt asks for between the free objects of a scene, for a
// projection: bodies are the scene's objects, in their order. An ordinal selects an object in
// OrdinalOrder; a reference without ordinal selects the pair for which the relation holds or, if
// there is none, the nearest pair. Statements about objects that the scene lacks, and those about
// shelf tiers, are left out. Throws core::Error for an invalid prompt or a free category without a
// size.
std::vector<KeptRelation> AskedRelations(const Prompt& prompt,
                                         const std::vector<SceneObject>& objects,
                                         const CategorySizes& sizes);

}  // namespace simwright::scene
