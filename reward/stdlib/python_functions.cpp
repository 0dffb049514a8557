// Python's built-in functions, and the methods of lists, dictionaries and numbers.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

Value SequenceLength(Elaborator& elaborator, const Arguments& arguments) {
  const Value& value = arguments[0];
  if (value.Is(ValueKind::kString)) {
    return IntegerValue(static_cast<std::int64_t>(value.text.size()));
  }
  if (value.Is(ValueKind::kTensor) && !value.tensor->shape.empty() &&
      RunsOverEnvironments(value.tensor->shape[0])) {
    return elaborator.SizeValue(value.tensor->shape[0]);
  }
  return IntegerValue(
      static_cast<std::int64_t>(elaborator.Items(value, arguments.Place(0)).size()));
}

Value Range(Elaborator& elaborator, const Arguments& arguments) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!arguments[i].Is(ValueKind::kBatchSize)) continue;
    Fail("loop", arguments.Place(i),
         "a loop over the environments is not needed: every operation works on all of them at "
         "once");
  }
  std::int64_t start = 0, stop = IntegerArgument(elaborator, arguments, 0), step = 1;
  if (arguments.given[1]) {
    start = stop;
    stop = IntegerArgument(elaborator, arguments, 1);
  }
  if (arguments.given[2]) step = IntegerArgument(elaborator, arguments, 2);
  if (step == 0) Fail("arguments", arguments.Place(2), "the step of a range cannot be 0");
  std::vector<Value> items;
  for (std::int64_t i = start; step > 0 ? i < stop : i > stop;) {
    elaborator.Step(arguments.position);
    items.push_back(IntegerValue(i));
    if (__builtin_add_overflow(i, step, &i)) break;
  }
  return TupleValue(std::move(items));
}

// Returns the minimum or maximum of values, per environment.
Value PythonExtreme(Elaborator& elaborator, const Arguments& arguments) {
  const bool largest = arguments.function->variant == 1;
  std::vector<Value> values = *arguments[0].items;
  if (values.size() == 1) values = elaborator.Items(values[0], arguments.position);
  if (values.empty()) Fail("arguments", arguments.position, "there is nothing to choose from");
  Value best = values[0];
  for (std::size_t i = 1; i < values.size(); ++i) {
    const Value better = elaborator.Compare(largest ? Operator::kGreater : Operator::kLess,
                                            values[i], best, arguments.position);
    Tensor flag;
    const int truth = elaborator.Truth(better, &flag, arguments.position);
    if (truth < 0) best = elaborator.Choose(flag, values[i], best, arguments.position);
    if (truth == 1) best = values[i];
  }
  return best;
}

Value Sum(Elaborator& elaborator, const Arguments& arguments) {
  const Value& value = arguments[0];
  if (value.Is(ValueKind::kTensor) && !value.tensor->shape.empty() &&
      RunsOverEnvironments(value.tensor->shape[0])) {
    return TensorValue(
        elaborator.math().Reduce(Reduction::kSum, *value.tensor, {0}, false, arguments.position));
  }
  Value total = arguments[1];
  for (const Value& item : elaborator.Items(value, arguments.Place(0))) {
    total = elaborator.Binary(Operator::kAdd, total, item, arguments.position);
  }
  return total;
}

// Implements any (variant 1) and all.
Value Quantifier(Elaborator& elaborator, const Arguments& arguments) {
  const bool any = arguments.function->variant == 1;
  Value result = BoolValue(!any);
  for (const Value& item : elaborator.Items(arguments[0], arguments.Place(0))) {
    Tensor flag;
    const int truth = elaborator.Truth(item, &flag, arguments.position);
    const Value one = truth < 0 ? TensorValue(flag) : BoolValue(truth == 1);
    result =
        elaborator.Binary(any ? Operator::kOr : Operator::kAnd, result, one, arguments.position);
  }
  return result;
}

