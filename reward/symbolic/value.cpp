#include "reward/symbolic/value.h"

#include <algorithm>

namespace simwright::reward {

std::string ShapeText(const Shape& shape) {
  if (shape.empty()) return "a scalar";
  std::string text = "[";
  for (const int size : shape) {
    if (text.size() > 1) text += ", ";
    text += size == kBatch ? "N" : IsSelected(size) ? "M" : std::to_string(size);
  }
  return text + "]";
}

std::int64_t LaneCount(const Shape& shape) {
  std::int64_t count = 1;
  for (const int size : shape) {
    // Far beyond every bound, and far below the limit of 64 bits.
    if (!RunsOverEnvironments(size))
      count = std::min<std::int64_t>(count * size, std::int64_t{1} << 31);
  }
  return count;
}

bool HasSelectedDimension(const Shape& shape) {
  return std::any_of(shape.begin(), shape.end(), IsSelected);
}

int BatchDimension(const Shape& shape) {
  const auto found = std::find(shape.begin(), shape.end(), kBatch);
  return found == shape.end() ? -1 : static_cast<int>(found - shape.begin());
}

DataType Value::NumberType() const {
  if (kind == ValueKind::kTensor) return tensor->type;
  if (kind == ValueKind::kFloat) return DataType::kFloat;
  return kind == ValueKind::kBool ? DataType::kBool : DataType::kInteger;
}

Value PlainValue(ValueKind kind, std::string text) {
  Value value;
  value.kind = kind;
  value.text = std::move(text);
  return value;
}

Value BoolValue(bool truth) {
  Value value = PlainValue(ValueKind::kBool);
  value.integer = truth ? 1 : 0;
  return value;
}

Value IntegerValue(std::int64_t integer) {
  Value value = PlainValue(ValueKind::kInteger);
  value.integer = integer;
  return value;
}

Value FloatValue(double number) {
  Value value = PlainValue(ValueKind::kFloat);
  value.number = number;
  return value;
}

Value StringValue(std::string text) {
  return PlainValue(ValueKind::kString, std::move(text));
}

Value TensorValue(Tensor tensor) {
  Value value = PlainValue(ValueKind::kTensor);
  value.tensor = std::make_shared<const Tensor>(std::move(tensor));
  return value;
}

Value TupleValue(std::vector<Value> items) {
  Value value = PlainValue(ValueKind::kTuple);
  value.items = std::make_shared<const std::vector<Value>>(std::move(items));
  return value;
}

namespace {

// Returns true also if there are too many elements to search.
bool HoldsContainer(const Value& value, int* budget) {
  if (--*budget < 0 || value.Is(ValueKind::kList) || value.Is(ValueKind::kDict)) return true;
  return value.items != nullptr &&
         std::any_of(value.items->begin(), value.items->end(),
                     [&](const Value& item) { return HoldsContainer(item, budget); });
}

}  // namespace

bool HoldsContainer(const Value& value) {
  int budget = 1000;
  return HoldsContainer(value, &budget);
}

std::string Describe(const Value& value) {
  switch (value.kind) {
    case ValueKind::kNone:
      return "None";
    case ValueKind::kBool:
      return value.integer != 0 ? "True" : "False";
    case ValueKind::kInteger:
      return "the number " + std::to_string(value.integer);
    case ValueKind::kFloat:
      return "a number";
    case ValueKind::kString:
      return "the string '" + value.text.substr(0, 40) + "'";
    case ValueKind::kTensor: {
      const char* type = value.tensor->type == DataType::kBool      ? "a bool tensor "
                         : value.tensor->type == DataType::kInteger ? "an integer tensor "
                                                                    : "a tensor ";
      return value.tensor->shape.empty() ? std::string("a scalar tensor")
                                         : type + ShapeText(value.tensor->shape);
    }
    case ValueKind::kTuple:
      return "a tuple of " + std::to_string(value.items->size());
    case ValueKind::kList:
      return "a list";
    case ValueKind::kDict:
      return "a dictionary";
    case ValueKind::kBatchSize:
      return "the number of environments";
    case ValueKind::kSlice:
      return "a slice";
    case ValueKind::kEllipsis:
      return "'...'";
    case ValueKind::kModule:
      return "the module " + value.text;
    case ValueKind::kEnvironment:
      return "the environment";
    case ValueKind::kFunction:
    case ValueKind::kLibrary:
    case ValueKind::kApi:
      return "a function (its call lacks '()')";
    case ValueKind::kType:
      return "a type";
    case ValueKind::kOpaque:
      return "nothing with a value here";
    case ValueKind::kUndefined:
      return "an undefined value";
  }
  return "a value";
}

int Heap::AddStorage(std::vector<NodeId> nodes) {
  Object object;
  object.nodes = std::make_shared<const std::vector<NodeId>>(std::move(nodes));
  objects_.push_back(std::move(object));
  return size() - 1;
}

int Heap::AddList(std::vector<Value> items) {
  Object object;
  object.items = std::make_shared<const std::vector<Value>>(std::move(items));
  objects_.push_back(std::move(object));
  return size() - 1;
}

int Heap::AddDict(std::vector<Value> keys, std::vector<Value> items) {
  const int object = AddList(std::move(items));
  objects_[object].keys = std::make_shared<const std::vector<Value>>(std::move(keys));
  return object;
}

}  // namespace simwright::reward
