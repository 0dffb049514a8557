#include <algorithm>

#include "reward/frontend/spelling.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

// Modules that access the machine. They are rejected, although nothing of them could be used
// anyway.
constexpr std::string_view kForbiddenModules[] = {
    "os",        "sys",      "subprocess", "socket", "shutil",    "pathlib",        "builtins",
    "importlib", "ctypes",   "pickle",     "io",     "threading", "requests",       "urllib",
    "http",      "tempfile", "signal",     "runpy",  "code",      "multiprocessing"};

// Names with a fixed meaning, which no program may rebind.
constexpr std::string_view kFixedNames[] = {"torch", "np", "numpy", "math"};

std::string CanonicalModule(const std::string& module) {
  if (module == "numpy" || module.starts_with("numpy.")) return "np" + module.substr(5);
  if (module == "F") return "torch.nn.functional";
  return module;
}

}  // namespace

Elaborator::Elaborator(const Module& module, const RewardScene* scene, const RewardOptions& options)
    : module_(module),
      scene_(scene),
      options_(options),
      graph_(options.max_nodes),
      math_(options, &graph_, &heap_) {}

void Elaborator::Report(const std::string& code, core::Severity severity, Position position,
                        const std::string& sentence) {
  const std::string place = std::to_string(position.line) + ":" + std::to_string(position.column);
  for (const core::Finding& finding : findings_) {  // once, even if a loop passes here repeatedly
    if (finding.place == place && finding.code == code) return;
  }
  if (severity == core::Severity::kError && errors_++ == 0) {
    first_error_ = position;
    first_code_ = code;
  }
  // Warnings never displace errors.
  const bool error = severity == core::Severity::kError;
  const int held = error ? errors_ - 1 : static_cast<int>(findings_.size());
  if (held < options_.max_findings) findings_.push_back({code, severity, place, sentence, 0.0});
}

void Elaborator::ReportCollapse(const std::string& code, const Shape& shape, Position position) {
  if (first_collapse_.line == 0) first_collapse_ = position;
  Report(code, core::Severity::kWarning, position,
         "the last dimension of " + ShapeText(shape) +
             " runs over the environments: this is one number for all of them");
}

Elaborator::RecursionGuard::RecursionGuard(Elaborator* elaborator, Position position)
    : elaborator_(elaborator) {
  // Frames of called functions share one stack.
  if (elaborator_->depth_ >= 3 * elaborator_->options_.max_depth) {
    Fail("too-deep", position, "functions, branches and expressions are nested too deeply");
  }
  ++elaborator_->depth_;
}

void Elaborator::Step(Position position) {
  if (++steps_ > options_.max_steps) {
    Fail("too-many-steps", position,
         "the program takes more than " + std::to_string(options_.max_steps) +
             " steps, loops unrolled; shorten its loops");
  }
}

void Elaborator::DoImport(const Import& import) {
  const std::string root = import.module.substr(0, import.module.find('.'));
  if (std::find(std::begin(kForbiddenModules), std::end(kForbiddenModules), root) !=
      std::end(kForbiddenModules)) {
    Fail("forbidden", import.position,
         "a reward cannot import '" + root + "'; it computes with torch, numpy and math alone");
  }
  const std::string module = CanonicalModule(import.module);
  auto& names = frame_ == nullptr ? globals_ : frame_->names;
  const bool known = IsLibraryModule(module);
  if (import.name.empty()) {
    const std::string local = import.alias.empty() ? root : import.alias;
    const std::string meant = import.alias.empty() ? CanonicalModule(root) : module;
    names[local] = known ? PlainValue(ValueKind::kModule, meant)
                         : PlainValue(ValueKind::kOpaque, import.module);
  } else if (import.name != "*" && known) {
    const std::string full = module + "." + import.name;
    if (import.name != import.alias || IsLibraryModule(full) ||
        FindLibraryFunction(full) != nullptr) {
      names[import.alias] = ModuleAttribute(module, import.name, import.position);
    }
  }
  // Other imports (types, Isaac Gym's utilities) are known by their bare names or not at all.
}

