#include "workflows/skills/skill_demonstrations.h"

#include <algorithm>

#include "core/error.h"
#include "core/json.h"
#include "skills/episode.h"
#include "skills/start_pool.h"
#include "skills/tool_command.h"

namespace simwright::workflows {
namespace {

constexpr size_t kValidEvery = 10;
constexpr char kVersion[] = SIMWRIGHT_VERSION;
constexpr const char* kDemonstrationRemedy = "give a file of `simwright export --format robomimic`";

// Packs rows of equal width into an array.
template <typename T>
core::Hdf5Array<T> Array(const std::vector<std::vector<T>>& rows) {
  core::Hdf5Array<T> array{{rows.size(), rows.front().size()}, {}};
  for (const std::vector<T>& row : rows) {
    array.values.insert(array.values.end(), row.begin(), row.end());
  }
  return array;
}

template <typename T>
void Append(const Eigen::Isometry3d& pose, std::vector<T>* row) {
  const Eigen::Quaterniond turn(pose.linear());
  for (int i = 0; i < 3; ++i) row->push_back(static_cast<T>(pose.translation()[i]));
  for (const double number : {turn.x(), turn.y(), turn.z(), turn.w()}) {
    row->push_back(static_cast<T>(number));
  }
}

template <typename T>
void Append(const Eigen::VectorXd& numbers, std::vector<T>* row) {
  for (const double number : numbers) row->push_back(static_cast<T>(number));
}

// The observations at one moment, by key; `policy` and `object` have the greatest length of all
// subtasks.
using Observation = std::map<std::string, std::vector<float>>;

// Computes the observations of the rollouts of one run.
class ObservationWriter {
 public:
  ObservationWriter(const std::vector<RunSkill>& skills,
                    const std::vector<ChainRecording>& recordings)
      : skills_(skills) {
    for (const ChainRecording& recording : recordings) {
      for (size_t k = 0; k < recording.subtasks.size(); ++k) {
        const RecordedSubtask& subtask = recording.subtasks[k];
        policy_ = std::max(policy_, subtask.decisions.front().observation.size());
        object_ = std::max(object_, Object(VariantOf(k, subtask), subtask.moments.front()).size());
      }
    }
  }

  Observation At(size_t k, const RecordedSubtask& subtask, size_t moment,
                 const std::vector<float>& observation) const {
    const skills::SkillVariant& variant = VariantOf(k, subtask);
    const RecordedMoment& now = subtask.moments[moment];
    Observation observed;
    Append(now.arm, &observed["robot0_joint_pos"]);
    std::vector<float> tool;
    Append(variant.subtask.start.world_from_robot.inverse() * now.state.gripper, &tool);
    observed["robot0_eef_pos"].assign(tool.begin(), tool.begin() + 3);
    observed["robot0_eef_quat"].assign(tool.begin() + 3, tool.end());
    observed["robot0_gripper_qpos"] = {static_cast<float>(now.leader),
                                       static_cast<float>(now.leader_command)};
    observed["object"] = Object(variant, now);
    observed["object"].resize(object_, 0.0f);
    observed["subtask"].assign(skills_.size(), 0.0f);
    observed["subtask"][k] = 1.0f;
    observed["policy"] = observation;
    observed["policy"].resize(policy_, 0.0f);
    return observed;
  }

  // Returns the state from which the simulation is restored: subtask, arm, fingers, objects and
  // their joints.
  std::vector<double> State(size_t k, const RecordedSubtask& subtask, size_t moment) const {
    const skills::SkillVariant& variant = VariantOf(k, subtask);
    const RecordedMoment& now = subtask.moments[moment];
    std::vector<double> state{static_cast<double>(k)};
    Append(now.arm, &state);
    Append(now.arm_command, &state);
    state.insert(state.end(), {now.leader, now.leader_command});
    for (const int placed_object : variant.placed) {
      const auto t = static_cast<size_t>(placed_object);
      Append(now.state.roots[t], &state);
      state.insert(state.end(), now.state.joints[t].begin(), now.state.joints[t].end());
    }
    return state;
  }

