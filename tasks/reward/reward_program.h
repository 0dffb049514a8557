#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "tasks/reward/environment_api.h"
#include "tasks/reward/reward_options.h"
#include "tasks/reward/reward_scene.h"
#include "tasks/reward/reward_slot.h"

// Reward programs: a restricted Python over batches of environments, read, checked and compiled
// here; Python never runs. docs/rewards.md describes the language.
namespace simwright::tasks {

namespace reward {
struct Code;
}

// Where a slot's numbers lie: number k of environment i at data[i * environment_stride +
// k * lane_stride]. The default strides stand for rows, [num_envs, width]; {data, 1, num_envs} for
// columns, which are read in place; an environment_stride of 0 for one row that all share.
struct RewardBinding {
  const float* data = nullptr;
  std::ptrdiff_t environment_stride = -1;  // -1: the slot's width, or 0 where it is uniform
  std::ptrdiff_t lane_stride = 1;
};

struct RewardComponent {
  std::string name;
  int width = 1;  // numbers an environment
};

class RewardWorkspace;

// A compiled program. Copies share what is compiled; it never changes, so that any number of
// threads may run it, each with a workspace of its own.
class RewardProgram {
 public:
  explicit RewardProgram(std::shared_ptr<const reward::Code> code) : code_(std::move(code)) {}

  // What the program reads, in the order in which bindings are given.
  const std::vector<RewardSlot>& slots() const;
  bool has_success() const;
  // The dictionary that the function returns beside the reward, in its order.
  std::vector<RewardComponent> components() const;
  // The function that was compiled, e.g. "compute_reward".
  const std::string& entry() const;
  // Instructions an environment; what decides the speed.
  int operations() const;

  // Computes reward [num_envs]; success [num_envs], 0 or 1, unless null; and the components, each
  // [num_envs, width] or null. Allocates nothing. Throws core::Error where the bindings do not
  // match the slots, num_envs is not in [1, workspace.max_envs()], the workspace is another
  // program's, or the program reads a single environment that is not there.
  void Run(std::span<const RewardBinding> bindings, int num_envs, RewardWorkspace* workspace,
           float* reward, std::uint8_t* success, std::span<float* const> components = {}) const;

 private:
  friend class RewardWorkspace;
  std::shared_ptr<const reward::Code> code_;
};

// The memory that one thread runs a program with.
class RewardWorkspace {
 public:
  // For up to `max_envs` environments. Throws core::Error unless 1 <= max_envs <= 2^24.
  RewardWorkspace(const RewardProgram& program, int max_envs);

  RewardWorkspace(const RewardWorkspace&) = delete;  // it points into its own memory
  RewardWorkspace& operator=(const RewardWorkspace&) = delete;
  RewardWorkspace(RewardWorkspace&&) = default;
  RewardWorkspace& operator=(RewardWorkspace&&) = default;

  int max_envs() const { return max_envs_; }

 private:
  friend class RewardProgram;
  std::shared_ptr<const reward::Code> code_;
  int max_envs_ = 0;
  std::vector<float> memory_;
  float* registers_ = nullptr;
  float* numbers_ = nullptr;
  float* spills_ = nullptr;
  std::vector<const float*> columns_;
  std::vector<double> gathered_;
};

struct CompileOutcome {
  core::Findings findings;               // place: "line:column"
  std::optional<RewardProgram> program;  // none where a finding is an error
};

// Reads, checks and compiles the reward function of `source`. With a scene, assets, links and
// joints have to exist there and joint limits become constants; without one (null) any name goes
// and limits are slots. Never throws on any source; throws core::Error where `options` is invalid.
CompileOutcome CompileReward(std::string_view source, const RewardScene* scene,
                             const RewardOptions& options = {});

// The finding as a person reads it: "line:column: error: sentence", the line of the source, and a
// caret below the place. `source` is what was compiled.
std::string RenderFinding(const core::Finding& finding, std::string_view source);

}  // namespace simwright::tasks
