#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/finding.h"
#include "reward/environment_api.h"
#include "reward/frontend/syntax.h"
#include "reward/ir/graph.h"
#include "reward/reward_options.h"
#include "reward/reward_scene.h"
#include "reward/reward_slot.h"
#include "reward/stdlib/library.h"
#include "reward/stdlib/tensor_math.h"
#include "reward/symbolic/value.h"

namespace simwright::reward {

// The outputs of a program: nodes of the graph, one number per environment.
struct ElaboratedOutputs {
  NodeId reward = -1;
  NodeId success = -1;  // -1: no success
  struct Component {
    std::string name;
    std::vector<NodeId> nodes;
  };
  std::vector<Component> components;
};

// Executes a program once symbolically: evaluates numbers and strings, unrolls loops, inlines
// functions, and turns tensors into nodes of the graph. The result is arithmetic without control
// flow.
class Elaborator {
 public:
  Elaborator(const Module& module, const RewardScene* scene, const RewardOptions& options);

  // Runs `entry`. The outputs are meaningless if findings() then holds an error.
  ElaboratedOutputs Run(const Function& entry);

  const core::Findings& findings() const { return findings_; }
  // Returns the position of the first error, empty if there is none. Together with first_code() it
  // ranks candidate shapes by how far they compile.
  Position first_error() const { return first_error_; }
  // Returns the position of the first reduction that is meant for the last dimension but runs over
  // the environments; line 0 if there is none. A different shape would avoid it.
  Position first_collapse() const { return first_collapse_; }
  // Reports a reduction that was meant for the last dimension and runs over the environments.
  void ReportCollapse(const std::string& code, const Shape& shape, Position position);
  const std::string& first_code() const { return first_code_; }
  Graph& graph() { return graph_; }
  const std::vector<RewardSlot>& slots() const { return slots_; }
  // Returns for each graph input its slot and its index within the slot.
  const std::vector<std::pair<int, int>>& inputs() const { return inputs_; }

  // The interface for library functions.
  TensorMath& math() { return math_; }
  const RewardOptions& options() const { return options_; }
  void Step(Position position);
  void Report(const std::string& code, core::Severity severity, Position position,
              const std::string& sentence);
  // Returns the elements of a tuple, a list, a dictionary (its keys), or of a tensor along its
  // first dimension.
  std::vector<Value> Items(const Value& value, Position position);
  Value Binary(Operator operation, const Value& a, const Value& b, Position position);
  Value Compare(Operator operation, const Value& a, const Value& b, Position position);
  Value Subscript(const Value& base, const Value& index, Position position);
  // Removes a key from a dictionary and returns its value.
  Value RemoveKey(const Value& dict, const Value& key, Position position);
  void SetKey(const Value& dict, const Value& key, const Value& value, Position position);
  // Copies the entries of another dictionary.
  void Update(const Value& dict, const Value& other, Position position);
  Value NewList(std::vector<Value> items);
  // Returns the size of a dimension as the program sees it.
  Value SizeValue(int size);
  Value NewDict(std::vector<Value> keys, std::vector<Value> items);
  // Returns 1 or 0 if the truth value is known; else returns -1 and writes each environment's flag
  // to `flag`.
  int Truth(const Value& value, Tensor* flag, Position position);
  Value Choose(const Tensor& flag, const Value& yes, const Value& no, Position position);

 private:
  enum class Flow { kNext, kBreak, kContinue, kReturn };
  struct EarlyReturn {
    Tensor flag;
    Value value;
  };
  struct Frame {
    std::map<std::string, Value> names;
    const Function* function = nullptr;
    int number = 0;  // number of the call
    const Frame* caller = nullptr;
    std::shared_ptr<const Closure> closure;
    std::vector<EarlyReturn> early;
    Value result;
  };
  struct BranchEnd {
    Frame frame;
    Flow flow = Flow::kNext;
    std::vector<Object> heap;
  };
  // Limits the recursion depth of the elaborator.
  class RecursionGuard {
   public:
    RecursionGuard(Elaborator* elaborator, Position position);
    ~RecursionGuard() { --elaborator_->depth_; }

