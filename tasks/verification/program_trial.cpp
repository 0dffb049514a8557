#include "tasks/verification/program_trial.h"

#include "tasks/world_signals.h"

namespace simwright::tasks {

TrialResult RunOnStates(const reward::RewardProgram& program, const WorldModel& model,
                        const std::vector<WorldState>& states, bool follows) {
  TrialResult result;
  if (states.empty()) return result;
  const std::vector<reward::RewardSlot>& slots = program.slots();
  std::vector<std::vector<float>> rows(slots.size());
  std::vector<std::vector<float>> values;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const WorldState* previous = follows && i > 0 ? &states[i - 1] : nullptr;
    SlotValues(model, states[i], previous, kMotionTimeStep, slots, &values);
    for (std::size_t s = 0; s < slots.size(); ++s) {
      if (slots[s].uniform && i > 0) continue;
      rows[s].insert(rows[s].end(), values[s].begin(), values[s].end());
    }
  }
  std::vector<reward::RewardBinding> bindings;
  for (const std::vector<float>& row : rows) bindings.push_back({row.data()});
  const int count = static_cast<int>(states.size());
  result.reward.resize(states.size());
  result.success.assign(states.size(), 0);
  reward::RewardWorkspace workspace(program, count);
  program.Run(bindings, count, &workspace, result.reward.data(),
              program.has_success() ? result.success.data() : nullptr);
  return result;
}

std::vector<WorldState> RandomStates(const WorldModel& model, const WorldState& start,
                                     const std::vector<reward::RewardSlot>& slots, int count,
                                     core::Rng& rng) {
  std::vector<int> objects;
  for (const reward::RewardSlot& slot : slots) {
    const int object = model.Find(slot.asset);
    if (object >= 0 && (objects.empty() || objects.back() != object)) objects.push_back(object);
  }
  std::vector<WorldState> states;
  for (int i = 0; i < count; ++i) {
    WorldState state = start;
    for (int object : objects) {
      const auto t = static_cast<std::size_t>(object);
      const ArticulatedObject& known = model.objects[t];
      for (std::size_t j = 0; j < known.joints.size(); ++j) {
        const double beyond = 0.2 * (known.joints[j].upper - known.joints[j].lower);
        state.joints[t][j] =
            core::Uniform(rng, known.joints[j].lower - beyond, known.joints[j].upper + beyond);
      }
      if (known.articulated()) continue;
      const double reach = core::Uniform(rng);  // mixes near and far positions
      state.roots[t].translation() += reach * core::UniformDirection(rng);
      state.roots[t].rotate(
          Eigen::AngleAxisd(core::Uniform(rng, 0.0, 3.0), core::UniformDirection(rng)));
    }
    const Eigen::Vector3d around = core::Uniform(rng) * core::UniformDirection(rng);
    state.touched = -1;
    state.grasped = false;
    if (!objects.empty() && core::Uniform(rng) < 0.6) {
      const int object = objects[static_cast<std::size_t>(
          core::UniformIndex(rng, static_cast<std::int64_t>(objects.size())))];
      const auto links =
          static_cast<std::int64_t>(model.objects[static_cast<std::size_t>(object)].links.size());
      const int link = static_cast<int>(core::UniformIndex(rng, links));
      state.gripper.translation() = LinkPosition(model, state, object, link) + 0.05 * around;
      state.touched = object;
      state.touched_link = link;
      state.grasped = core::Uniform(rng) < 0.5;
    } else {
      state.gripper.translation() += around;
    }
    state.opening = core::Uniform(rng, 0.0, 0.08);
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace simwright::tasks
