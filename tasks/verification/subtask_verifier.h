#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/finding.h"
#include "reward/reward_program.h"
#include "tasks/task.h"
#include "tasks/world_state.h"

namespace simwright::tasks {

struct VerificationOptions {
  // The thresholds on the rank correlation of reward and progress along a path to success. Planted
  // sign faults fall below `against`, valid programs lie above `unclear` (docs/rewards.md, "Planted
  // faults"); a value between them gives a warning.
  double against = -0.2;
  double unclear = 0.2;
  int random_states = 128;  // states evaluated in addition to the paths
  // True if a program must return success. Programs given on the command line need not: Eureka's
  // have none.
  bool needs_success = true;
  std::string entry;  // the reward function; empty: found by its name
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

// Checks reward programs on a scene before training (docs/rewards.md lists the codes). The program
// must compile. Reward and success must depend on the state. Success must not hold at the start and
// must be achievable within the joints' limits and the arm's reach, and the reward must increase on
// the path to it. The title must describe the same motion. Paths are kinematic
// (verification/motion.h). Not thread-safe.
class SubtaskVerifier {
 public:
  // Throws core::Error for invalid options. `model` must outlive the verifier.
  SubtaskVerifier(const WorldModel& model, const VerificationOptions& options = {});

  // Returns the findings of subtask->program. If subtask->start places nothing, fills it with the
  // end state of the preceding subtask in `task`, as verified by this object, or else with a new
  // layout. Fills subtask->goal if the program reads a goal and there is none. An empty
  // subtask->success becomes the source expression of the program's success. Never throws because
  // of the program.
  core::Findings Verify(const Task& task, Subtask* subtask);

 private:
  // Returns the end state of the preceding subtask, if it places every object that `program` reads.
  std::optional<InitialState> PreviousEndState(const Task& task, const Subtask& subtask,
                                               const reward::RewardProgram& program) const;

  const WorldModel& model_;
  VerificationOptions options_;
  std::map<std::pair<std::string, std::string>, InitialState> ends_;  // by task and subtask
};

}  // namespace simwright::tasks