   private:
    Elaborator* elaborator_;
  };
  // A value and the heap in which its objects are looked up.
  struct Side {
    const Value& value;
    const std::vector<Object>& heap;
  };
  // elaborate_statements.cpp
  void Globals();
  void DoImport(const Import& import);
  Flow Execute(const Block& block);
  Flow Execute(const Statement& statement);
  Flow ExecuteFor(const Statement& statement);
  void Assign(const Expression& target, const Value& value);
  void AssignName(const std::string& name, const Value& value, Position position);
  void AssignSubscript(const Expression& target, const Value& value);
  void AssignInTensor(const Tensor& tensor, const Value& index, const Value& value,
                      Position position);
  void AssignInContainer(const Value& base, const Value& index, const Value& value,
                         Position position);
  void Unpack(const Expression& target, const Value& value);
  void Augment(const Statement& statement);
  bool AugmentMasked(const Statement& statement);
  // Throws Fault if the tensor cannot hold the result of an operation on it in place.
  void CheckFits(const Tensor& before, const Tensor& after, Position position) const;
  void Poison(const Expression& target);

  // elaborate_functions.cpp
  void DefineInside(const Statement& statement);
  const Value* EnclosingValue(const std::string& name, Position position) const;
  Value GlobalValue(const Expression& expression);
  void Delete(const Expression& target);
  Value Call(const Function& function, const std::shared_ptr<const Closure>& closure,
             const std::vector<Value>& values, const std::vector<std::string>& keywords,
             Position position);
  void BindParameters(const Function& function, const std::vector<Value>& values,
                      const std::vector<std::string>& keywords, Position position, Frame* frame);
  Value Finish(Frame* frame, Flow flow, Position position);

  // elaborate_branches.cpp
  Flow ExecuteIf(const Statement& statement, std::size_t branch);
  Flow ExecuteBoth(const Statement& statement, std::size_t branch, const Tensor& flag);
  BranchEnd RunBranch(const Statement& statement, std::size_t branch, bool otherwise);
  void JoinNames(const Tensor& flag, const BranchEnd& yes, const BranchEnd& no, Position position);
  void JoinObjects(const Tensor& flag, const BranchEnd& yes, const BranchEnd& no, int count,
                   Position position);
  Value Join(const Tensor& flag, const Side& yes, const Side& no, Position position);
  Value JoinItems(const Tensor& flag, const Side& yes, const Side& no, Position position);
  Value JoinDicts(const Tensor& flag, const Object& yes, const std::vector<Object>& yes_heap,
                  const Object& no, const std::vector<Object>& no_heap, Position position);
  Value JoinTensors(const Tensor& flag, const Side& yes, const Side& no, Position position);
  Value DeepCopy(const Value& value);
  Tensor Both(const Tensor& a, const Tensor& b, bool negate_b, Position position);

  // elaborate_expressions.cpp
  Value Evaluate(const Expression& expression);
  Value EvaluateKind(const Expression& expression);
  Value EvaluateName(const Expression& expression);
  Value EvaluateDisplay(const Expression& expression);
  Value EvaluateFormat(const Expression& expression);
  Value EvaluateDict(const Expression& expression);
  Value EvaluateUnary(const Expression& expression);
  Value EvaluateCompare(const Expression& expression);
  Value EvaluateBoolean(const Expression& expression);
  Value EvaluateConditional(const Expression& expression);
  Value EvaluateComprehension(const Expression& expression);
  Value EvaluateSlice(const Expression& expression);
  Value EvaluateCall(const Expression& expression);
  void AddDictArguments(const Value& dict, Position position, std::vector<Value>* values,
                        std::vector<std::string>* keywords);
  Value CallValue(const Value& callee, std::vector<Value> values, std::vector<std::string> keywords,
                  const std::vector<Position>& places, Position position);
  std::vector<std::string> VisibleNames() const;

