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
#include "reward/environment_api.h"
#include "reward/reward_options.h"
#include "reward/reward_scene.h"
#include "reward/reward_slot.h"

// Reward programs: a restricted Python over batches of environments, parsed, checked and compiled
// here; Python never runs. docs/rewards.md describes the language.
namespace simwright::reward {

struct Code;

// The memory layout of a slot's numbers: number k of environment i is at data[i *
// environment_stride + k * lane_stride]. The default strides describe rows, [num_envs, width].
// {data, 1, num_envs} describes columns, which are read in place. An environment_stride of 0
// describes one row that all environments share.
struct RewardBinding {
  const float* data = nullptr;
  std::ptrdiff_t environment_stride = -1;  // -1: the slot's width, or 0 if it is uniform
  std::ptrdiff_t lane_stride = 1;
};

struct RewardComponent {
  std::string name;
  int width = 1;  // numbers per environment
};

class RewardWorkspace;

// A compiled program. Copies share the compiled code, which is immutable, so any number of threads
// may run it, each with its own workspace.
class RewardProgram {
 public:
  explicit RewardProgram(std::shared_ptr<const Code> code) : code_(std::move(code)) {}

  // Returns the inputs of the program, in the order of the bindings.
  const std::vector<RewardSlot>& slots() const;
  bool has_success() const;
  // Returns the entries of the dictionary that the function returns beside the reward, in its
  // order.
  std::vector<RewardComponent> components() const;
  // Returns the name of the compiled function, e.g. "compute_reward".
  const std::string& entry() const;
  // Returns the number of instructions per environment, which determines the speed.
  int operations() const;

  // Computes the reward [num_envs]; success [num_envs], 0 or 1, unless null; and the components,
  // each [num_envs, width] or null. Allocates nothing. Throws core::Error if the bindings do not
  // match the slots, num_envs is not in [1, workspace.max_envs()], the workspace belongs to another
  // program, or the program reads a single environment that does not exist.
  void Run(std::span<const RewardBinding> bindings, int num_envs, RewardWorkspace* workspace,
           float* reward, std::uint8_t* success, std::span<float* const> components = {}) const;

 private:
  friend class RewardWorkspace;
  std::shared_ptr<const Code> code_;
};

// The memory with which one thread runs a program.
class RewardWorkspace {
 public:
  // Allocates memory for up to `max_envs` environments. Throws core::Error unless 1 <= max_envs <=
  // 2^24.
  RewardWorkspace(const RewardProgram& program, int max_envs);

  RewardWorkspace(const RewardWorkspace&) = delete;  // it points into its own memory
  RewardWorkspace& operator=(const RewardWorkspace&) = delete;
  RewardWorkspace(RewardWorkspace&&) = default;
  RewardWorkspace& operator=(RewardWorkspace&&) = default;

  int max_envs() const { return max_envs_; }

 private:
  friend class RewardProgram;
  std::shared_ptr<const Code> code_;
  int max_envs_ = 0;
  std::vector<float> memory_;
  float* registers_ = nullptr;
  float* numbers_ = nullptr;
  float* spills_ = nullptr;
  std::vector<const float*> columns_;
  std::vector<double> accumulators_;
};

struct CompileOutcome {
  core::Findings findings;               // place: "line:column"
  std::optional<RewardProgram> program;  // empty if a finding is an error
};

// Parses, checks and compiles the reward function of `source`. With a scene, assets, links and
// joints must exist in it and joint limits become constants; without one (null) any name is
// accepted and limits are slots. Never throws because of the source; throws core::Error if
// `options` is invalid.
CompileOutcome CompileReward(std::string_view source, const RewardScene* scene,
                             const RewardOptions& options = {});

// Returns the finding as text for a person: "line:column: error: sentence", the source line, and a
// caret below the position. `source` is the compiled source.
std::string RenderFinding(const core::Finding& finding, std::string_view source);

}  // namespace simwright::reward
