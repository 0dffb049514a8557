#pragma once

#include <string>
#include <vector>

#include "core/random.h"
#include "tasks/layout.h"
#include "tasks/rules/planner.h"

namespace simwright::tasks {

// A task candidate: the content of a task before it is known to be feasible.
struct TaskCandidate {
  std::string name;              // "put_mug_into_microwave_and_close"
  std::string description;       // a sentence
  LayoutRequest layout;          // its objects, and the joints that are not at rest
  std::vector<Predicate> goals;  // the goal predicates, achieved in this order
};

// Returns up to `most` task candidates for the model's objects, interleaved: the kinds of tasks
// alternate, and within a kind the objects do, in an order sampled from `rng`.
std::vector<TaskCandidate> GenerateCandidates(const WorldModel& model, std::size_t most,
                                              core::Rng& rng);

}  // namespace simwright::tasks
