#pragma once

#include <vector>

#include "scene/feasibility/kept_relation.h"
#include "scene/grammar/category_size.h"
#include "scene/grammar/scene_sample.h"
#include "scene/prompt/prompt.h"

namespace simwright::scene {

// Returns the relations and tiers that a prompt asks for in a scene, for a projection: bodies are
// the scene's objects, in their order. `named`: flags of the objects that the prompt means, one for
// each; empty: all that are not welded. An ordinal selects an object in OrdinalOrder; a reference
// without ordinal selects the pair for which the relation holds or, if there is none, the nearest
// pair; a tier is that of the nearest shelf. Statements about objects that the scene lacks, and
// those of which nothing can move, are left out. Throws core::Error for an invalid prompt, a wrong
// number of flags, or a named category without a size.
std::vector<KeptRelation> AskedRelations(const Prompt& prompt,
                                         const std::vector<SceneObject>& objects,
                                         const CategorySizes& sizes,
                                         const std::vector<char>& named = {});

// Moves objects that are not welded by the least displacements, m, with which the asked relations
// hold, collisions aside. Moves nothing if the relations contradict each other. `named` and errors:
// as of AskedRelations.
void EstablishRelations(const Prompt& prompt, const CategorySizes& sizes,
                        const std::vector<char>& named, std::vector<SceneObject>* objects);

}  // namespace simwright::scene
