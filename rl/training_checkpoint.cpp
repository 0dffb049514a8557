#include "rl/training_checkpoint.h"

#include <span>
#include <sstream>

#include "core/error.h"
#include "core/log.h"
#include "nn/tensor_bytes.h"
#include "nn/tensor_file.h"
#include "rl/metadata_tensor.h"
#include "rl/ppo_learner.h"

namespace simwright::rl {
namespace {

constexpr char kCheckpointKind[] = "simwright training";
constexpr char kVersion[] = "2";

torch::Tensor PackDoubles(std::span<const double> numbers) {
  torch::Tensor tensor = torch::empty({static_cast<std::int64_t>(numbers.size())},
                                      torch::TensorOptions(torch::kDouble));
  std::copy(numbers.begin(), numbers.end(), tensor.data_ptr<double>());
  return tensor;
}

std::vector<double> Doubles(const nn::NamedTensors& tensors, const std::string& name) {
  const torch::Tensor tensor = TakeTensor(tensors, name, torch::kDouble, 1);
  const double* first = tensor.data_ptr<double>();
  return {first, first + tensor.numel()};
}

// Returns `count` doubles; throws core::Error for another number.
std::vector<double> Doubles(const nn::NamedTensors& tensors, const std::string& name,
                            std::size_t count) {
  std::vector<double> numbers = Doubles(tensors, name);
  if (numbers.size() != count) throw core::Error("has a '" + name + "' of another length");
  return numbers;
}

std::string Bytes(const nn::NamedTensors& tensors, const std::string& name) {
  return UnpackBytes(TakeTensor(tensors, name, torch::kUInt8, 1));
}

void PackMoments(const RunningMoments& moments, const std::string& name,
                 nn::NamedTensors* tensors) {
  (*tensors)[name + ".count"] = PackDoubles({&moments.count, 1});
  (*tensors)[name + ".mean"] =
      PackDoubles({moments.mean.data(), moments.mean.data() + moments.mean.size()});
  (*tensors)[name + ".squares"] =
      PackDoubles({moments.squares.data(), moments.squares.data() + moments.squares.size()});
}

RunningMoments Moments(const nn::NamedTensors& tensors, const std::string& name) {
  const std::vector<double> mean = Doubles(tensors, name + ".mean");
  const std::vector<double> squares = Doubles(tensors, name + ".squares", mean.size());
  RunningMoments moments(static_cast<int>(mean.size()));
  moments.count = Doubles(tensors, name + ".count", 1)[0];
  std::copy(mean.begin(), mean.end(), moments.mean.begin());
  std::copy(squares.begin(), squares.end(), moments.squares.begin());
  return moments;
}

// Packs what differs between ranks: episodes, generators and demonstrations.
void PackOwn(const CollectorState& state, const LearnerState& learner, nn::NamedTensors* tensors) {
  (*tensors)["discounted_returns"] = PackDoubles(state.discounted_returns);
  (*tensors)["episode_rewards"] = PackDoubles(state.episode_rewards);
  (*tensors)["episode_steps"] = PackDoubles(state.episode_steps);
  (*tensors)["collector_generator"] = PackBytes(state.generator);
  (*tensors)["environment"] = PackBytes(state.environment);
  (*tensors)["learner_generator"] = PackBytes(learner.generator);
  if (!learner.shown.observations.defined()) return;
  (*tensors)["shown.observations"] = learner.shown.observations;
  (*tensors)["shown.actions"] = learner.shown.actions;
}

// Packs what is equal on all ranks.
void PackShared(const CollectorState& state, const LearnerState& learner,
                nn::NamedTensors* tensors) {
  PackMoments(state.observations, "observations", tensors);
  PackMoments(state.returns, "returns", tensors);
  // Doubles count exactly up to 9e15.
  const double counts[] = {static_cast<double>(state.samples), static_cast<double>(state.dropped)};
  (*tensors)["samples"] = PackDoubles(counts);
  (*tensors)["parameters"] = learner.parameters;
  (*tensors)["adam.means"] = learner.gradient_means;
  (*tensors)["adam.squares"] = learner.gradient_squares;
  const double numbers[] = {static_cast<double>(learner.gradient_steps), learner.learning_rate};
  (*tensors)["adam.steps_and_rate"] = PackDoubles(numbers);
}

std::string RankName(int rank) {
  return "rank." + std::to_string(rank);
}

// Returns the number of ranks that wrote a checkpoint.
int RanksOf(const nn::NamedTensors& tensors) {
  int ranks = 1;
  while (tensors.contains(RankName(ranks))) ++ranks;
  return ranks;
}

CollectorState Collector(const nn::NamedTensors& tensors, const nn::NamedTensors& own) {
  const std::vector<double> counts = Doubles(tensors, "samples", 2);
  return {Moments(tensors, "observations"),
          Moments(tensors, "returns"),
          Doubles(own, "discounted_returns"),
          Doubles(own, "episode_rewards"),
          Doubles(own, "episode_steps"),
          static_cast<std::int64_t>(counts[0]),
          static_cast<std::int64_t>(counts[1]),
          Bytes(own, "collector_generator"),
          Bytes(own, "environment")};
}

Demonstrations Shown(const nn::NamedTensors& tensors) {
  if (!tensors.contains("shown.observations")) return {};
  return {TakeTensor(tensors, "shown.observations", torch::kFloat, 2),
          TakeTensor(tensors, "shown.actions", torch::kFloat, 2)};
}

LearnerState Learner(const nn::NamedTensors& tensors, const nn::NamedTensors& own) {
  const std::vector<double> numbers = Doubles(tensors, "adam.steps_and_rate", 2);
  return {TakeTensor(tensors, "parameters", torch::kFloat, 1),
          TakeTensor(tensors, "adam.means", torch::kFloat, 1),
          TakeTensor(tensors, "adam.squares", torch::kFloat, 1),
          static_cast<std::int64_t>(numbers[0]),
          numbers[1],
          Bytes(own, "learner_generator"),
          Shown(own)};
}

void PackOutcomes(const OutcomeWindow& recent, nn::NamedTensors* tensors) {
  std::vector<double> numbers;
  for (const Outcome& outcome : recent.outcomes()) {
    numbers.insert(numbers.end(),
                   {outcome.total_reward, outcome.steps, outcome.success ? 1.0 : 0.0});
  }
  (*tensors)["outcomes"] = PackDoubles(numbers);
}

void AddOutcomes(const nn::NamedTensors& tensors, OutcomeWindow* recent) {
  const std::vector<double> numbers = Doubles(tensors, "outcomes");
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    recent->Add({numbers[i], numbers[i + 1], numbers[i + 2] != 0.0});
  }
}

// Returns the metadata that must match for a training to resume.
Metadata NetworkMetadata(const Ppo& ppo) {
  const Policy policy = ppo.CurrentPolicy();
  std::ostringstream hidden;
  for (const int size : ppo.options().hidden) hidden << (hidden.tellp() > 0 ? "-" : "") << size;
  return {{"kind", kCheckpointKind},
          {"version", kVersion},
          {"observations", std::to_string(policy.observation_size())},
          {"actions", std::to_string(policy.action_size())},
          {"hidden", hidden.str()},
          {"activation", ppo.options().activation == Activation::kTanh ? "tanh" : "elu"}};
}

void CheckMetadata(const Metadata& wanted, const Metadata& found) {
  for (const auto& [key, value] : wanted) {
    const auto other = found.find(key);
    const std::string has = other == found.end() ? "none" : "'" + other->second + "'";
    if (has == "'" + value + "'") continue;
    throw core::Error("belongs to another training: its " + key + " is " + has + ", expected '" +
                      value + "'");
  }
}

// Returns the tensors of a rank's own state: for rank 0 the file's own.
nn::NamedTensors OwnTensors(const nn::NamedTensors& tensors, int rank) {
  if (rank == 0) return tensors;
  return nn::UnpackTensors(Bytes(tensors, RankName(rank)), RankName(rank));
}

void RestoreState(const nn::NamedTensors& tensors, Ppo* ppo) {
  if (RanksOf(tensors) == ppo->ranks().size()) {
    const nn::NamedTensors own = OwnTensors(tensors, ppo->ranks().rank());
    ppo->Restore(Collector(tensors, own), Learner(tensors, own));
    return;
  }
  core::Log(core::LogLevel::kInfo, "rl", "the checkpoint of ", RanksOf(tensors),
            " ranks resumes on ", ppo->ranks().size(), ": episodes start afresh");
  const CollectorState saved = Collector(tensors, tensors);
  CollectorState collector = ppo->CollectorPart();
  collector.observations = saved.observations;
  collector.returns = saved.returns;
  collector.samples = saved.samples;
  collector.dropped = saved.dropped;
  LearnerState learner = Learner(tensors, tensors);
  learner.generator = ppo->LearnerPart().generator;
  learner.shown = {};
  ppo->Restore(collector, learner);
}

TrainingProgress Restore(const nn::NamedTensors& tensors, const Metadata& metadata, Ppo* ppo,
                         OutcomeWindow* recent) {
  const Metadata found = UnpackMetadata(TakeTensor(tensors, "facts", torch::kUInt8, 1));
  CheckMetadata(NetworkMetadata(*ppo), found);
  CheckMetadata(metadata, found);
  const std::vector<double> progress = Doubles(tensors, "progress", 5);
  RestoreState(tensors, ppo);
  AddOutcomes(tensors, recent);
  return {static_cast<std::int64_t>(progress[0]), static_cast<std::int64_t>(progress[1]),
          progress[2], progress[3], progress[4] != 0.0};
}

}  // namespace

