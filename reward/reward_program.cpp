#include "reward/reward_program.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "reward/ir/code.h"

namespace simwright::reward {
namespace {

constexpr int kMostEnvironments = 1 << 24;
constexpr std::size_t kAlignment = 16;  // floats; one cache line

std::ptrdiff_t EnvironmentStride(const RewardBinding& binding, const RewardSlot& slot) {
  if (binding.environment_stride >= 0) return binding.environment_stride;
  return slot.uniform ? 0 : slot.width;
}

// The data of one run; lives on the stack.
struct Pass {
  const Code& code;
  std::span<const RewardBinding> bindings;
  int num_envs;
  float* registers;
  float* numbers;
  float* register_spills;
  int max_envs;
  const float** columns;  // columns of the registers; numbers lie below, at -1 - k
  double* gathered;

  float* Register(Column column) const {
    return registers + static_cast<std::ptrdiff_t>(column) * code.chunk;
  }
  const float* Row(int slot, int environment, int lane) const {
    const RewardBinding& binding = bindings[slot];
    return binding.data +
           static_cast<std::ptrdiff_t>(environment) * EnvironmentStride(binding, code.slots[slot]) +
           lane * binding.lane_stride;
  }

  void Numbers(const Stage& stage) const;
  void LoadChunk(const Stage& stage, int start, int count) const;
  void LoadOne(const Load& load, int start, int count) const;
  void ReturnColumns(const Stage& stage) const;
  void StartReductions(const Stage& stage) const;
  void Gather(const Stage& stage, int start, int count) const;
  void FinishReductions(const Stage& stage) const;
};

void Pass::Numbers(const Stage& stage) const {
  for (const Load& load : stage.uniform_loads) {
    numbers[-1 - load.column] = *Row(load.slot, 0, load.lane);
  }
  for (const Instruction& step : stage.uniform) {
    step.kernel(numbers + (-1 - step.result), columns[step.a], columns[step.b], columns[step.c], 1);
  }
}

void Pass::LoadOne(const Load& load, int start, int count) const {
  const std::ptrdiff_t stride = EnvironmentStride(bindings[load.slot], code.slots[load.slot]);
  const float* from = Row(load.slot, start, load.lane);
  if (stride == 1) {
    columns[load.column] = from;
    return;
  }
  float* to = Register(load.column);
  columns[load.column] = to;
  for (int i = 0; i < count; ++i) to[i] = from[i * stride];
}

void Pass::LoadChunk(const Stage& stage, int start, int count) const {
  for (const Load& load : stage.loads) LoadOne(load, start, count);
  for (const TripleLoad& triple : stage.triples) {
    const RewardBinding& binding = bindings[triple.slot];
    const bool rows =
        binding.lane_stride == 1 && EnvironmentStride(binding, code.slots[triple.slot]) == 3;
    if (!rows) {
      for (int k = 0; k < 3; ++k) LoadOne({triple.slot, k, triple.columns[k]}, start, count);
      continue;
    }
    float* to[3];
    for (int k = 0; k < 3; ++k) columns[triple.columns[k]] = to[k] = Register(triple.columns[k]);
    Kernels().split_triples(Row(triple.slot, start, 0), to, count);
  }
  for (const Load& axis_flip : stage.axis_flips) {
    const float* from = register_spills + static_cast<std::ptrdiff_t>(axis_flip.slot) * max_envs;
    float* to = Register(axis_flip.column);
    for (int i = 0; i < count; ++i) to[i] = from[num_envs - 1 - (start + i)];
  }
}

// Restores the registers that the caller's own columns replaced.
void Pass::ReturnColumns(const Stage& stage) const {
  for (const Load& load : stage.loads) columns[load.column] = Register(load.column);
  for (const TripleLoad& triple : stage.triples) {
    for (const Column column : triple.columns) columns[column] = Register(column);
  }
}

void Pass::StartReductions(const Stage& stage) const {
  for (std::size_t i = 0; i < stage.reductions.size(); ++i) {
    const BatchReduction& one = stage.reductions[i];
    const double infinity = std::numeric_limits<double>::infinity();
    gathered[i] = one.operation == ScalarOperation::kBatchMinimum   ? infinity
                  : one.operation == ScalarOperation::kBatchMaximum ? -infinity
                                                                    : 0.0;
    if (one.operation != ScalarOperation::kBatchPick) continue;
    if (one.environment >= num_envs || one.environment < -num_envs) {
      throw core::Error("it reads environment " + std::to_string(one.environment) + " of " +
                            std::to_string(num_envs),
                        "reward program " + code.entry, "run it with more environments");
    }
  }
}

void Pass::Gather(const Stage& stage, int start, int count) const {
  for (std::size_t i = 0; i < stage.reductions.size(); ++i) {
    const BatchReduction& one = stage.reductions[i];
    const float* from = columns[one.operand];
    double& total = gathered[i];
    switch (one.operation) {
      case ScalarOperation::kBatchSum:
        total += Kernels().sum(from, count);
        break;
      case ScalarOperation::kBatchFlip:
        std::copy_n(from, count,
                    register_spills + static_cast<std::ptrdiff_t>(one.result) * max_envs + start);
        break;
      case ScalarOperation::kBatchPick: {
        const int wanted = one.environment < 0 ? one.environment + num_envs : one.environment;
        if (wanted >= start && wanted < start + count) total = from[wanted - start];
        break;
      }
      case ScalarOperation::kBatchMinimum:
        for (int k = 0; k < count; ++k) {
          if (from[k] < total || std::isnan(from[k])) total = from[k];
        }
        break;
      default:  // kBatchMaximum
        for (int k = 0; k < count; ++k) {
          if (from[k] > total || std::isnan(from[k])) total = from[k];
        }
    }
  }
}

void Pass::FinishReductions(const Stage& stage) const {
  for (std::size_t i = 0; i < stage.reductions.size(); ++i) {
    const BatchReduction& one = stage.reductions[i];
    if (one.operation == ScalarOperation::kBatchFlip) continue;
    numbers[-1 - one.result] = static_cast<float>(gathered[i]);
  }
}

void StoreComponents(const Pass& pass, std::span<float* const> components, int start, int count) {
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (components[i] == nullptr) continue;
    const std::vector<Column>& columns = pass.code.components[i].columns;
    const std::size_t width = columns.size();
    for (std::size_t k = 0; k < width; ++k) {
      float* to = components[i] + static_cast<std::size_t>(start) * width + k;
      const float* from = pass.columns[columns[k]];
      const bool shared = columns[k] < 0;
      for (int e = 0; e < count; ++e)
        to[static_cast<std::size_t>(e) * width] = from[shared ? 0 : e];
    }
  }
}

void Store(const Pass& pass, int start, int count, float* reward, std::uint8_t* success) {
  const float* from = pass.columns[pass.code.reward];
  if (pass.code.reward < 0) {
    std::fill_n(reward + start, count, *from);
  } else {
    std::copy_n(from, count, reward + start);
  }
  if (success == nullptr) return;
  if (pass.code.success < 0) {
    std::fill_n(success + start, count, *pass.columns[pass.code.success] != 0.0f ? 1 : 0);
  } else {
    Kernels().store_flags(success + start, pass.columns[pass.code.success], count);
  }
}

void Check(const Code& code, std::span<const RewardBinding> bindings, int num_envs,
           const std::shared_ptr<const Code>& workspace_code, int max_envs,
           std::span<float* const> components) {
  const std::string where = "reward program " + code.entry;
  if (workspace_code.get() != &code) {
    throw core::Error("the workspace was made for another program", where);
  }
  if (num_envs < 1 || num_envs > max_envs) {
    throw core::Error("it cannot run for " + std::to_string(num_envs) + " environments", where,
                      "the workspace holds 1 to " + std::to_string(max_envs));
  }
  if (bindings.size() != code.slots.size() ||
      (!components.empty() && components.size() != code.components.size())) {
    throw core::Error(std::to_string(bindings.size()) + " inputs and " +
                          std::to_string(components.size()) + " component outputs are given",
                      where,
                      "give " + std::to_string(code.slots.size()) + " inputs, and " +
                          std::to_string(code.components.size()) + " outputs or none");
  }
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    if (bindings[i].data == nullptr) {
      throw core::Error("input " + std::to_string(i) + ", " +
                            std::string(RewardInputName(code.slots[i].input)) + ", has no data",
                        where);
    }
  }
}

}  // namespace

