#include <algorithm>
#include <cstdlib>

#include "reward/frontend/foreign_names.h"
#include "reward/frontend/spelling.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

struct ParameterText {
  std::string name;
  std::string initial;  // empty: required
  bool rest = false;    // takes all remaining arguments
};

std::vector<ParameterText> SplitParameters(std::string_view text) {
  std::vector<ParameterText> parameters;
  while (!text.empty()) {
    const std::size_t blank = text.find(' ');
    const std::string_view word = text.substr(0, blank);
    text = blank == std::string_view::npos ? "" : text.substr(blank + 1);
    const std::size_t equal = word.find('=');
    ParameterText parameter;
    parameter.name = std::string(word.substr(0, equal));
    if (equal != std::string_view::npos) parameter.initial = std::string(word.substr(equal + 1));
    if (parameter.name[0] == '*') {
      parameter.rest = true;
      parameter.name.erase(0, 1);
    }
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

Value Initial(const std::string& text) {
  if (text == "True" || text == "False") return BoolValue(text == "True");
  if (text.empty() || text == "None") return Value{};
  if (text.find('.') == std::string::npos && text.find('e') == std::string::npos) {
    return IntegerValue(std::atoll(text.c_str()));
  }
  return FloatValue(std::strtod(text.c_str(), nullptr));
}

// Returns true if a keyword is numpy's name of torch's argument, or vice versa.
bool SameParameter(const std::string& parameter, const std::string& keyword, bool first) {
  if (parameter == keyword) return true;
  if (keyword == "axis" || keyword == "axes") return parameter == "dim" || parameter == "dims";
  if (keyword == "dim") return parameter == "dims";
  if (keyword == "keepdims") return parameter == "keepdim";
  if (keyword == "a_min") return parameter == "min";
  if (keyword == "a_max") return parameter == "max";
  if (keyword == "x1" || keyword == "arrays" || keyword == "tensors") return first;
  if (keyword == "x2") return parameter == "other";
  if (keyword == "ord") return parameter == "p";
  return first && (keyword == "a" || keyword == "x" || keyword == "input" || keyword == "self");
}

bool ChangesNothing(const std::string& keyword) {
  return keyword == "device" || keyword == "requires_grad" || keyword == "non_blocking" ||
         keyword == "memory_format" || keyword == "copy" || keyword == "layout" ||
         keyword == "pin_memory" || keyword == "dtype";
}

std::string Listed(const std::vector<ParameterText>& parameters) {
  std::string text;
  for (const ParameterText& parameter : parameters) {
    text += (text.empty() ? "" : ", ") + parameter.name;
  }
  return text;
}

class Binder {
 public:
  Binder(const LibraryFunction& function, const std::string& called, Position position)
      : parameters_(SplitParameters(function.parameters)) {
    arguments_.function = &function;
    arguments_.called = called;
    arguments_.position = position;
    const std::size_t count = parameters_.size();
    arguments_.values.resize(count);
    arguments_.places.assign(count, position);
    arguments_.given.assign(count, false);
  }

  void Positional(const Value& value, Position place) {
    if (next_ < parameters_.size() && parameters_[next_].rest) {
      rest_.push_back(value);
      if (!arguments_.given[next_]) Set(next_, Value{}, place);
      return;
    }
    if (next_ >= parameters_.size()) {
      Fail("arguments", place,
           "'" + arguments_.called + "' takes at most " + std::to_string(parameters_.size()) +
               " arguments (" + Listed(parameters_) + ")");
    }
    Set(next_++, value, place);
  }

  void Keyword(const std::string& keyword, const Value& value, Position place) {
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      if (!SameParameter(parameters_[i].name, keyword, i == 0)) continue;
      if (arguments_.given[i]) {
        Fail("arguments", place, "'" + arguments_.called + "' is given '" + keyword + "' twice");
      }
      if (parameters_[i].rest) rest_ = {value};
      Set(i, value, place);
      return;
    }
    if (ChangesNothing(keyword)) return;
    std::vector<std::string> names;
    for (const ParameterText& parameter : parameters_) names.push_back(parameter.name);
    Fail("arguments", place,
         "'" + arguments_.called + "' has no argument '" + keyword + "'" +
             Suggestion(keyword, names));
  }

  Arguments Finish() {
    std::size_t required = 0;
    for (const ParameterText& parameter : parameters_) {
      if (parameter.initial.empty() && !parameter.rest) ++required;
    }
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const ParameterText& parameter = parameters_[i];
      if (parameter.rest) {
        arguments_.values[i] = TupleValue(rest_);
      } else if (!arguments_.given[i] && parameter.initial.empty()) {
        const auto given = std::count(arguments_.given.begin(), arguments_.given.end(), true);
        Fail("arguments", arguments_.position,
             "'" + arguments_.called + "' wants " + std::to_string(required) +
                 (required == 1 ? " argument (" : " arguments (") + Listed(parameters_) + "), " +
                 std::to_string(given) + (given == 1 ? " is" : " are") + " given: '" +
                 parameter.name + "' is missing");
      } else if (!arguments_.given[i]) {
        arguments_.values[i] = Initial(parameter.initial);
      }
    }
    return std::move(arguments_);
  }

 private:
  void Set(std::size_t i, const Value& value, Position place) {
    arguments_.values[i] = value;
    arguments_.places[i] = place;
    arguments_.given[i] = true;
  }

  std::vector<ParameterText> parameters_;
  Arguments arguments_;
  std::vector<Value> rest_;
  std::size_t next_ = 0;
};

}  // namespace

