#pragma once

#include <string>
#include <vector>

#include "assets/semantic_model.h"
#include "tasks/language/scene_description.h"

namespace simwright::tasks {

// The scene of the example that every prompt holds: a chest with a drawer, and a block.
const std::vector<assets::SemanticModel>& ExampleModels();
std::vector<NamedModel> ExampleScene();

// What a good answer says of it: one task of three subtasks, in the form that prompts ask for.
const std::string& ExampleAnswer();

}  // namespace simwright::tasks
