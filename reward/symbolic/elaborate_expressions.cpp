#include <algorithm>

#include "reward/frontend/spelling.h"
#include "reward/stdlib/format_text.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

constexpr std::size_t kLongestExpression = 4096;

// Python functions that a reward must not use.
constexpr std::string_view kForbiddenNames[] = {
    "eval",     "exec",     "open",    "compile", "input",      "globals",    "locals",
    "vars",     "getattr",  "setattr", "delattr", "hasattr",    "dir",        "help",
    "id",       "type",     "object",  "super",   "memoryview", "breakpoint", "classmethod",
    "property", "callable", "iter",    "next",    "exit",       "quit"};

}  // namespace

Value Elaborator::NewList(std::vector<Value> items) {
  if (static_cast<int>(items.size()) > options_.max_lanes) {
    Fail("too-large", {},
         "a list holds more than " + std::to_string(options_.max_lanes) + " elements");
  }
  Value value = PlainValue(ValueKind::kList);
  value.object = heap_.AddList(std::move(items));
  return value;
}

Value Elaborator::NewDict(std::vector<Value> keys, std::vector<Value> items) {
  Value value = PlainValue(ValueKind::kDict);
  value.object = heap_.AddDict(std::move(keys), std::move(items));
  return value;
}

Value Elaborator::Evaluate(const Expression& expression) {
  Step(expression.position);
  const RecursionGuard deeper(this, expression.position);
  try {
    return EvaluateKind(expression);
  } catch (const Fault& fault) {
    if (fault.code == "too-large" && fault.position.line == 1 && fault.position.column == 1) {
      Fail(fault.code, expression.position, fault.sentence);
    }
    throw;
  }
}

Value Elaborator::EvaluateKind(const Expression& expression) {
  switch (expression.kind) {
    case ExpressionKind::kNone:
      return Value{};
    case ExpressionKind::kTrue:
      return BoolValue(true);
    case ExpressionKind::kFalse:
      return BoolValue(false);
    case ExpressionKind::kEllipsis:
      return PlainValue(ValueKind::kEllipsis);
    case ExpressionKind::kInteger:
      return IntegerValue(expression.integer);
    case ExpressionKind::kFloat:
      return FloatValue(expression.number);
    case ExpressionKind::kString:
      return StringValue(expression.text);
    case ExpressionKind::kFormatString:
      return EvaluateFormat(expression);
    case ExpressionKind::kFormatted:
      return StringValue(FormatValue(Evaluate(*expression.children[0]), expression.text,
                                     static_cast<char>(expression.integer), expression.position));
    case ExpressionKind::kStarred:
      Fail("syntax", expression.position, "'*' has no meaning here");
    case ExpressionKind::kName:
      return EvaluateName(expression);
    case ExpressionKind::kTuple:
    case ExpressionKind::kList:
      return EvaluateDisplay(expression);
    case ExpressionKind::kDict:
      return EvaluateDict(expression);
    case ExpressionKind::kUnary:
      return EvaluateUnary(expression);
    case ExpressionKind::kBinary: {
      const Value left = Evaluate(*expression.children[0]);
      return Binary(expression.operation, left, Evaluate(*expression.children[1]),
                    expression.position);
    }
    case ExpressionKind::kCompare:
      return EvaluateCompare(expression);
    case ExpressionKind::kBoolean:
      return EvaluateBoolean(expression);
    case ExpressionKind::kConditional:
      return EvaluateConditional(expression);
    case ExpressionKind::kCall:
      return EvaluateCall(expression);
    case ExpressionKind::kAttribute:
      return EvaluateAttribute(expression);
    case ExpressionKind::kSubscript: {
      const Value base = Evaluate(*expression.children[0]);
      return Subscript(base, Evaluate(*expression.children[1]), expression.position);
    }
    case ExpressionKind::kSlice:
      return EvaluateSlice(expression);
    case ExpressionKind::kListComprehension:
    case ExpressionKind::kDictComprehension:
      return EvaluateComprehension(expression);
  }
  return Value{};
}

std::vector<std::string> Elaborator::VisibleNames() const {
  std::vector<std::string> names = LibraryNames("");
  for (const auto& [name, value] : globals_) names.push_back(name);
  if (frame_ != nullptr) {
    for (const auto& [name, value] : frame_->names) names.push_back(name);
  }
  return names;
}