Value Elaborator::CallValue(const Value& callee, std::vector<Value> values,
                            std::vector<std::string> keywords, const std::vector<Position>& places,
                            Position position) {
  if (callee.Is(ValueKind::kApi)) return CallApi(callee, values, keywords, places, position);
  if (callee.Is(ValueKind::kFunction)) {
    if (callee.items != nullptr) {  // a method of the environment, whose first argument is the
                                    // environment
      values.insert(values.begin(), callee.items->begin(), callee.items->end());
      keywords.insert(keywords.begin(), callee.items->size(), "");
    }
    return Call(*callee.function, callee.closure, values, keywords, position);
  }
  if (callee.Is(ValueKind::kType) && values.size() == 1) {  // np.float32(x)
    const Tensor tensor = math_.FromValue(values[0], places[0]);
    return TensorValue(math_.Cast(tensor, static_cast<DataType>(callee.integer), position));
  }
  if (callee.Is(ValueKind::kOpaque)) {
    if (callee.text == "device") return callee;
    if (callee.text == "SceneEntityCfg" && !values.empty() && values[0].Is(ValueKind::kString)) {
      return PlainValue(ValueKind::kOpaque, std::string(kEntityPrefix) + values[0].text);
    }
    Fail(
        "undefined", position,
        "'" + callee.text + "' is not known here; only torch, numpy, math and the environment are");
  }
  if (!callee.Is(ValueKind::kLibrary)) {
    Fail("not-a-function", position, "this is no function but " + Describe(callee));
  }
  if (callee.text == "dict" && callee.items == nullptr)
    return NamedDict(values, keywords, position);
  Binder binder(*callee.library, callee.text, position);
  if (callee.items != nullptr) binder.Positional((*callee.items)[0], position);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (keywords[i].empty())
      binder.Positional(values[i], places[i]);
    else
      binder.Keyword(keywords[i], values[i], places[i]);
  }
  const Value result = callee.library->handler(*this, binder.Finish());
  const bool in_place = callee.items != nullptr && callee.text.ends_with('_') &&
                        (*callee.items)[0].Is(ValueKind::kTensor) &&
                        !std::string_view(callee.library->names).ends_with('_');
  return in_place ? WriteInPlace((*callee.items)[0], result, position) : result;
}

// Implements x.add_(y): writes the result of x.add(y) into x.
Value Elaborator::WriteInPlace(const Value& target, const Value& result, Position position) {
  if (!result.Is(ValueKind::kTensor)) {
    Fail("type", position, "this changes no tensor in place: it gives " + Describe(result));
  }
  CheckFits(*target.tensor, *result.tensor, position);
  math_.Write(*target.tensor, math_.Nodes(*result.tensor));
  return target;
}

// Implements dict(other, name=value, ...).
Value Elaborator::NamedDict(const std::vector<Value>& values,
                            const std::vector<std::string>& keywords, Position position) {
  const LibraryFunction& function = *FindLibraryFunction("dict");
  Binder binder(function, "dict", position);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (keywords[i].empty()) binder.Positional(values[i], position);
  }
  const Value dict = function.handler(*this, binder.Finish());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!keywords[i].empty()) SetKey(dict, StringValue(keywords[i]), values[i], position);
  }
  return dict;
}

}  // namespace simwright::reward