// Implements float(x), int(x) and bool(x) of a number, a string such as "inf", or a scalar tensor.
Value Convert(Elaborator& elaborator, const Arguments& arguments) {
  const auto type = static_cast<DataType>(arguments.function->variant);
  const Value& value = arguments[0];
  double number = value.Number();
  if (value.Is(ValueKind::kString) && type == DataType::kFloat) {
    char* end = nullptr;
    number = std::strtod(value.text.c_str(), &end);
    if (value.text.empty() || *end != '\0') {
      Fail("bad-number", arguments.Place(0), "'" + value.text.substr(0, 40) + "' is no number");
    }
  } else if (!value.IsNumber()) {
    const Tensor tensor = elaborator.math().FromValue(value, arguments.Place(0));
    if (tensor.lanes.size() != 1) {
      Fail("type", arguments.Place(0),
           "'" + arguments.called + "' takes one number, this is a tensor " +
               ShapeText(tensor.shape));
    }
    return TensorValue(elaborator.math().Cast(tensor, type, arguments.position));
  }
  if (type == DataType::kFloat) return FloatValue(number);
  if (type == DataType::kBool) return BoolValue(number != 0.0);
  if (!(std::fabs(number) < 9e18)) {
    Fail("bad-number", arguments.Place(0), "this number is too large to be a whole one");
  }
  return value.Is(ValueKind::kFloat) ? IntegerValue(static_cast<std::int64_t>(number))
                                     : IntegerValue(value.integer);
}

Value Round(Elaborator& elaborator, const Arguments& arguments) {
  if (arguments[0].IsNumber()) {
    const double scale = std::pow(10.0, NumberArgument(elaborator, arguments, 1));
    const double rounded = std::nearbyint(arguments[0].Number() * scale) / scale;
    if (!arguments.given[1] && std::fabs(rounded) < 9e18) {
      return IntegerValue(static_cast<std::int64_t>(rounded));
    }
    return FloatValue(rounded);
  }
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  return TensorValue(
      elaborator.math().Map(ScalarOperation::kRound, tensor, tensor.type, arguments.position));
}

Value Enumerate(Elaborator& elaborator, const Arguments& arguments) {
  std::int64_t number = IntegerArgument(elaborator, arguments, 1);
  std::vector<Value> pairs;
  for (const Value& item : elaborator.Items(arguments[0], arguments.Place(0))) {
    pairs.push_back(TupleValue({IntegerValue(number++), item}));
  }
  return TupleValue(std::move(pairs));
}

Value Zip(Elaborator& elaborator, const Arguments& arguments) {
  std::vector<std::vector<Value>> columns;
  std::size_t count = 0;
  for (const Value& value : *arguments[0].items) {
    columns.push_back(elaborator.Items(value, arguments.position));
    count = columns.size() == 1 ? columns[0].size() : std::min(count, columns.back().size());
  }
  std::vector<Value> rows;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<Value> row;
    for (const auto& column : columns) row.push_back(column[i]);
    rows.push_back(TupleValue(std::move(row)));
  }
  return TupleValue(std::move(rows));
}

Value MakeList(Elaborator& elaborator, const Arguments& arguments) {
  std::vector<Value> items;
  if (arguments.given[0]) items = elaborator.Items(arguments[0], arguments.Place(0));
  return arguments.function->variant == 1 ? TupleValue(std::move(items))
                                          : elaborator.NewList(std::move(items));
}

// Implements dict() and dict(other); dict(name=value) is handled with the calls
// (elaborate_calls.cpp).
Value MakeDict(Elaborator& elaborator, const Arguments& arguments) {
  const Value dict = elaborator.NewDict({}, {});
  if (!arguments.given[0]) return dict;
  if (arguments[0].Is(ValueKind::kDict)) {
    elaborator.Update(dict, arguments[0], arguments.Place(0));
    return dict;
  }
  for (const Value& pair : elaborator.Items(arguments[0], arguments.Place(0))) {
    const std::vector<Value> both = elaborator.Items(pair, arguments.Place(0));
    if (both.size() != 2) {
      Fail("arguments", arguments.Place(0), "'dict' is made of pairs, a key and a value each");
    }
    elaborator.SetKey(dict, both[0], both[1], arguments.Place(0));
  }
  return dict;
}

Value DictUpdate(Elaborator& elaborator, const Arguments& arguments) {
  if (arguments[1].Is(ValueKind::kDict)) {
    const Object other = elaborator.math().heap()[arguments[1].object];
    if (std::any_of(other.items->begin(), other.items->end(),
                    [](const Value& value) { return HoldsContainer(value); })) {
      Fail("type", arguments.Place(1), "a list or dictionary inside another cannot be set here");
    }
  }
  elaborator.Update(arguments[0], arguments[1], arguments.Place(1));
  return Value{};
}

