#include "reward/ir/code_generation.h"

#include <algorithm>
#include <map>

namespace simwright::reward {
namespace {

using enum ScalarOperation;

// All registers together should fit in the first-level cache beside the streamed columns.
constexpr int kCacheFloats = 6 * 1024;
constexpr int kLeastChunk = 64;
constexpr int kMostChunk = 512;

// A node as an instruction, after fusion.
struct Step {
  ScalarOperation operation;
  NodeId node;
  NodeId operands[3];
};

class Generator {
 public:
  Generator(Elaborator& elaborator, const ElaboratedOutputs& outputs)
      : graph_(elaborator.graph()), elaborator_(elaborator), outputs_(outputs) {}

  Code Generate(const RewardOptions& options);

 private:
  void FindLive();
  void FindLevels();
  void AssignNumbers();
  void MakeSlots();
  Stage MakeStage(int level);
  void AddUniform(int level, Stage* stage);
  std::vector<NodeId> Targets(int level) const;
  void CountUses(const std::vector<NodeId>& targets);
  void AddLoads(Stage* stage);
  void Schedule(Stage* stage);
  Step Fuse(NodeId node) const;
  bool UsedOnce(NodeId node) const { return uses_[node] == 1 && !graph_[node].uniform; }
  bool IsSquareOfDifference(NodeId node) const;
  void FinishStage(int level, Stage* stage);
  Column ColumnOf(NodeId node) const;
  Kernel KernelFor(const Step& step) const;
  int TakeRegister();

  const Graph& graph_;
  Elaborator& elaborator_;
  const ElaboratedOutputs& outputs_;
  Code code_;
  std::vector<bool> live_;
  std::vector<int> levels_;
  std::vector<int> number_;         // number of a uniform node; -1: none
  std::vector<int> spill_;          // spilled column of a flip
  std::vector<int> slot_of_input_;  // after elimination of dead slots
  // The state of the current stage.
  std::vector<bool> needed_;
  std::vector<int> uses_;
  std::vector<int> register_;
  std::vector<int> free_;
  int next_register_ = 0;
};

std::vector<NodeId> AllOutputs(const ElaboratedOutputs& outputs) {
  std::vector<NodeId> nodes = {outputs.reward};
  if (outputs.success >= 0) nodes.push_back(outputs.success);
  for (const auto& component : outputs.components) {
    nodes.insert(nodes.end(), component.nodes.begin(), component.nodes.end());
  }
  return nodes;
}

void Generator::FindLive() {
  live_.assign(graph_.size(), false);
  for (const NodeId node : AllOutputs(outputs_)) live_[node] = true;
  for (NodeId node = graph_.size(); node-- > 0;) {
    if (!live_[node]) continue;
    for (const NodeId operand : graph_[node].operands) {
      if (operand >= 0) live_[operand] = true;
    }
  }
}

// Computes the pass after which a node is available: each reduction over environments adds one.
void Generator::FindLevels() {
  levels_.assign(graph_.size(), 0);
  for (NodeId node = 0; node < graph_.size(); ++node) {
    for (const NodeId operand : graph_[node].operands) {
      if (operand >= 0) levels_[node] = std::max(levels_[node], levels_[operand]);
    }
    if (CrossesEnvironments(graph_[node].operation)) ++levels_[node];
  }
}

void Generator::AssignNumbers() {
  number_.assign(graph_.size(), -1);
  spill_.assign(graph_.size(), -1);
  for (NodeId node = 0; node < graph_.size(); ++node) {
    if (!live_[node] || graph_[node].operation != kConstant) continue;
    number_[node] = code_.numbers++;
    code_.constants.push_back(graph_[node].value);
  }
  for (NodeId node = 0; node < graph_.size(); ++node) {
    if (!live_[node]) continue;
    const Node& one = graph_[node];
    if (one.operation == kBatchFlip) spill_[node] = code_.register_spills++;
    if (!one.uniform || one.operation == kConstant) continue;
    number_[node] = code_.numbers++;
    if (one.operation == kBatchSize) code_.batch_size = -1 - number_[node];
  }
}

void Generator::MakeSlots() {
  const auto& slots = elaborator_.slots();
  std::vector<bool> used(slots.size(), false);
  for (NodeId node = 0; node < graph_.size(); ++node) {
    if (live_[node] && graph_[node].operation == kInput) {
      used[elaborator_.inputs()[graph_[node].index].first] = true;
    }
  }
  slot_of_input_.assign(slots.size(), -1);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!used[i]) continue;
    slot_of_input_[i] = static_cast<int>(code_.slots.size());
    code_.slots.push_back(slots[i]);
  }
}

std::vector<NodeId> Generator::Targets(int level) const {
  std::vector<NodeId> targets;
  const int last = static_cast<int>(code_.stages.size()) - 1;
  for (NodeId node = 0; node < graph_.size(); ++node) {
    if (live_[node] && CrossesEnvironments(graph_[node].operation) && levels_[node] == level + 1) {
      targets.push_back(graph_[node].operands[0]);
    }
  }
  if (level == last) {
    for (const NodeId node : AllOutputs(outputs_)) targets.push_back(node);
  }
  return targets;
}

