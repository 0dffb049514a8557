#include "rl/ppo.h"

#include "core/error.h"
#include "nn/compute.h"
#include "rl/ppo_learner.h"

namespace simwright::rl {
namespace {

const PpoOptions& CheckedOptions(const PpoOptions& options, const VectorEnvironment& environment) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "training options");
  if (environment.size() < 1 || environment.observation_size() < 1 ||
      environment.action_size() < 1) {
    throw core::Error("is empty: it needs an environment, an observation and an action",
                      "training environment");
  }
  nn::PrepareForWork();
  return options;
}

}  // namespace

struct Ppo::Learner : PpoLearner {
  using PpoLearner::PpoLearner;
};

Ppo::Ppo(VectorEnvironment* environment, const PpoOptions& options, Communicator* ranks)
    : options_(CheckedOptions(options, *environment)),
      ranks_(ranks),
      collector_(environment, options, ranks),
      learner_(std::make_unique<Learner>(
          ActorCriticSizes{environment->observation_size(), environment->action_size(),
                           options.hidden, options.activation},
          options, ranks)) {}

Ppo::~Ppo() = default;

void Ppo::Collect(std::vector<Outcome>* outcomes) {
  const ActorCritic& networks = learner_->networks();
  collector_.Collect(networks.Actor(), networks.Std(), &rollout_, outcomes);
}

UpdateReport Ppo::Update() {
  const bool critic_alone = collector_.samples() <= options_.critic_samples;
  return learner_->Update(rollout_, critic_alone);
}

Policy Ppo::CurrentPolicy() const {
  const ActorCritic& networks = learner_->networks();
  const ObservationScale scale = options_.normalize_observations
                                     ? collector_.normalizer().scale()
                                     : ObservationScale(networks.sizes().observations);
  return Policy(scale, networks.Actor(), networks.Std());
}

LearnerState Ppo::LearnerPart() const {
  return learner_->SaveState();
}

void Ppo::Restore(const CollectorState& collector, const LearnerState& learner) {
  learner_->RestoreState(learner);
  collector_.RestoreState(collector);
}

}  // namespace simwright::rl
