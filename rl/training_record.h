#pragma once

#include <array>

namespace simwright::rl {

// One logged iteration of a training. Unknown values are NaN, such as returns before the first
// finished episode.
struct TrainingRecord {
  double iteration = 0, samples = 0, seconds = 0;  // since the start, over all runs
  double episodes = 0;                             // finished episodes
  // Over the last TrainingOptions::success_window episodes.
  double mean_return = 0, mean_steps = 0;
  double success = 0, success_low = 0, success_high = 0;  // rate and its 95 % interval
  double examined = 0;  // success rate of the examination after this iteration, else NaN
  // From UpdateReport.
  double kl = 0, learning_rate = 0, policy_loss = 0, value_loss = 0, entropy = 0, std = 0;
  double clipped_share = 0, gradient_norm = 0, explained_variance = 0;
  // The samples over the total time of this iteration, and the share of that time spent learning.
  double samples_per_second = 0, learner_share = 0;
  double dropped = 0;  // samples with non-finite numbers, since the start
};

struct TrainingColumn {
  const char* name;
  double TrainingRecord::*value;
};

// The columns of the log, in order.
constexpr std::array<TrainingColumn, 22> kTrainingColumns = {{
    {"iteration", &TrainingRecord::iteration},
    {"samples", &TrainingRecord::samples},
    {"seconds", &TrainingRecord::seconds},
    {"episodes", &TrainingRecord::episodes},
    {"mean_return", &TrainingRecord::mean_return},
    {"mean_steps", &TrainingRecord::mean_steps},
    {"success", &TrainingRecord::success},
    {"success_low", &TrainingRecord::success_low},
    {"success_high", &TrainingRecord::success_high},
    {"examined", &TrainingRecord::examined},
    {"kl", &TrainingRecord::kl},
    {"learning_rate", &TrainingRecord::learning_rate},
    {"policy_loss", &TrainingRecord::policy_loss},
    {"value_loss", &TrainingRecord::value_loss},
    {"entropy", &TrainingRecord::entropy},
    {"std", &TrainingRecord::std},
    {"clipped_share", &TrainingRecord::clipped_share},
    {"gradient_norm", &TrainingRecord::gradient_norm},
    {"explained_variance", &TrainingRecord::explained_variance},
    {"samples_per_second", &TrainingRecord::samples_per_second},
    {"learner_share", &TrainingRecord::learner_share},
    {"dropped", &TrainingRecord::dropped},
}};

}  // namespace simwright::rl
