#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace simwright::rl {

// One row per environment.
using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The results of one step of N environments. Reused from step to step.
struct StepBatch {
  // (N x O) the next observations: where an episode ended, the first of the next episode.
  Rows observations;
  // (N x O) where an episode ended, its last observation before the reset; other rows are
  // unspecified.
  Rows last_observations;
  std::vector<float> rewards;            // (N)
  std::vector<std::uint8_t> terminated;  // (N) the task ended the episode: no successor value
  std::vector<std::uint8_t> truncated;   // (N) the time limit was reached: bootstrap the value
  std::vector<std::uint8_t> success;     // (N) where an episode ended: with success
};

// N parallel episodes, each of which restarts after its end.
class VectorEnvironment {
 public:
  virtual ~VectorEnvironment() = default;

  virtual int size() const = 0;              // N
  virtual int observation_size() const = 0;  // O
  virtual int action_size() const = 0;       // A, each in [-1, 1]

  // Restarts all episodes, `observations` (N x O). The same seed and actions give the same
  // episodes, for any number of threads.
  virtual void Reset(std::uint64_t seed, Rows* observations) = 0;

  // Executes `actions` (N x A), clamped to [-1, 1].
  virtual void Step(const Rows& actions, StepBatch* batch) = 0;

  // Writes an expert's current actions (N x A). Returns false if there is no expert.
  virtual bool Demonstrate(Rows* /*actions*/) const { return false; }

  // Returns the complete state, so that a resumed training equals an uninterrupted one.
  virtual std::string SaveState() const = 0;
  // Throws core::Error for a state of another environment.
  virtual void RestoreState(std::string_view state, Rows* observations) = 0;
};

}  // namespace simwright::rl
