#pragma once

#include <string>
#include <vector>

#include "assets/semantic_model.h"
#include "tasks/language/scene_description.h"

namespace simwright::tasks {

// Returns the scene of the example in every prompt: a chest with a drawer, and a block.
const std::vector<assets::SemanticModel>& ExampleModels();
std::vector<NamedModel> ExampleScene();

// Returns the example answer: one task with three subtasks, in the form that prompts ask for.
const std::string& ExampleAnswer();

}  // namespace simwright::tasks
