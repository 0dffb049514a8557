#pragma once

#include <array>

namespace simwright::rl {

// One iteration of a training, as it is written down. What is not known yet is NaN: returns before
// the first episode has ended.
struct TrainingRecord {
  double iteration = 0, samples = 0, seconds = 0;  // since the start, over all runs
  double episodes = 0;                             // that have ended
  // Over the last so many episodes (TrainingOptions::success_window).
  double mean_return = 0, mean_steps = 0;
  double success = 0, success_low = 0, success_high = 0;  // rate, and its 95 % interval
  double examined = 0;  // success rate of an examination after this iteration, else NaN
  // UpdateReport's.
  double kl = 0, learning_rate = 0, policy_loss = 0, value_loss = 0, entropy = 0, std = 0;
  double clipped_share = 0, gradient_norm = 0, explained_variance = 0;
  // Of this iteration: samples over all its time, and the share of it that went into learning.
  double samples_per_second = 0, learner_share = 0;
  double dropped = 0;  // samples with numbers that are not finite, since the start
};

struct TrainingColumn {
  const char* name;
  double TrainingRecord::*value;
};

// In the order of the log's columns.
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