void WriteCheckpoint(const Ppo& ppo, const TrainingProgress& progress, const OutcomeWindow& recent,
                     const Metadata& metadata, const std::filesystem::path& path) {
  const CollectorState collector = ppo.CollectorPart();
  const LearnerState learner = ppo.LearnerPart();
  nn::NamedTensors tensors;
  PackOwn(collector, learner, &tensors);
  Communicator& ranks = ppo.ranks();
  if (ranks.size() > 1) {
    const std::vector<std::string> others =
        ranks.AllGather(ranks.leads() ? std::string() : nn::PackTensors(tensors));
    if (!ranks.leads()) return;
    for (int rank = 1; rank < ranks.size(); ++rank) {
      tensors[RankName(rank)] = PackBytes(others[static_cast<std::size_t>(rank)]);
    }
  }
  PackShared(collector, learner, &tensors);
  PackOutcomes(recent, &tensors);
  const double numbers[] = {static_cast<double>(progress.iteration),
                            static_cast<double>(progress.episodes), progress.seconds, progress.best,
                            progress.learnt ? 1.0 : 0.0};
  tensors["progress"] = PackDoubles(numbers);
  Metadata all = metadata;
  all.merge(NetworkMetadata(ppo));
  tensors["facts"] = PackMetadata(all);
  nn::WriteTensors(tensors, path);
}

void BeginFromCheckpoint(const std::filesystem::path& path, Ppo* ppo) {
  const nn::NamedTensors tensors = nn::ReadTensors(path);
  try {
    CheckMetadata(NetworkMetadata(*ppo),
                  UnpackMetadata(TakeTensor(tensors, "facts", torch::kUInt8, 1)));
    const CollectorState known = Collector(tensors, tensors);
    CollectorState state = ppo->CollectorPart();
    state.observations = known.observations;
    state.returns = known.returns;
    LearnerState learner = Learner(tensors, tensors);
    if (ppo->ranks().rank() > 0) learner.generator = ppo->LearnerPart().generator;
    ppo->Restore(state, learner);
  } catch (const core::Error& error) {
    throw core::Error(error.what(), path.string(), "train from scratch");
  }
}

TrainingProgress ReadCheckpoint(const std::filesystem::path& path, const Metadata& metadata,
                                Ppo* ppo, OutcomeWindow* recent) {
  const nn::NamedTensors tensors = nn::ReadTensors(path);
  try {
    return Restore(tensors, metadata, ppo, recent);
  } catch (const core::Error& error) {
    throw core::Error(error.what(), path.string(), "train in another folder");
  }
}

}  // namespace simwright::rl
