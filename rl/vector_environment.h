#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace simwright::rl {

// One row an environment.
using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// What one step of N environments gave. Reused from step to step.
struct StepBatch {
  // (N x O) what to act on next: where an episode ended, the first of the one after it.
  Rows observations;
  // (N x O) where an episode ended, its last one, before the reset; other rows hold anything.
  Rows last_observations;
  std::vector<float> rewards;            // (N)
  std::vector<std::uint8_t> terminated;  // (N) the task itself ended the episode: nothing follows
  std::vector<std::uint8_t> truncated;   // (N) time ran out: what would have followed still counts
  std::vector<std::uint8_t> success;     // (N) of an episode that ended: whether with success
};

// N episodes side by side, each of which starts anew when it ended.
class VectorEnvironment {
 public:
  virtual ~VectorEnvironment() = default;

  virtual int size() const = 0;              // N
  virtual int observation_size() const = 0;  // O
  virtual int action_size() const = 0;       // A, each in [-1, 1]

  // Starts all episodes anew, `observations` (N x O). The same seed and actions give the same
  // episodes, for any number of threads.
  virtual void Reset(std::uint64_t seed, Rows* observations) = 0;

  // `actions` (N x A); what lies outside [-1, 1] is clamped.
  virtual void Step(const Rows& actions, StepBatch* batch) = 0;

  // What somebody who knows a way would do now, `actions` (N x A). False where there is nobody.
  virtual bool Demonstrate(Rows* /*actions*/) const { return false; }

  // All that Step depends on, so that a training that was stopped goes on as if it had not been.
  virtual std::string SaveState() const = 0;
  // Throws core::Error for a state of another environment.
  virtual void RestoreState(std::string_view state, Rows* observations) = 0;
};

}  // namespace simwright::rl