// Finds the nodes that this pass computes and counts how often each is read.
void Generator::CountUses(const std::vector<NodeId>& targets) {
  needed_.assign(graph_.size(), false);
  uses_.assign(graph_.size(), 0);
  for (const NodeId target : targets) {
    needed_[target] = true;
    uses_[target] += 2;  // a target must exist at the end: it is never fused
  }
  for (NodeId node = graph_.size(); node-- > 0;) {
    const Node& one = graph_[node];
    if (!needed_[node] || one.uniform || CrossesEnvironments(one.operation)) continue;
    for (const NodeId operand : one.operands) {
      if (operand < 0) continue;
      needed_[operand] = true;
      ++uses_[operand];
    }
  }
}

int Generator::TakeRegister() {
  if (free_.empty()) return next_register_++;
  const int taken = free_.back();
  free_.pop_back();
  return taken;
}

// Assigns registers to the inputs for the whole pass: a caller's own column may take the place of
// such a register.
void Generator::AddLoads(Stage* stage) {
  std::map<int, std::vector<Load>> by_slot;
  for (NodeId node = 0; node < graph_.size(); ++node) {
    const Node& one = graph_[node];
    if (!needed_[node] || one.uniform) continue;
    if (one.operation == kBatchFlip) {
      register_[node] = TakeRegister();
      stage->axis_flips.push_back({spill_[node], 0, register_[node]});
    }
    if (one.operation != kInput) continue;
    register_[node] = TakeRegister();
    const auto [slot, lane] = elaborator_.inputs()[one.index];
    by_slot[slot_of_input_[slot]].push_back({slot_of_input_[slot], lane, register_[node]});
  }
  for (auto& [slot, loads] : by_slot) {
    if (code_.slots[slot].width == 3 && loads.size() == 3) {
      TripleLoad triple{slot, {}};
      for (const Load& load : loads) triple.columns[load.lane] = load.column;
      stage->triples.push_back(triple);
    } else {
      stage->loads.insert(stage->loads.end(), loads.begin(), loads.end());
    }
  }
}

bool Generator::IsSquareOfDifference(NodeId node) const {
  const Node& square = graph_[node];
  if (square.operation != kMultiply || square.operands[0] != square.operands[1]) return false;
  const NodeId difference = square.operands[0];
  return graph_[difference].operation == kSubtract && uses_[difference] == 2 &&
         !graph_[difference].uniform;
}

Step Generator::Fuse(NodeId node) const {
  const Node& one = graph_[node];
  Step step{one.operation, node, {one.operands[0], one.operands[1], one.operands[2]}};
  if (one.operation == kSubtract && UsedOnce(one.operands[1]) &&
      graph_[one.operands[1]].operation == kMultiply) {
    const Node& product = graph_[one.operands[1]];
    return {kMultiplySubtract, node, {product.operands[0], product.operands[1], one.operands[0]}};
  }
  if (one.operation != kAdd) return step;
  for (const bool second : {true, false}) {
    const NodeId product = one.operands[second ? 1 : 0], rest = one.operands[second ? 0 : 1];
    if (!UsedOnce(product) || graph_[product].operation != kMultiply) continue;
    if (IsSquareOfDifference(product)) {
      const Node& difference = graph_[graph_[product].operands[0]];
      return {kSquaredDifferenceAdd, node, {difference.operands[0], difference.operands[1], rest}};
    }
    return {kMultiplyAdd, node, {graph_[product].operands[0], graph_[product].operands[1], rest}};
  }
  return step;
}

Column Generator::ColumnOf(NodeId node) const {
  return graph_[node].uniform ? -1 - number_[node] : register_[node];
}

Kernel Generator::KernelFor(const Step& step) const {
  int uniform = 0;
  for (int i = 0; i < OperandCount(step.operation); ++i) {
    if (graph_[step.operands[i]].uniform) uniform |= 1 << i;
  }
  if (graph_[step.node].uniform) uniform = 0;  // computed on single numbers
  return Kernels().kernels[static_cast<int>(step.operation)][uniform];
}