const std::vector<RewardSlot>& RewardProgram::slots() const {
  return code_->slots;
}
bool RewardProgram::has_success() const {
  return code_->has_success;
}
const std::string& RewardProgram::entry() const {
  return code_->entry;
}
int RewardProgram::operations() const {
  return code_->operations;
}

std::vector<RewardComponent> RewardProgram::components() const {
  std::vector<RewardComponent> components;
  for (const ComponentCode& component : code_->components) {
    components.push_back({component.name, static_cast<int>(component.columns.size())});
  }
  return components;
}

void RewardProgram::Run(std::span<const RewardBinding> bindings, int num_envs,
                        RewardWorkspace* workspace, float* reward, std::uint8_t* success,
                        std::span<float* const> components) const {
  const Code& code = *code_;
  Check(code, bindings, num_envs, workspace->code_, workspace->max_envs_, components);
  if (!code.has_success) success = nullptr;
  const Pass pass{code,
                  bindings,
                  num_envs,
                  workspace->registers_,
                  workspace->numbers_,
                  workspace->spills_,
                  workspace->max_envs_,
                  workspace->columns_.data() + code.numbers,
                  workspace->accumulators_.data()};
  if (code.batch_size < 0) {
    // The number of environments is a number like any other and is set in each run.
    pass.numbers[-1 - code.batch_size] = static_cast<float>(num_envs);
  }
  for (std::size_t s = 0; s < code.stages.size(); ++s) {
    const Stage& stage = code.stages[s];
    const bool last = s + 1 == code.stages.size();
    pass.Numbers(stage);
    pass.StartReductions(stage);
    for (int start = 0; start < num_envs; start += code.chunk) {
      const int count = std::min(code.chunk, num_envs - start);
      pass.LoadChunk(stage, start, count);
      for (const Instruction& step : stage.body) {
        step.kernel(pass.Register(step.result), pass.columns[step.a], pass.columns[step.b],
                    pass.columns[step.c], count);
      }
      pass.Gather(stage, start, count);
      if (!last) continue;
      Store(pass, start, count, reward, success);
      StoreComponents(pass, components, start, count);
    }
    pass.FinishReductions(stage);
    pass.ReturnColumns(stage);
  }
}