void Elaborator::Globals() {
  globals_["torch"] = PlainValue(ValueKind::kModule, "torch");
  globals_["np"] = globals_["numpy"] = PlainValue(ValueKind::kModule, "np");
  globals_["math"] = PlainValue(ValueKind::kModule, "math");
  globals_["F"] = PlainValue(ValueKind::kModule, "torch.nn.functional");
  for (const std::string type :
       {"Tensor", "Tuple", "Dict", "List", "Optional", "Any", "Union", "SceneEntityCfg"}) {
    globals_[type] = PlainValue(ValueKind::kOpaque, type);
  }
  globals_["TYPE_CHECKING"] = BoolValue(false);
  for (const auto& function : module_.functions) {
    const auto [found, fresh] = functions_.emplace(function->name, function.get());
    if (!fresh) {
      Report("defined-twice", core::Severity::kWarning, function->position,
             "'" + function->name + "' is defined twice; the last one counts");
      found->second = function.get();
    }
    const bool fixed = std::find(std::begin(kFixedNames), std::end(kFixedNames), function->name) !=
                       std::end(kFixedNames);
    if (fixed) {
      Report("shadows", core::Severity::kError, function->position,
             "a function may not be called '" + function->name + "', which is a module");
    } else if (FindApiFunction(function->name) != nullptr) {
      Report("shadows", core::Severity::kError, function->position,
             "'" + function->name + "' is a function of the environment; call yours otherwise");
    } else if (FindLibraryFunction(function->name) != nullptr) {
      Report("shadows", core::Severity::kWarning, function->position,
             "'" + function->name + "' takes the place of the known function of this name");
    }
    Value value = PlainValue(ValueKind::kFunction, function->name);
    value.function = function.get();
    globals_[function->name] = value;
  }
  Frame frame;
  for (const auto& statement : module_.statements) {
    frame_ = statement->kind == StatementKind::kImport ? nullptr : &frame;
    try {
      if (statement->kind == StatementKind::kReturn) {
        Fail("syntax", statement->position, "'return' stands outside a function");
      }
      Execute(*statement);
    } catch (const Fault& fault) {
      if (!fault.code.empty()) {
        Report(fault.code, core::Severity::kError, fault.position, fault.sentence);
      }
    }
    for (auto& [name, value] : frame.names) globals_[name] = value;
  }
  frame_ = nullptr;
}

ElaboratedOutputs Elaborator::Run(const Function& entry) {
  Globals();
  ElaboratedOutputs outputs;
  try {
    std::vector<Value> values;
    for (const Parameter& parameter : entry.parameters) values.push_back(ParameterValue(parameter));
    returned_at_ = entry.position;
    const Value result =
        Call(entry, nullptr, values, std::vector<std::string>(values.size()), entry.position);
    if (errors_ == 0) outputs = Outputs(result, returned_at_);
  } catch (const Fault& fault) {
    if (!fault.code.empty() || errors_ == 0) {
      Report(fault.code.empty() ? "undefined" : fault.code, core::Severity::kError, fault.position,
             fault.sentence);
    }
  }
  return outputs;
}

Elaborator::Flow Elaborator::Execute(const Block& block) {
  for (const auto& statement : block) {
    Flow flow = Flow::kNext;
    try {
      flow = Execute(*statement);
    } catch (const Fault& fault) {
      // Elaboration resumes on the next line, so that one run reports all errors; the names that
      // this line would define are unusable from here on, without further findings.
      if (fault.code == "too-many-steps" || fault.code == "too-deep") throw;
      if (!fault.code.empty()) {
        Position position = fault.position;
        if (position.line == 1 && position.column == 1) position = statement->position;
        Report(fault.code, core::Severity::kError, position, fault.sentence);
      }
      if (errors_ >= options_.max_findings || fault.code == "too-large") throw Fault{};
      for (const ExpressionPtr& target : statement->targets) Poison(*target);
      if (statement->function != nullptr) {
        frame_->names[statement->function->name] = PlainValue(ValueKind::kUndefined);
      }
      if (statement->kind == StatementKind::kReturn) {
        frame_->result = PlainValue(ValueKind::kUndefined);
        return Flow::kReturn;
      }
    }
    if (flow != Flow::kNext) return flow;
  }
  return Flow::kNext;
}

void Elaborator::Poison(const Expression& target) {
  if (target.kind == ExpressionKind::kName) {
    frame_->names[target.text] = PlainValue(ValueKind::kUndefined);
  }
  if (target.kind == ExpressionKind::kTuple || target.kind == ExpressionKind::kList ||
      target.kind == ExpressionKind::kStarred) {
    for (const ExpressionPtr& child : target.children) Poison(*child);
  }
}

Elaborator::Flow Elaborator::Execute(const Statement& statement) {
  Step(statement.position);
  switch (statement.kind) {
    case StatementKind::kExpression:
      Evaluate(*statement.value);
      return Flow::kNext;
    case StatementKind::kAssign: {
      const Value value = Evaluate(*statement.value);
      for (const ExpressionPtr& target : statement.targets) Assign(*target, value);
      return Flow::kNext;
    }
    case StatementKind::kAugmented:
      Augment(statement);
      return Flow::kNext;
    case StatementKind::kReturn:
      returned_at_ = statement.value != nullptr ? statement.value->position : statement.position;
      frame_->result = statement.value == nullptr ? Value{} : Evaluate(*statement.value);
      return Flow::kReturn;
    case StatementKind::kIf:
      return ExecuteIf(statement, 0);
    case StatementKind::kFor:
      return ExecuteFor(statement);
    case StatementKind::kBlock:
      return Execute(statement.blocks[0]);
    case StatementKind::kFunction:
      DefineInside(statement);
      return Flow::kNext;
    case StatementKind::kDelete:
      for (const ExpressionPtr& target : statement.targets) Delete(*target);
      return Flow::kNext;
    case StatementKind::kImport:
      for (const Import& import : statement.imports) DoImport(import);
      return Flow::kNext;
    case StatementKind::kPass:
      return Flow::kNext;
    case StatementKind::kBreak:
      return Flow::kBreak;
    case StatementKind::kContinue:
      return Flow::kContinue;
  }
  return Flow::kNext;
}

