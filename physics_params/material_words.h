#pragma once

#include <string>
#include <vector>

#include "physics_params/category_resolution.h"
#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// Returns `found`, the resolution of the words from `head` on, with regard to the materials among
// the words before: the row's own material or the variant made of it. A solid row is refused (no
// category) if the densities of its materials all differ from the named one's by more than a factor
// of 2: a die of foam has little in common with a die. Other rows keep their own materials.
Resolution WithNamedMaterial(const std::vector<std::string>& words, size_t head,
                             const KnowledgeBase& base, Resolution found);

}  // namespace simwright::physics_params