  // elaborate_calls.cpp
  Value NamedDict(const std::vector<Value>& values, const std::vector<std::string>& keywords,
                  Position position);
  Value WriteInPlace(const Value& target, const Value& result, Position position);

  // elaborate_attributes.cpp
  Value EvaluateAttribute(const Expression& expression);
  Value ModuleAttribute(const std::string& module, const std::string& name, Position position);
  Value EnvironmentAttribute(const Value& environment, const std::string& name, Position position);
  // Handles attributes of another simulator's environment (foreign_names.h): returns a handle for
  // further attributes, or throws a Fault that names the equivalent here.
  bool IsForeignAttribute(const Expression& expression) const;
  Value ForeignAttribute(const std::string& path, Position position);
  Value TensorAttribute(const Value& value, const std::string& name, Position position);

  // elaborate_operators.cpp
  Value BinaryTensors(Operator operation, const Value& a, const Value& b, Position position);
  void WarnAboutSelfDistance(const Tensor& a, const Tensor& b, Position position);
  Value Negate(const Value& value, Position position);
  Value Invert(const Value& value, Position position);

  // elaborate_subscripts.cpp
  Tensor SubscriptTensor(const Tensor& tensor, const Value& index, Position position);
  Tensor ApplyIndex(const Tensor& tensor, const Value& index, int* dimension, Position position);
  Tensor SliceTensor(const Tensor& tensor, int dimension, const Value& slice, Position position);
  Value SubscriptItems(const Value& base, const std::vector<Value>& items, const Value& index,
                       Position position);
  Value SubscriptDict(const Value& base, const Value& index, Position position);
  bool IsMask(const Value& index) const;
  Tensor SelectByMask(const Tensor& tensor, const Tensor& mask, int dimension, Position position);
  Tensor ExpandToEnvironments(const Tensor& value, const Tensor& mask, Position position);
  Tensor MaskFor(const Tensor& tensor, const Value& index, Position position);

  // elaborate_environment.cpp
  Value CallApi(const Value& callee, const std::vector<Value>& values,
                const std::vector<std::string>& keywords, const std::vector<Position>& places,
                Position position);
  struct ApiArguments;
  ApiArguments BindApi(const ApiFunction& function, const Value& callee,
                       const std::vector<Value>& values, const std::vector<std::string>& keywords,
                       const std::vector<Position>& places, Position position);
  void CheckNames(const ApiFunction& function, ApiArguments* arguments);
  Value ApiValue(const ApiFunction& function, const ApiArguments& arguments, Position position);
  Value ApiGeometry(const ApiFunction& function, const ApiArguments& arguments, Position position);
  Value JointLimit(const ApiArguments& arguments, bool upper);
  Value SlotValue(RewardInput input, const std::string& asset, const std::string& part,
                  const Shape& shape, DataType type, bool uniform, Position position);
  int AddSlot(RewardSlot slot);
  Value ParameterValue(const Parameter& parameter);

  // elaborate_outputs.cpp
  ElaboratedOutputs Outputs(const Value& result, Position position);
  NodeId RewardNode(const Value& value, Position position);
  NodeId SuccessNode(const Value& value, Position position);
  void Components(const Value& value, Position position, ElaboratedOutputs* outputs);

  const Module& module_;
  const RewardScene* scene_;
  const RewardOptions& options_;
  core::Findings findings_;
  Position first_error_;
  Position first_collapse_{0, 0};
  std::string first_code_;
  int errors_ = 0;
  Graph graph_;
  Heap heap_;
  TensorMath math_;
  std::vector<RewardSlot> slots_;
  std::vector<int> slot_inputs_;  // index of the first input of each slot
  std::vector<std::pair<int, int>> inputs_;
  std::map<std::string, Value> globals_;
  std::map<std::string, const Function*> functions_;
  Frame* frame_ = nullptr;
  std::vector<const Function*> calls_;
  Position returned_at_;
  int steps_ = 0;
  int depth_ = 0;
  int frames_ = 0;
};

}  // namespace simwright::reward
