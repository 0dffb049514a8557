#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "reward/reward_slot.h"
#include "tasks/world_state.h"

namespace simwright::tasks {

// Reads the inputs of a reward program from world states. Names are resolved once and memory is
// reused. A reader serves one thread.
class SignalReader {
 public:
  // Throws core::Error for a slot of an asset or link that the model does not have. `model` must
  // outlive the reader.
  SignalReader(const WorldModel& model, const std::vector<reward::RewardSlot>& slots);
  ~SignalReader();
  SignalReader(const SignalReader&) = delete;
  SignalReader& operator=(const SignalReader&) = delete;

  // Writes the numbers of each slot, as RewardInput defines them. Velocities are finite differences
  // to `previous`, `time_step` (s) earlier; zero where it is null. `values` is resized to the
  // slots, and each entry to its width. Parameters hold zeros. Allocates nothing after the first
  // call.
  void Read(const WorldState& state, const WorldState* previous, double time_step,
            std::vector<std::vector<float>>* values);

 private:
  class StatePoses;
  struct Place;
  void Write(std::size_t slot, double time_step, std::vector<float>* row);
  void WriteGripper(std::size_t slot, double time_step, std::vector<float>* row);
  void WriteJoint(std::size_t slot, double time_step, std::vector<float>* row);

  const WorldModel& model_;
  std::vector<reward::RewardSlot> slots_;
  std::vector<Place> places_;
  std::unique_ptr<StatePoses> now_, before_;
};

// Reads one state. Throws as SignalReader does.
void SlotValues(const WorldModel& model, const WorldState& state, const WorldState* previous,
                double time_step, const std::vector<reward::RewardSlot>& slots,
                std::vector<std::vector<float>>* values);

}  // namespace simwright::tasks