Value DictPop(Elaborator& elaborator, const Arguments& arguments) {
  const Object dict = elaborator.math().heap()[arguments[0].object];
  for (const Value& key : *dict.keys) {
    if (key.kind == arguments[1].kind && key.text == arguments[1].text &&
        key.integer == arguments[1].integer) {
      return elaborator.RemoveKey(arguments[0], arguments[1], arguments.position);
    }
  }
  if (!arguments.given[2]) elaborator.Subscript(arguments[0], arguments[1], arguments.position);
  return arguments[2];
}

// Implements dict.copy and list.copy.
Value CopyObject(Elaborator& elaborator, const Arguments& arguments) {
  const Object object = elaborator.math().heap()[arguments[0].object];
  return arguments[0].Is(ValueKind::kDict) ? elaborator.NewDict(*object.keys, *object.items)
                                           : elaborator.NewList(*object.items);
}

Value Reversed(Elaborator& elaborator, const Arguments& arguments) {
  std::vector<Value> items = elaborator.Items(arguments[0], arguments.Place(0));
  std::reverse(items.begin(), items.end());
  return TupleValue(std::move(items));
}

// Sorts strings or constant numbers; for numbers that differ between environments there is
// torch.sort.
Value Sorted(Elaborator& elaborator, const Arguments& arguments) {
  std::vector<Value> items = elaborator.Items(arguments[0], arguments.Place(0));
  const bool texts = !items.empty() && items[0].Is(ValueKind::kString);
  for (const Value& item : items) {
    if (texts ? item.Is(ValueKind::kString) : item.IsNumber()) continue;
    Fail("type", arguments.Place(0),
         "strings or numbers are sorted here, one of these is " + Describe(item) +
             "; of tensors use torch.sort");
  }
  std::stable_sort(items.begin(), items.end(), [&](const Value& a, const Value& b) {
    return texts ? a.text < b.text : a.Number() < b.Number();
  });
  if (FlagArgument(arguments, 1)) std::reverse(items.begin(), items.end());
  return elaborator.NewList(std::move(items));
}

bool IsInstanceOf(const Value& value, const Value& type, const Arguments& arguments) {
  const std::string& name = type.text;
  const bool tensor = value.Is(ValueKind::kTensor);
  if (type.Is(ValueKind::kOpaque) && (name == "Tensor" || name == "ndarray")) return tensor;
  if (type.Is(ValueKind::kLibrary)) {
    if (name == "float") return value.Is(ValueKind::kFloat);
    if (name == "int") return value.Is(ValueKind::kInteger) || value.Is(ValueKind::kBool);
    if (name == "bool") return value.Is(ValueKind::kBool);
    if (name == "str") return value.Is(ValueKind::kString);
    if (name == "list") return value.Is(ValueKind::kList);
    if (name == "tuple") return value.Is(ValueKind::kTuple);
    if (name == "dict") return value.Is(ValueKind::kDict);
  }
  Fail("arguments", arguments.Place(1),
       "'isinstance' knows torch.Tensor, float, int, bool, str, list, tuple and dict, this is " +
           Describe(type));
}

Value IsInstance(Elaborator& elaborator, const Arguments& arguments) {
  std::vector<Value> types = {arguments[1]};
  if (arguments[1].Is(ValueKind::kTuple)) {
    types = elaborator.Items(arguments[1], arguments.Place(1));
  }
  if (arguments[0].Is(ValueKind::kUndefined)) {
    elaborator.math().FromValue(arguments[0], arguments.Place(0));
  }
  bool found = false;
  for (const Value& type : types) found = IsInstanceOf(arguments[0], type, arguments) || found;
  return BoolValue(found);
}

Value IsTensor(Elaborator&, const Arguments& arguments) {
  return BoolValue(arguments[0].Is(ValueKind::kTensor));
}

