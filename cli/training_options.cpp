#include "cli/training_options.h"

namespace simwright::cli {

void AddTrainingOptions(CLI::App* command, int* environments, std::int64_t* samples,
                        double* minutes, double* target, int* episodes, std::int64_t* imitated) {
  command->add_option("--envs", *environments, "Number of parallel environments")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("--steps", *samples, "Maximum number of decisions per subtask")
      ->check(CLI::Range(1000, 2000000000))
      ->capture_default_str();
  command->add_option("--minutes", *minutes, "Maximum training time per subtask; 0: unlimited")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  command
      ->add_option("--target", *target,
                   "Learnt once the lower bound of the success rate's 95 % interval is above this")
      ->check(CLI::Range(0.0, 0.99))
      ->capture_default_str();
  command->add_option("--episodes", *episodes, "Episodes per evaluation")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--imitate", *imitated,
                   "Initial decisions per subtask that imitate a scripted expert; 0: PPO alone")
      ->check(CLI::Range(0, 2000000000))
      ->capture_default_str();
}

}  // namespace simwright::cli
