#pragma once

#include <string>
#include <vector>

#include "core/finding.h"
#include "scene/dataset/vocabulary.h"
#include "scene/prompt/prompt.h"

namespace simwright::workflows {

// The goal of a steered scene: completion adds objects to those there, rearrangement finds new
// poses for those that are not kept.
struct SteeringGoal {
  bool rearrange = false;
  int count = -1;  // completion: the number of objects to add; -1: the model's choice
  // Completion: the objects to add by name, `count` in all; empty: of any name.
  std::vector<scene::NamedCount> names = {};
  // Completion: the objects that a prompt refers to, "next to the bowl": of the scene, or added
  // where it has fewer.
  std::vector<scene::NamedCount> referred = {};
  scene::Prompt prompt = {};           // completion: the relations and tiers that are to hold
  std::vector<std::string> keep = {};  // rearrangement: the names of the objects that stay
};

// Sets the objects to add from free text (scene::ReadPrompt), "two apples and a can on the top
// shelf", or from a number of objects. Adds the findings of its words, and a warning for objects
// that are not named, which a completion does not add. Throws core::Error for a text that asks for
// no objects, and as ReadPrompt does.
void SetGoalFromPrompt(const std::string& text, const scene::Vocabulary& vocabulary,
                       SteeringGoal* goal, core::Findings* findings);

}  // namespace simwright::workflows