// Implements list.append and list.extend (variant 1).
Value Append(Elaborator& elaborator, const Arguments& arguments) {
  Heap& heap = elaborator.math().heap();
  std::vector<Value> items = *heap[arguments[0].object].items;
  std::vector<Value> added = {arguments[1]};
  if (arguments.function->variant == 1) {
    added = elaborator.Items(arguments[1], arguments.Place(1));
  }
  if (std::any_of(added.begin(), added.end(),
                  [](const Value& value) { return HoldsContainer(value); })) {
    Fail("type", arguments.Place(1), "a list or dictionary inside another cannot be appended");
  }
  for (Value& value : added) items.push_back(std::move(value));
  if (static_cast<int>(items.size()) > elaborator.options().max_lanes) {
    Fail("too-large", arguments.position, "the list grows too long");
  }
  Object fresh;
  fresh.items = std::make_shared<const std::vector<Value>>(std::move(items));
  heap.Set(arguments[0].object, std::move(fresh));
  return Value{};
}

// Implements dict.keys, dict.values (variant 1) and dict.items (variant 2).
Value DictView(Elaborator& elaborator, const Arguments& arguments) {
  const Object dict = elaborator.math().heap()[arguments[0].object];
  if (arguments.function->variant == 0) return TupleValue(*dict.keys);
  if (arguments.function->variant == 1) return TupleValue(*dict.items);
  std::vector<Value> pairs;
  for (std::size_t i = 0; i < dict.keys->size(); ++i) {
    pairs.push_back(TupleValue({(*dict.keys)[i], (*dict.items)[i]}));
  }
  return TupleValue(std::move(pairs));
}

Value DictGet(Elaborator& elaborator, const Arguments& arguments) {
  const Object dict = elaborator.math().heap()[arguments[0].object];
  for (const Value& key : *dict.keys) {
    if (key.kind == arguments[1].kind && key.text == arguments[1].text &&
        key.integer == arguments[1].integer) {
      return elaborator.Subscript(arguments[0], arguments[1], arguments.position);
    }
  }
  return arguments[2];
}

// Implements x.item() of a plain number.
Value Itself(Elaborator&, const Arguments& arguments) {
  return arguments[0];
}

constexpr ScalarOperation kNoPythonOperation = ScalarOperation::kConstant;
constexpr int PythonType(DataType type) {
  return static_cast<int>(type);
}

constexpr LibraryFunction kPythonFunctions[] = {
    {"len", "x", SequenceLength},
    {"range", "start stop=None step=None", Range},
    {"min", "*values", PythonExtreme, kNoPythonOperation, 0},
    {"max", "*values", PythonExtreme, kNoPythonOperation, 1},
    {"sum", "values start=0", Sum},
    {"all", "values", Quantifier, kNoPythonOperation, 0},
    {"any", "values", Quantifier, kNoPythonOperation, 1},
    {"float", "x=0.0", Convert, kNoPythonOperation, PythonType(DataType::kFloat)},
    {"int", "x=0", Convert, kNoPythonOperation, PythonType(DataType::kInteger)},
    {"bool", "x=False", Convert, kNoPythonOperation, PythonType(DataType::kBool)},
    {"round", "x digits=0", Round},
    {"enumerate", "values start=0", Enumerate},
    {"zip", "*values", Zip},
    {"list", "values=None", MakeList, kNoPythonOperation, 0},
    {"tuple", "values=None", MakeList, kNoPythonOperation, 1},
    {"dict", "values=None", MakeDict},
    {"reversed", "values", Reversed},
    {"sorted", "values reverse=False", Sorted},
    {"isinstance", "value type", IsInstance},
    {"torch.is_tensor", "value", IsTensor},
    {"Dict.update", "dict other", DictUpdate},
    {"Dict.pop", "dict key default=None", DictPop},
    {"Dict.copy List.copy", "object", CopyObject},
    {"List.append", "list value", Append, kNoPythonOperation, 0},
    {"List.extend", "list values", Append, kNoPythonOperation, 1},
    {"Dict.keys", "dict", DictView, kNoPythonOperation, 0},
    {"Dict.values", "dict", DictView, kNoPythonOperation, 1},
    {"Dict.items", "dict", DictView, kNoPythonOperation, 2},
    {"Dict.get", "dict key default=None", DictGet},
    {"Number.item Number.float", "x", Itself},
};

}  // namespace

LibraryPart PythonFunctions() {
  return {kPythonFunctions, std::size(kPythonFunctions)};
}

}  // namespace simwright::reward