Value Elaborator::EvaluateName(const Expression& expression) {
  const std::string& name = expression.text;
  if (frame_ != nullptr) {
    const auto local = frame_->names.find(name);
    if (local != frame_->names.end()) {
      if (local->second.Is(ValueKind::kUndefined)) {
        Fail(local->second.text.empty() ? "" : "undefined", expression.position,
             local->second.text);
      }
      return local->second;
    }
    if (frame_->function != nullptr && frame_->function->locals.contains(name)) {
      Fail("undefined", expression.position,
           "'" + name + "' is read before it is set: '" + frame_->function->name +
               "' sets it, so it is its own there");
    }
    if (const Value* outer = EnclosingValue(name, expression.position)) {
      if (outer->Is(ValueKind::kUndefined)) {
        Fail(outer->text.empty() ? "" : "undefined", expression.position, outer->text);
      }
      return *outer;
    }
  }
  const auto global = globals_.find(name);
  if (global != globals_.end()) {
    if (global->second.Is(ValueKind::kUndefined)) Fail("", expression.position, "");
    return global->second;
  }
  if (const LibraryFunction* function = FindLibraryFunction(name)) {
    Value value = PlainValue(ValueKind::kLibrary, name);
    value.library = function;
    return value;
  }
  if (FindApiFunction(name) != nullptr) return PlainValue(ValueKind::kApi, name);
  if (std::find(std::begin(kForbiddenNames), std::end(kForbiddenNames), name) !=
      std::end(kForbiddenNames)) {
    Fail("forbidden", expression.position,
         "'" + name + "' is not part of the language: a reward computes and touches nothing else");
  }
  std::vector<std::string> known = VisibleNames();
  for (std::string& api : ApiNames()) known.push_back(std::move(api));
  Fail("undefined", expression.position,
       "nothing is called '" + name + "' here" + Suggestion(name, known));
}

Value Elaborator::EvaluateDisplay(const Expression& expression) {
  std::vector<Value> items;
  for (const ExpressionPtr& child : expression.children) {
    if (child->kind != ExpressionKind::kStarred) {
      items.push_back(Evaluate(*child));
      continue;
    }
    for (Value& item : Items(Evaluate(*child->children[0]), child->position)) {
      items.push_back(std::move(item));
    }
    if (static_cast<int>(items.size()) > options_.max_lanes) {
      Fail("too-large", child->position, "this grows too long");
    }
  }
  return expression.kind == ExpressionKind::kList ? NewList(std::move(items))
                                                  : TupleValue(std::move(items));
}

Value Elaborator::EvaluateFormat(const Expression& expression) {
  std::string text;
  for (const ExpressionPtr& child : expression.children) {
    const Value value = Evaluate(*child);
    text += FormatValue(value, "", '\0', child->position);
    if (text.size() > kLongestExpression) {
      Fail("too-large", expression.position, "the string is longer than 4096 characters");
    }
  }
  return StringValue(std::move(text));
}

Value Elaborator::EvaluateDict(const Expression& expression) {
  const Value dict = NewDict({}, {});
  for (std::size_t i = 0; i + 1 < expression.children.size(); i += 2) {
    const Expression* key = expression.children[i].get();
    const Expression& item = *expression.children[i + 1];
    if (key == nullptr) {
      Update(dict, Evaluate(item), item.position);
      continue;
    }
    const Value name = Evaluate(*key);
    SetKey(dict, name, Evaluate(item), key->position);
  }
  return dict;
}

Value Elaborator::EvaluateUnary(const Expression& expression) {
  const Value value = Evaluate(*expression.children[0]);
  switch (expression.operation) {
    case Operator::kNegate:
      return Negate(value, expression.position);
    case Operator::kInvert:
      return Invert(value, expression.position);
    case Operator::kNot: {
      Tensor flag;
      const int truth = Truth(value, &flag, expression.position);
      if (truth >= 0) return BoolValue(truth == 0);
      return TensorValue(
          math_.Map(ScalarOperation::kNot, flag, DataType::kBool, expression.position));
    }
    default:
      if (!value.IsNumber()) math_.FromValue(value, expression.position);
      return value;
  }
}

Value Elaborator::EvaluateCompare(const Expression& expression) {
  Value left = Evaluate(*expression.children[0]);
  Value result;
  for (std::size_t i = 0; i < expression.operations.size(); ++i) {
    const Value right = Evaluate(*expression.children[i + 1]);
    const Value one = Compare(expression.operations[i], left, right, expression.position);
    result = i == 0 ? one : Binary(Operator::kAnd, result, one, expression.position);
    left = right;
  }
  return result;
}

Value Elaborator::EvaluateBoolean(const Expression& expression) {
  const bool all = expression.operation == Operator::kBooleanAnd;
  Value result = Evaluate(*expression.children[0]);
  for (std::size_t i = 1; i < expression.children.size(); ++i) {
    Tensor flag;
    const int truth = Truth(result, &flag, expression.children[i - 1]->position);
    if (truth == (all ? 0 : 1)) return result;
    const Value next = Evaluate(*expression.children[i]);
    if (truth >= 0) {
      result = next;
      continue;
    }
    Tensor other;
    const int known = Truth(next, &other, expression.children[i]->position);
    const bool flags =
        result.NumberType() == DataType::kBool && next.NumberType() == DataType::kBool;
    if (known >= 0 && flags) {
      if (known == (all ? 0 : 1)) result = next;
    } else if (flags) {
      const ScalarOperation operation = all ? ScalarOperation::kAnd : ScalarOperation::kOr;
      result = TensorValue(math_.Map(operation, flag, other, DataType::kBool, expression.position));
    } else {
      result = all ? Choose(flag, next, result, expression.position)
                   : Choose(flag, result, next, expression.position);
    }
  }
  return result;
}

