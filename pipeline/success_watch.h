#pragma once

#include <memory>

#include "rl/skill.h"

namespace simwright::pipeline {

// Asks the success program of a subtask about states that a replay went through. One thread at a
// time.
class SuccessWatch {
 public:
  // `variant` must outlive the watch; `time_step`: s from one state to the next.
  SuccessWatch(const rl::SkillVariant& variant, double time_step);
  ~SuccessWatch();
  SuccessWatch(const SuccessWatch&) = delete;
  SuccessWatch& operator=(const SuccessWatch&) = delete;

  // Whether the subtask is done in `state`, `previous` one time step before it.
  bool Holds(const tasks::SceneState& state, const tasks::SceneState& previous);

 private:
  struct Program;
  std::unique_ptr<Program> program_;
  double time_step_;
};

}  // namespace simwright::pipeline
