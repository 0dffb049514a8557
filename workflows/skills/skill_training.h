#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "rl/communicator.h"
#include "skills/skill_chain.h"
#include "workflows/skills/skill_run.h"

namespace simwright::workflows {

struct TrainRequest {
  std::filesystem::path task_file;
  std::vector<std::string> tasks;  // names or patterns (ChooseTasks)
  std::filesystem::path output;
  std::string robot = "panda";
  skills::ActionSpace action = skills::ActionSpace::kTargetFrame;
  bool proved_grasps = true;  // SkillRun::proved_grasps
  double episode_seconds = skills::SkillOptions().episode_seconds;
  // The friction of the fingers' surfaces, sampled per episode: from worn plastic to the rubber
  // tips of the Panda's URDF.
  skills::FactorRange finger_friction = {0.8, 2.0};
  // The ranges of the objects' placements (SkillOptions), of a twin: of all assets of the tasks.
  // Empty: the default ones.
  std::map<std::string, skills::PlacementRange> placement_ranges = {};
  bool randomized = true;  // SkillRun::randomized
  int environments = 64;
  std::int64_t samples = 2'000'000;  // per subtask, at most
  double minutes = 30.0;             // per subtask, at most; 0: unlimited
  // The decisions at the beginning of each subtask that imitate a scripted expert
  // (rl/scripted_hand.h), if there is one for the action space; 0: PPO alone. Imitation shortens
  // training several times.
  std::int64_t imitated_samples = 65'536;
  // A subtask counts as learnt once the lower bound of the 95 % interval of its success rate
  // exceeds this.
  double target = 0.92;
  int episodes = 200;  // per evaluation
  // If the next subtask's success drops by more than `largest_handover_loss` when it starts where a
  // subtask ends, that subtask is trained for `backward_samples` more decisions to end better; 0:
  // no backward tuning.
  double largest_handover_loss = 0.05;
  std::int64_t backward_samples = 120'000;
  std::uint64_t seed = 1;
  bool resume = false;
  // The ranks that train together; `environments`, `samples` and the minibatches are of all of
  // them.
  rl::Communicator* ranks = rl::SingleProcess();
};

// The outcome of training a subtask further so that it ends where the next one can start.
struct BackwardTuning {
  std::int64_t samples = 0;
  double seconds = 0.0;
  double before = 0.0, after = 0.0;  // success rate of both in sequence
  bool kept = false;                 // the success rate rose, and the new policy is kept
};

// The numbers of training decisions that PPO did not learn from: those in which the policy imitated
// a scripted expert (DAgger), and those from which only the critic learnt while a guided gripper
// followed the scripted expert unchanged.
struct LearningShares {
  std::int64_t imitated = 0, critic_alone = 0;
};

// The outcome of training one subtask.
struct TrainedSkill {
  std::string name;
  std::filesystem::path folder;
  std::int64_t samples = 0;
  double seconds = 0.0;
  LearningShares shares;
  skills::SkillEvaluation own;           // from its own starts
  skills::SkillEvaluation handover;      // from the previous subtask's ends; empty for the first
  std::optional<BackwardTuning> tuning;  // for the next subtask
  // Returns "imitation of a scripted expert", "a scripted expert", "PPO", or for example "imitation
  // of a scripted expert (66k decisions), then PPO".
  std::string Method() const;
  // Returns the success rate lost by starting there: the own rate minus the handover rate.
  double HandoverLoss() const { return own.rate() - handover.rate(); }
};

struct TrainReport {
  std::filesystem::path folder;
  std::vector<TrainedSkill> skills;
  skills::ChainEvaluation chain;      // the whole task's; empty if it has one subtask
  std::map<std::string, int> grasps;  // GraspCounts
  core::Findings findings;            // about the assets

  double success() const;  // the whole task's rate
};

// Trains a task's subtasks in order into request.output, then evaluates them, alone and as a chain.
// Each subtask first imitates a scripted expert, if there is one, and then uses PPO until it is
// learnt or its time is used up; later ones mostly start from successful ends of the previous one.
// A subtask that is already trained is kept unchanged; with `resume` an interrupted one is resumed.
// Throws core::Error (as ChooseTasks, WriteRun, MakeSkill and TrainPolicy do, for placement ranges
// that lack an asset, or if another process trains there) and core::Cancelled, keeping all trained
// results.
TrainReport TrainTask(const TrainRequest& request, core::Progress* progress);

// The part in TrainTask of the ranks other than the first, which calls that: trains with it, and
// returns when it has nothing more to train. Everything else, such as evaluations and the tuning
// for the next subtask, is rank 0's. Throws core::Error as TrainTask does.
void FollowTraining(const TrainRequest& request);

// Format the report for a terminal and for machines. report.json in the run's folder has the
// latter.
std::string TrainTable(const TrainReport& report);
std::string TrainJson(const TrainReport& report);

}  // namespace simwright::workflows