Value Elaborator::EvaluateConditional(const Expression& expression) {
  Tensor flag;
  const int truth =
      Truth(Evaluate(*expression.children[0]), &flag, expression.children[0]->position);
  if (truth >= 0) return Evaluate(*expression.children[truth == 1 ? 1 : 2]);
  const Value yes = Evaluate(*expression.children[1]);
  const Value no = Evaluate(*expression.children[2]);
  return Choose(flag, yes, no, expression.position);
}

Value Elaborator::EvaluateComprehension(const Expression& expression) {
  if (frame_ == nullptr) Fail("syntax", expression.position, "a loop stands outside a function");
  const bool dict = expression.kind == ExpressionKind::kDictComprehension;
  const Value iterable = Evaluate(*expression.children[2]);
  const std::map<std::string, Value> outside = frame_->names;
  std::vector<Value> keys, items;
  for (const Value& item : Items(iterable, expression.children[2]->position)) {
    Assign(*expression.children[1], item);
    if (const Expression* condition = expression.children[3].get()) {
      Tensor flag;
      const int truth = Truth(Evaluate(*condition), &flag, condition->position);
      if (truth < 0) {
        Fail("condition", condition->position,
             "which elements there are differs between environments; use torch.where instead");
      }
      if (truth == 0) continue;
    }
    if (dict) keys.push_back(Evaluate(*expression.children[0]));
    items.push_back(Evaluate(*expression.children[dict ? 4 : 0]));
  }
  frame_->names = outside;  // the loop variable is removed, as in Python
  return dict ? NewDict(std::move(keys), std::move(items)) : NewList(std::move(items));
}

Value Elaborator::EvaluateSlice(const Expression& expression) {
  std::vector<Value> parts;
  for (const ExpressionPtr& child : expression.children) {
    parts.push_back(child == nullptr ? Value{} : Evaluate(*child));
  }
  Value slice = TupleValue(std::move(parts));
  slice.kind = ValueKind::kSlice;
  return slice;
}

// Adds the arguments of f(**dict).
void Elaborator::AddDictArguments(const Value& dict, Position position, std::vector<Value>* values,
                                  std::vector<std::string>* keywords) {
  if (!dict.Is(ValueKind::kDict)) {
    Fail("type", position, "a dictionary is wanted after '**', this is " + Describe(dict));
  }
  const Object contents = heap_[dict.object];
  for (std::size_t i = 0; i < contents.keys->size(); ++i) {
    const Value& key = (*contents.keys)[i];
    if (!key.Is(ValueKind::kString)) Fail("type", position, "arguments are named by strings");
    values->push_back((*contents.items)[i]);
    keywords->push_back(key.text);
  }
}

Value Elaborator::EvaluateCall(const Expression& expression) {
  const Expression& called = *expression.children[0];
  if (called.kind == ExpressionKind::kName && called.text == "print") return Value{};
  const Value callee = Evaluate(called);
  std::vector<Value> values;
  std::vector<std::string> keywords;
  std::vector<Position> places;
  for (std::size_t i = 0; i < expression.keywords.size(); ++i) {
    const Expression& argument = *expression.children[i + 1];
    const Value value = Evaluate(argument);
    if (expression.keywords[i] == "**") {
      AddDictArguments(value, argument.position, &values, &keywords);
      places.resize(values.size(), argument.position);
      continue;
    }
    if (expression.keywords[i] != "*") {
      values.push_back(value);
      keywords.push_back(expression.keywords[i]);
      places.push_back(argument.position);
      continue;
    }
    for (Value& item : Items(value, argument.position)) {
      values.push_back(std::move(item));
      keywords.emplace_back();
      places.push_back(argument.position);
    }
  }
  return CallValue(callee, std::move(values), std::move(keywords), places, expression.position);
}

std::vector<Value> Elaborator::Items(const Value& value, Position position) {
  switch (value.kind) {
    case ValueKind::kTuple:
      return *value.items;
    case ValueKind::kList:
      return *heap_[value.object].items;
    case ValueKind::kDict:
      return *heap_[value.object].keys;
    case ValueKind::kBatchSize:
    case ValueKind::kTensor:
      break;
    default:
      Fail("loop", position, "this cannot be gone through: " + Describe(value));
  }
  if (value.Is(ValueKind::kBatchSize) || value.tensor->shape.empty() ||
      RunsOverEnvironments(value.tensor->shape[0])) {
    Fail("loop", position,
         value.Is(ValueKind::kTensor) && value.tensor->shape.empty()
             ? "a scalar has no elements to go through"
             : "a loop over the environments is not needed: every operation works on all of them "
               "at once");
  }
  std::vector<Value> items;
  for (int i = 0; i < value.tensor->shape[0]; ++i) {
    items.push_back(TensorValue(math_.Take(*value.tensor, 0, i, position)));
  }
  return items;
}

}  // namespace simwright::reward