 private:
  const skills::SkillVariant& VariantOf(size_t k, const RecordedSubtask& subtask) const {
    return skills_[k].evaluated->variants[static_cast<size_t>(subtask.start.variant)];
  }
  // Returns each object's pose in the robot's frame, then its joint positions.
  static std::vector<float> Object(const skills::SkillVariant& variant, const RecordedMoment& now) {
    const Eigen::Isometry3d base_from_world = variant.subtask.start.world_from_robot.inverse();
    std::vector<float> object;
    for (const int placed_object : variant.placed) {
      const auto t = static_cast<size_t>(placed_object);
      Append(Eigen::Isometry3d(base_from_world * now.state.roots[t]), &object);
      for (const double joint : now.state.joints[t]) object.push_back(static_cast<float>(joint));
    }
    return object;
  }

  const std::vector<RunSkill>& skills_;
  size_t policy_ = 0, object_ = 0;
};

robot::StepObservations Stacked(const std::vector<Observation>& observations) {
  robot::StepObservations stacked;
  for (const auto& [key, first] : observations.front()) {
    std::vector<std::vector<float>> rows;
    for (const Observation& observed : observations) rows.push_back(observed.at(key));
    stacked.numbers[key] = Array(rows);
  }
  return stacked;
}

robot::Demonstration DemonstrationOf(const ObservationWriter& writer,
                                     const ChainRecording& recording,
                                     const std::vector<RunSkill>& skills) {
  robot::Demonstration demonstration;
  std::vector<std::vector<double>> actions, states;
  std::vector<Observation> seen, seen_next;
  for (size_t k = 0; k < recording.subtasks.size(); ++k) {
    const RecordedSubtask& subtask = recording.subtasks[k];
    const auto stride = static_cast<size_t>(skills[k].evaluated->options.control_steps);
    for (size_t d = 0; d < subtask.decisions.size(); ++d) {
      const RecordedDecision& decision = subtask.decisions[d];
      actions.emplace_back(decision.action.begin(), decision.action.end());
      states.push_back(writer.State(k, subtask, d * stride));
      demonstration.rewards.push_back(decision.reward);
      demonstration.dones.push_back(0);
      seen.push_back(writer.At(k, subtask, d * stride, decision.observation));
      seen_next.push_back(writer.At(k, subtask, (d + 1) * stride, decision.next_observation));
    }
  }
  demonstration.dones.back() = 1;
  demonstration.actions = Array(actions);
  demonstration.states = Array(states);
  demonstration.observations = Stacked(seen);
  demonstration.next_observations = Stacked(seen_next);
  return demonstration;
}

core::Json PlanJson(const SkillMetadata& metadata, const ChainRecording& recording) {
  core::Json plan = {{"episode", metadata.episode}, {"task", metadata.task}};
  for (const RecordedSubtask& subtask : recording.subtasks) {
    plan["starts"].push_back(skills::StartText(subtask.start));
    plan["steps"].push_back(subtask.decisions.size());
  }
  return plan;
}

DemonstrationPlan PlanFrom(const core::JsonField& field, const SkillMetadata& metadata) {
  DemonstrationPlan plan;
  plan.metadata = metadata;
  plan.metadata.episode = field["episode"].Unsigned();
  plan.metadata.task = field["task"].Text();
  plan.starts = field["starts"].Texts();
  plan.steps = field["steps"].Ints();
  return plan;
}

// Assigns every n-th demonstration to "valid", the others to "train".
void SplitEpisodes(robot::DemonstrationSet* set) {
  const size_t count = set->demonstrations.size();
  for (size_t valid = std::max(count / kValidEvery, std::min<size_t>(1, count - 1));; ++valid) {
    set->filters.clear();
    for (size_t i = 0, k = 0; i < count; ++i) {
      const bool chosen = k < valid && i + 1 == (k + 1) * count / valid;
      set->filters[chosen ? "valid" : "train"].push_back(i);
      k += chosen;
    }
    if (ValidSteps(*set) >= kRobomimicBatch || 2 * (valid + 1) > count) return;
  }
}

// Returns the start of the next subtask: the state that the replay has reached, with the file's
// plan.
skills::StartState Continued(const skills::StartState& end, const skills::StartState& planned) {
  skills::StartState start = end;
  start.pitch = planned.pitch;
  start.grasp = planned.grasp;
  start.retreat = planned.retreat;
  start.grasp_configuration = planned.grasp_configuration;
  start.waypoints = planned.waypoints;
  start.state.goal = planned.state.goal;
  return start;
}

}  // namespace

robot::DemonstrationSet DemonstrationsOf(const SkillRun& run, const std::vector<RunSkill>& skills,
                                         const std::vector<ChainRecording>& recordings,
                                         std::uint64_t seed) {
  const ObservationWriter writer(skills, recordings);
  robot::DemonstrationSet set;
  const SkillMetadata metadata = MetadataOf(run, skills, recordings.front(), seed);
  core::Json kwargs = {{"robot", metadata.robot},
                       {"run", metadata.run},
                       {"assets", metadata.assets},
                       {"seed", seed},
                       {"subtasks", metadata.subtasks},
                       {"decision_seconds", skills.front().evaluated->options.decision_seconds()}};
  int horizon = 0;
  for (const RunSkill& skill : skills) horizon += skill.evaluated->options.decisions();
  kwargs["horizon"] = horizon;
  for (const ChainRecording& recording : recordings) {
    set.metadata.push_back(
        core::JsonLine(PlanJson(MetadataOf(run, skills, recording, seed), recording)));
    set.demonstrations.push_back(DemonstrationOf(writer, recording, skills));
  }
  SplitEpisodes(&set);
  set.env_name = "simwright/" + metadata.task;
  set.env_version = kVersion;
  set.env_kwargs = core::JsonLine(kwargs);
  return set;
}

size_t ValidSteps(const robot::DemonstrationSet& set) {
  size_t steps = 0;
  const auto valid = set.filters.find("valid");
  if (valid == set.filters.end()) return 0;
  for (const size_t i : valid->second) steps += set.demonstrations[i].size();
  return steps;
}

std::vector<DemonstrationPlan> PlansOf(const robot::DemonstrationSet& set,
                                       const std::string& where) {
  const core::JsonDocument kwargs(set.env_kwargs, where, kDemonstrationRemedy);
  const core::JsonField root = kwargs.root();
  SkillMetadata metadata;
  metadata.robot = root["robot"].Text();
  metadata.run = root["run"].Text();
  metadata.assets = root["assets"].Texts();
  metadata.seed = root["seed"].Unsigned();
  metadata.subtasks = root["subtasks"].Texts();
  std::vector<DemonstrationPlan> plans;
  if (root.Has("episodes")) {
    for (const core::JsonField& one : root["episodes"].Elements()) {
      plans.push_back(PlanFrom(one, metadata));
    }
  }
  for (const std::string& note : set.metadata) {
    const core::JsonDocument plan(note, where, kDemonstrationRemedy);
    plans.push_back(PlanFrom(plan.root(), metadata));
  }
  if (plans.size() != set.demonstrations.size()) {
    throw core::Error("its metadata describes " + std::to_string(plans.size()) +
                          " episodes, there are " + std::to_string(set.demonstrations.size()),
                      where, kDemonstrationRemedy);
  }
  return plans;
}

std::vector<bool> ReplayDemonstration(const std::vector<RunSkill>& skills,
                                      const robot::Demonstration& demonstration,
                                      const DemonstrationPlan& plan, const std::string& where) {
  const auto width = static_cast<size_t>(skills::ActionSize(*skills.front().evaluated));
  size_t steps = 0;
  for (const int count : plan.steps) steps += static_cast<size_t>(std::max(count, 0));
  if (plan.starts.size() != skills.size() || plan.steps.size() != skills.size() ||
      steps != demonstration.size() || demonstration.actions.shape.at(1) != width) {
    throw core::Error("its actions do not match the run's subtasks", where, kDemonstrationRemedy);
  }
  std::vector<bool> successes;
  const double* row = demonstration.actions.values.data();
  skills::StartState start;
  for (size_t k = 0; k < skills.size(); ++k) {
    const skills::Skill& skill = *skills[k].evaluated;
    const skills::StartState planned = skills::ParseStart(plan.starts[k], skill, where);
    skills::Episode episode(skill);
    episode.Begin(k == 0 ? planned : Continued(start, planned));
    skills::Decision decision;
    std::vector<float> action(width);
    for (int i = 0; i < plan.steps[k]; ++i, row += width) {
      std::copy(row, row + width, action.begin());
      if (!decision.terminated && !decision.failed) decision = episode.Step(action.data());
    }
    successes.push_back(decision.terminated);
    if (!decision.terminated) break;
    start = skills::EndOf(episode);
  }
  return successes;
}

}  // namespace simwright::workflows
