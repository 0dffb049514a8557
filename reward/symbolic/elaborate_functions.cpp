// Functions of the program: their calls, and functions defined inside others.
#include <algorithm>

#include "reward/frontend/spelling.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {

// Defines a function inside another: its default arguments are evaluated now, variables of the
// enclosing function when it is called.
void Elaborator::DefineInside(const Statement& statement) {
  const Function& function = *statement.function;
  Value value = PlainValue(ValueKind::kFunction, function.name);
  value.function = &function;
  auto closure = std::make_shared<Closure>();
  closure->frame = frame_->number;
  for (const Parameter& parameter : function.parameters) {
    closure->initials.push_back(parameter.initial == nullptr ? Value{}
                                                             : Evaluate(*parameter.initial));
  }
  value.closure = std::move(closure);
  AssignName(function.name, value, function.position);
}

// Returns the value of `name` in the enclosing functions, the innermost first; null if there is
// none. Branches run on copies of a frame, so frames are identified by number, and the newest one
// counts.
const Value* Elaborator::EnclosingValue(const std::string& name, Position position) const {
  const Frame* frame = frame_;
  while (frame->closure != nullptr) {
    const int wanted = frame->closure->frame;
    const Frame* around = frame->caller;
    while (around != nullptr && around->number != wanted) around = around->caller;
    if (around == nullptr) {
      Fail("nested-function", position,
           "'" + frame->function->name +
               "' is called after the function around it has ended, so nothing is called '" + name +
               "' any more; hand the value over as an argument");
    }
    const auto found = around->names.find(name);
    if (found != around->names.end()) return &found->second;
    frame = around;
  }
  return nullptr;
}

Value Elaborator::GlobalValue(const Expression& expression) {
  Frame* const frame = frame_;
  frame_ = nullptr;
  try {
    const Value value = Evaluate(expression);
    frame_ = frame;
    return value;
  } catch (const Fault&) {
    frame_ = frame;
    throw;
  }
}

void Elaborator::Delete(const Expression& target) {
  if (target.kind == ExpressionKind::kName) {
    Evaluate(target);
    frame_->names[target.text] =
        PlainValue(ValueKind::kUndefined, "'" + target.text + "' was deleted in line " +
                                              std::to_string(target.position.line));
    return;
  }
  if (target.kind == ExpressionKind::kSubscript) {
    const Value base = Evaluate(*target.children[0]);
    if (base.Is(ValueKind::kDict)) {
      RemoveKey(base, Evaluate(*target.children[1]), target.position);
      return;
    }
  }
  Fail("bad-target", target.position, "names and a dictionary's keys can be deleted, this cannot");
}

Value Elaborator::Call(const Function& function, const std::shared_ptr<const Closure>& closure,
                       const std::vector<Value>& values, const std::vector<std::string>& keywords,
                       Position position) {
  if (std::find(calls_.begin(), calls_.end(), &function) != calls_.end()) {
    Fail("recursion", position,
         "'" + function.name + "' calls itself; recursion is not part of the language");
  }
  if (static_cast<int>(calls_.size()) >= options_.max_call_depth) {
    Fail("too-deep", position,
         "functions call each other deeper than " + std::to_string(options_.max_call_depth));
  }
  Frame frame;
  frame.function = &function;
  frame.number = ++frames_;
  frame.closure = closure;
  BindParameters(function, values, keywords, position, &frame);
  Frame* const caller = frame_;
  frame.caller = caller;
  const Position returned_at = returned_at_;
  frame_ = &frame;
  calls_.push_back(&function);
  const auto leave = [&] {
    calls_.pop_back();
    frame_ = caller;
  };
  Value result;
  try {
    const Flow flow = Execute(function.body);
    result = Finish(&frame, flow, function.position);
  } catch (const Fault&) {
    leave();
    throw;
  }
  leave();
  if (caller != nullptr) returned_at_ = returned_at;
  return result;
}

void Elaborator::BindParameters(const Function& function, const std::vector<Value>& values,
                                const std::vector<std::string>& keywords, Position position,
                                Frame* frame) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::string name = keywords[i];
    if (name.empty()) {
      if (next >= function.parameters.size()) {
        Fail("arguments", position,
             "'" + function.name + "' takes " + std::to_string(function.parameters.size()) +
                 " arguments, more are given");
      }
      name = function.parameters[next++].name;
    }
    const bool known =
        std::any_of(function.parameters.begin(), function.parameters.end(),
                    [&](const Parameter& parameter) { return parameter.name == name; });
    if (!known || frame->names.contains(name)) {
      Fail("arguments", position,
           "'" + function.name + "' " +
               (known ? "is given '" + name + "' twice" : "has no parameter '" + name + "'"));
    }
    frame->names[name] = values[i];
  }
  for (std::size_t i = 0; i < function.parameters.size(); ++i) {
    const Parameter& parameter = function.parameters[i];
    if (frame->names.contains(parameter.name)) continue;
    if (parameter.initial == nullptr) {
      Fail("arguments", position,
           "'" + function.name + "' lacks its argument '" + parameter.name + "'");
    }
    frame->names[parameter.name] =
        frame->closure != nullptr ? frame->closure->initials[i] : GlobalValue(*parameter.initial);
  }
}

// Returns the value of a function whose environments may have returned at different places.
Value Elaborator::Finish(Frame* frame, Flow flow, Position position) {
  if (flow == Flow::kBreak || flow == Flow::kContinue) {
    Fail("syntax", position, "'break' or 'continue' stands outside a loop");
  }
  if (flow != Flow::kReturn && !frame->early.empty()) {
    Fail("no-return", position,
         "'" + frame->function->name + "' returns in some environments only; end it with a return");
  }
  if (flow != Flow::kReturn) return Value{};
  Value result = frame->result;
  for (std::size_t i = frame->early.size(); i-- > 0;) {
    result = Choose(frame->early[i].flag, frame->early[i].value, result, returned_at_);
  }
  return result;
}

}  // namespace simwright::reward
