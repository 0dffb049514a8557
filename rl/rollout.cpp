#include "rl/rollout.h"

namespace simwright::rl {

void Rollout::Resize(int new_steps, int new_environments, int observation_size, int action_size) {
  steps = new_steps;
  environments = new_environments;
  const Eigen::Index all = static_cast<Eigen::Index>(steps) * environments;
  observations.resize(all, observation_size);
  actions.resize(all, action_size);
  means.resize(all, action_size);
  shown.resize(0, action_size);
  const auto count = static_cast<std::size_t>(all);
  log_densities.assign(count, 0.0f);
  rewards.assign(count, 0.0f);
  terminated.assign(count, 0);
  truncated.assign(count, 0);
  dropped.assign(count, 0);
  next_observations.resize(environments, observation_size);
  last_observations.resize(0, observation_size);
  last_rows.clear();
}

}  // namespace simwright::rl
