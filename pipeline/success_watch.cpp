#include "pipeline/success_watch.h"

#include "tasks/scene_signals.h"

namespace simwright::pipeline {

struct SuccessWatch::Program {
  explicit Program(const rl::SkillVariant& variant)
      : program(*variant.program),
        workspace(program, 1),
        reader(variant.model, program.slots()),
        bindings(program.slots().size()) {}

  tasks::RewardProgram program;
  tasks::RewardWorkspace workspace;
  tasks::SignalReader reader;
  std::vector<std::vector<float>> values;
  std::vector<tasks::RewardBinding> bindings;
};

SuccessWatch::SuccessWatch(const rl::SkillVariant& variant, double time_step)
    : program_(std::make_unique<Program>(variant)), time_step_(time_step) {}

SuccessWatch::~SuccessWatch() = default;

bool SuccessWatch::Holds(const tasks::SceneState& state, const tasks::SceneState& previous) {
  program_->reader.Read(state, &previous, time_step_, &program_->values);
  for (size_t i = 0; i < program_->values.size(); ++i) {
    program_->bindings[i].data = program_->values[i].data();
  }
  float reward = 0.0f;
  std::uint8_t done = 0;
  program_->program.Run(program_->bindings, 1, &program_->workspace, &reward, &done);
  return done != 0;
}

}  // namespace simwright::pipeline