void Generator::Schedule(Stage* stage) {
  // Visits nodes from last to first: a node that is fused into another is not requested.
  const std::vector<NodeId> targets = Targets(static_cast<int>(stage - code_.stages.data()));
  std::vector<Step> steps;
  std::vector<bool> wanted(graph_.size(), false);
  for (const NodeId target : targets) wanted[target] = true;
  for (NodeId node = graph_.size(); node-- > 0;) {
    const Node& one = graph_[node];
    if (!wanted[node] || one.uniform || OperandCount(one.operation) == 0 ||
        CrossesEnvironments(one.operation)) {
      continue;
    }
    const Step step = Fuse(node);
    for (int i = 0; i < OperandCount(step.operation); ++i) wanted[step.operands[i]] = true;
    steps.push_back(step);
  }
  std::reverse(steps.begin(), steps.end());
  std::vector<int> last(graph_.size(), -1);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (int k = 0; k < OperandCount(steps[i].operation); ++k) {
      last[steps[i].operands[k]] = static_cast<int>(i);
    }
  }
  for (const NodeId target : targets) last[target] = static_cast<int>(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    register_[step.node] = TakeRegister();
    Instruction instruction{KernelFor(step), register_[step.node], 0, 0, 0};
    Column* const columns[3] = {&instruction.a, &instruction.b, &instruction.c};
    for (int k = 0; k < OperandCount(step.operation); ++k) {
      *columns[k] = ColumnOf(step.operands[k]);
    }
    for (int k = 0; k < OperandCount(step.operation); ++k) {
      const NodeId operand = step.operands[k];
      const Node& read = graph_[operand];
      const bool computed =
          !read.uniform && read.operation != kInput && read.operation != kBatchFlip;
      if (computed && last[operand] == static_cast<int>(i)) {
        free_.push_back(register_[operand]);
        last[operand] = -1;  // freed once, even if it is used as two operands
      }
    }
    stage->body.push_back(instruction);
  }
  code_.operations += static_cast<int>(steps.size());
}

void Generator::AddUniform(int level, Stage* stage) {
  for (NodeId node = 0; node < graph_.size(); ++node) {
    const Node& one = graph_[node];
    if (!live_[node] || !one.uniform || levels_[node] != level) continue;
    if (one.operation == kInput) {
      const auto [slot, lane] = elaborator_.inputs()[one.index];
      stage->uniform_loads.push_back({slot_of_input_[slot], lane, -1 - number_[node]});
      continue;
    }
    if (OperandCount(one.operation) == 0 || CrossesEnvironments(one.operation)) continue;
    const Step step{one.operation, node, {one.operands[0], one.operands[1], one.operands[2]}};
    Instruction instruction{KernelFor(step), -1 - number_[node], 0, 0, 0};
    Column* const columns[3] = {&instruction.a, &instruction.b, &instruction.c};
    for (int k = 0; k < OperandCount(one.operation); ++k) {
      *columns[k] = -1 - number_[one.operands[k]];
    }
    stage->uniform.push_back(instruction);
  }
}

void Generator::FinishStage(int level, Stage* stage) {
  for (NodeId node = 0; node < graph_.size(); ++node) {
    const Node& one = graph_[node];
    if (!live_[node] || !CrossesEnvironments(one.operation) || levels_[node] != level + 1) continue;
    const Column result = one.operation == kBatchFlip ? spill_[node] : -1 - number_[node];
    stage->reductions.push_back({one.operation, ColumnOf(one.operands[0]), one.index, result});
  }
  if (level + 1 != static_cast<int>(code_.stages.size())) return;
  code_.reward = ColumnOf(outputs_.reward);
  code_.has_success = outputs_.success >= 0;
  if (code_.has_success) code_.success = ColumnOf(outputs_.success);
  for (const auto& component : outputs_.components) {
    ComponentCode compiled{component.name, {}};
    for (const NodeId node : component.nodes) compiled.columns.push_back(ColumnOf(node));
    code_.components.push_back(std::move(compiled));
  }
}

Code Generator::Generate(const RewardOptions& options) {
  FindLive();
  FindLevels();
  MakeSlots();
  AssignNumbers();
  int last = 0;
  for (NodeId node = 0; node < graph_.size(); ++node) {
    if (live_[node]) last = std::max(last, levels_[node]);
  }
  code_.stages.resize(last + 1);
  for (int level = 0; level <= last; ++level) {
    Stage* const stage = &code_.stages[level];
    register_.assign(graph_.size(), -1);
    free_.clear();
    next_register_ = 0;
    AddUniform(level, stage);
    CountUses(Targets(level));
    AddLoads(stage);
    Schedule(stage);
    FinishStage(level, stage);
    code_.registers = std::max(code_.registers, next_register_);
  }
  const int fitting = kCacheFloats / std::max(1, code_.registers) / kLeastChunk * kLeastChunk;
  code_.chunk = std::clamp(fitting, kLeastChunk, kMostChunk);
  const std::size_t bytes =
      (static_cast<std::size_t>(code_.registers) * code_.chunk + code_.numbers) * sizeof(float);
  if (bytes > options.max_workspace_bytes) {
    Fail("too-large", {},
         "the program needs " + std::to_string(bytes) + " bytes to run, at most " +
             std::to_string(options.max_workspace_bytes) + " are allowed");
  }
  return std::move(code_);
}

}  // namespace

Code GenerateCode(Elaborator& elaborator, const ElaboratedOutputs& outputs,
                  const RewardOptions& options) {
  return Generator(elaborator, outputs).Generate(options);
}

}  // namespace simwright::reward