RewardWorkspace::RewardWorkspace(const RewardProgram& program, int max_envs)
    : code_(program.code_), max_envs_(max_envs) {
  if (max_envs < 1 || max_envs > kMostEnvironments) {
    throw core::Error("a reward runs for 1 to " + std::to_string(kMostEnvironments) +
                          " environments, not " + std::to_string(max_envs),
                      "reward program " + code_->entry);
  }
  const auto registers = static_cast<std::size_t>(code_->registers) * code_->chunk;
  const auto numbers = static_cast<std::size_t>(code_->numbers);
  const std::size_t register_spills = static_cast<std::size_t>(code_->register_spills) * max_envs;
  memory_.assign(registers + numbers + register_spills + kAlignment, 0.0f);
  const auto address = reinterpret_cast<std::uintptr_t>(memory_.data()) / sizeof(float);
  registers_ = memory_.data() + (kAlignment - address % kAlignment) % kAlignment;
  numbers_ = registers_ + registers;
  spills_ = numbers_ + numbers;
  std::copy(code_->constants.begin(), code_->constants.end(), numbers_);
  columns_.resize(numbers + static_cast<std::size_t>(code_->registers));
  for (std::size_t k = 0; k < numbers; ++k) columns_[numbers - 1 - k] = numbers_ + k;
  for (int r = 0; r < code_->registers; ++r) {
    columns_[numbers + r] = registers_ + static_cast<std::ptrdiff_t>(r) * code_->chunk;
  }
  std::size_t reductions = 0;
  for (const Stage& stage : code_->stages) {
    reductions = std::max(reductions, stage.reductions.size());
  }
  accumulators_.resize(reductions);
}

}  // namespace simwright::reward
