#pragma once

#include <string>
#include <vector>

#include "core/random.h"
#include "tasks/layout.h"
#include "tasks/rules/planner.h"

namespace simwright::tasks {

// What a task is about, before it is known to be possible.
struct Idea {
  std::string name;         // "put_mug_into_microwave_and_close"
  std::string description;  // a sentence
  LayoutRequest layout;     // its things, and what is not at rest
  std::vector<Fact> goals;  // brought about in this order
};

// All ideas on the model's things, mixed: kinds of tasks take turns, and within a kind things do,
// in an order drawn from `rng`. At most `most`.
std::vector<Idea> ThinkOfTasks(const SceneModel& model, std::size_t most, core::Rng& rng);

}  // namespace simwright::tasks