Elaborator::Flow Elaborator::ExecuteFor(const Statement& statement) {
  const Value range = Evaluate(*statement.value);
  for (const Value& item : Items(range, statement.value->position)) {
    Step(statement.position);
    Assign(*statement.targets[0], item);
    const Flow flow = Execute(statement.blocks[0]);
    if (flow == Flow::kBreak) break;
    if (flow == Flow::kReturn) return flow;
  }
  return Flow::kNext;
}

void Elaborator::AssignName(const std::string& name, const Value& value, Position position) {
  const auto held = frame_->names.find(name);
  const bool environment = held != frame_->names.end() && held->second.Is(ValueKind::kEnvironment);
  const bool fixed =
      std::find(std::begin(kFixedNames), std::end(kFixedNames), name) != std::end(kFixedNames);
  if ((fixed && !value.Is(ValueKind::kModule)) ||
      (environment && !value.Is(ValueKind::kEnvironment))) {
    Fail("shadows", position,
         "'" + name + "' is the " + (fixed ? "module" : "environment") +
             " and may not be given another meaning; choose another name");
  }
  if (FindApiFunction(name) != nullptr) {
    Fail("shadows", position,
         "'" + name + "' is a function of the environment; choose another name for the value");
  }
  frame_->names[name] = value;
}

void Elaborator::Assign(const Expression& target, const Value& value) {
  switch (target.kind) {
    case ExpressionKind::kName:
      AssignName(target.text, value, target.position);
      return;
    case ExpressionKind::kTuple:
    case ExpressionKind::kList:
      Unpack(target, value);
      return;
    case ExpressionKind::kSubscript:
      AssignSubscript(target, value);
      return;
    case ExpressionKind::kAttribute:
      Fail("bad-target", target.position,
           "'." + target.text +
               "' cannot be assigned: a reward reads the environment and leaves "
               "it as it is; use a local name");
    default:
      Fail("bad-target", target.position, "this cannot be assigned to");
  }
}

// Implements a, b = values; a starred name receives a list of the remaining values.
void Elaborator::Unpack(const Expression& target, const Value& value) {
  const std::vector<Value> items = Items(value, target.position);
  const std::size_t names = target.children.size();
  std::size_t starred = names;
  for (std::size_t i = 0; i < names; ++i) {
    if (target.children[i]->kind != ExpressionKind::kStarred) continue;
    if (starred != names) {
      Fail("unpack", target.children[i]->position, "one name alone may have a '*'");
    }
    starred = i;
  }
  const bool fits = starred == names ? items.size() == names : items.size() + 1 >= names;
  if (!fits) {
    Fail("unpack", target.position,
         std::to_string(names) + " names stand here for " + std::to_string(items.size()) +
             " values");
  }
  const std::size_t more = items.size() - names;  // wraps around if the starred name receives none
  for (std::size_t i = 0; i < names; ++i) {
    if (i != starred) {
      Assign(*target.children[i], items[i < starred ? i : i + more]);
      continue;
    }
    const auto first = items.begin() + static_cast<std::ptrdiff_t>(i);
    const auto count = static_cast<std::ptrdiff_t>(items.size() - (names - 1));
    Assign(*target.children[i]->children[0], NewList({first, first + count}));
  }
}

// t += x modifies the tensor that t names, as in torch; numbers and other values are rebound.
void Elaborator::Augment(const Statement& statement) {
  const Expression& target = *statement.targets[0];
  if (target.kind != ExpressionKind::kName && target.kind != ExpressionKind::kSubscript) {
    Fail("bad-target", target.position, "this cannot be changed in place");
  }
  if (target.kind == ExpressionKind::kSubscript && AugmentMasked(statement)) return;
  const Value old = Evaluate(target);
  const Value operand = Evaluate(*statement.value);
  const Value fresh = Binary(statement.operation, old, operand, statement.position);
  // A scalar is never modified in place: programs for one environment hold it in a plain float.
  if (!old.Is(ValueKind::kTensor) || !fresh.Is(ValueKind::kTensor) || old.tensor->shape.empty()) {
    Assign(target, fresh);
    return;
  }
  CheckFits(*old.tensor, *fresh.tensor, statement.position);
  math_.Write(*old.tensor, math_.Nodes(*fresh.tensor));
}

void Elaborator::CheckFits(const Tensor& before, const Tensor& after, Position position) const {
  if (after.type > before.type) {
    Fail("type", position,
         "the result is " + Describe(TensorValue(after)) + ", which " +
             Describe(TensorValue(before)) +
             " cannot hold; write x = x + y, or make the tensor .float() first");
  }
  if (after.shape != before.shape) {
    Fail("shape", position,
         "the result " + ShapeText(after.shape) + " does not fit into the tensor " +
             ShapeText(before.shape) + " in place; write x = x + y");
  }
}

}  // namespace simwright::reward
