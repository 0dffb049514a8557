#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/finding.h"
#include "tasks/reward/reward_program.h"
#include "tasks/scene_state.h"
#include "tasks/task.h"

namespace simwright::tasks {

struct VerificationOptions {
  // Rank correlation of reward and progress along a path to success. Planted sign faults fall below
  // the first bound, sound programs lie above the second (docs/rewards.md, "Planted faults");
  // between them it is a warning.
  double against = -0.2;
  double unclear = 0.2;
  int random_states = 128;  // in which reward and success are looked at beside the paths
  // A program of the command line may be without success: Eureka's have none.
  bool needs_success = true;
  std::string entry;  // the function that gives the reward; empty: found by its name
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

// Checks reward programs on a scene, before anything is trained (docs/rewards.md lists the codes):
// it compiles; reward and success depend on the state; success does not hold at the start, comes
// within the joints' limits and the arm's reach, and the reward rises on the way there; the title
// says the same. Paths are kinematic (verification/motion.h). One thread at a time.
class SubtaskVerifier {
 public:
  // `model` must outlive it. Throws core::Error for invalid options.
  SubtaskVerifier(const SceneModel& model, const VerificationOptions& options = {});

  // The findings of subtask->program. Where subtask->start places nothing it is filled in: the end
  // of the subtask before it in `task`, as verified by this object, else a new layout; and
  // subtask->goal where the program asks for one and there is none. An empty subtask->success
  // becomes the program's own words. Never throws for what is in the program.
  core::Findings Verify(const Task& task, Subtask* subtask);

 private:
  // Where the subtask before ended, if all that `program` looks at stood there.
  std::optional<InitialState> EndBefore(const Task& task, const Subtask& subtask,
                                        const RewardProgram& program) const;

  const SceneModel& model_;
  VerificationOptions options_;
  std::map<std::pair<std::string, std::string>, InitialState> ends_;  // by task and subtask
};

}  // namespace simwright::tasks
