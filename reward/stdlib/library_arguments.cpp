#include "reward/stdlib/library_arguments.h"

#include <algorithm>

namespace simwright::reward {

bool WantsTensors(const Arguments& arguments) {
  return arguments.called.starts_with("torch.");
}

Tensor TensorArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i) {
  const Value& value = arguments[i];
  if (WantsTensors(arguments) && (value.IsNumber() || value.Is(ValueKind::kBatchSize) ||
                                  value.Is(ValueKind::kList) || value.Is(ValueKind::kTuple))) {
    Fail("type", arguments.Place(i),
         "'" + arguments.called + "' takes a tensor, this is " + Describe(value) +
             "; wrap it in torch.tensor(...)");
  }
  return NumberOrTensor(elaborator, arguments, i);
}

Tensor NumberOrTensor(Elaborator& elaborator, const Arguments& arguments, std::size_t i) {
  const Value& value = arguments[i];
  if (value.Is(ValueKind::kList) || value.Is(ValueKind::kTuple)) {
    return ArrayFrom(elaborator, value, arguments.Place(i));
  }
  if (value.Is(ValueKind::kTensor) || value.IsNumber() || value.Is(ValueKind::kBatchSize) ||
      value.Is(ValueKind::kUndefined)) {
    return elaborator.math().FromValue(value, arguments.Place(i));
  }
  Fail("type", arguments.Place(i),
       "'" + arguments.called + "' takes a tensor, this is " + Describe(value));
}

Tensor FloatArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i) {
  return elaborator.math().Cast(TensorArgument(elaborator, arguments, i), DataType::kFloat,
                                arguments.Place(i));
}

Tensor ArrayFrom(Elaborator& elaborator, const Value& value, Position position) {
  TensorMath& math = elaborator.math();
  elaborator.Step(position);
  if (!value.Is(ValueKind::kList) && !value.Is(ValueKind::kTuple)) {
    return math.FromValue(value, position);
  }
  std::vector<Tensor> parts;
  for (const Value& item : elaborator.Items(value, position)) {
    parts.push_back(ArrayFrom(elaborator, item, position));
  }
  if (parts.empty()) return math.Make(DataType::kFloat, {0}, {}, position);
  const Shape shape = parts[0].shape;
  for (Tensor& part : parts) {
    if (part.shape != shape) {
      Fail("shape", position,
           "the elements have different shapes, " + ShapeText(shape) + " and " +
               ShapeText(part.shape));
    }
    part = math.Unsqueeze(part, 0);
  }
  return math.Concatenate(parts, 0, position);
}

std::int64_t IntegerArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i) {
  const Value& value = arguments[i];
  if (value.Is(ValueKind::kInteger) || value.Is(ValueKind::kBool)) return value.integer;
  if (value.Is(ValueKind::kUndefined)) elaborator.math().FromValue(value, arguments.Place(i));
  Fail("arguments", arguments.Place(i),
       "'" + arguments.called + "' wants a whole number here, this is " + Describe(value));
}

double NumberArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i) {
  const Value& value = arguments[i];
  if (value.IsNumber()) return value.Number();
  float known = 0.0f;
  if (value.Is(ValueKind::kTensor) && value.tensor->lanes.size() == 1 &&
      elaborator.graph().IsConstant(elaborator.math().At(*value.tensor, 0), &known)) {
    return known;
  }
  if (value.Is(ValueKind::kUndefined)) elaborator.math().FromValue(value, arguments.Place(i));
  Fail("arguments", arguments.Place(i),
       "'" + arguments.called + "' wants a number here, this is " + Describe(value));
}

bool FlagArgument(const Arguments& arguments, std::size_t i) {
  const Value& value = arguments[i];
  if (value.IsNumber()) return value.Number() != 0.0;
  if (value.Is(ValueKind::kNone)) return false;
  Fail("arguments", arguments.Place(i),
       "'" + arguments.called + "' wants True or False here, this is " + Describe(value));
}

std::vector<int> Dimensions(Elaborator& elaborator, const Arguments& arguments, std::size_t i,
                            const Tensor& tensor) {
  const std::size_t rank = tensor.shape.size();
  std::vector<int> dimensions;
  const Value& value = arguments[i];
  if (value.Is(ValueKind::kNone)) {
    for (std::size_t d = 0; d < rank; ++d) dimensions.push_back(static_cast<int>(d));
    return dimensions;
  }
  std::vector<Value> given = {value};
  if (value.Is(ValueKind::kTuple) || value.Is(ValueKind::kList)) {
    given = elaborator.Items(value, arguments.Place(i));
  }
  for (const Value& one : given) {
    if (!one.Is(ValueKind::kInteger)) {
      Fail("arguments", arguments.Place(i),
           "a dimension is a whole number, this is " + Describe(one));
    }
    // Torch accepts a scalar as a vector of size one here.
    if (rank == 0 && (one.integer == 0 || one.integer == -1)) continue;
    const int dimension = elaborator.math().Dimension(one.integer, rank, arguments.Place(i));
    if (std::find(dimensions.begin(), dimensions.end(), dimension) != dimensions.end()) {
      Fail("dimension", arguments.Place(i),
           "dimension " + std::to_string(dimension) + " is named twice");
    }
    dimensions.push_back(dimension);
  }
  std::sort(dimensions.begin(), dimensions.end());
  return dimensions;
}

std::vector<std::int64_t> Sizes(Elaborator& elaborator, const Value& value, Position position) {
  std::vector<Value> given = {value};
  if (value.Is(ValueKind::kTuple) || value.Is(ValueKind::kList)) {
    given = elaborator.Items(value, position);
    if (given.size() == 1 && (given[0].Is(ValueKind::kTuple) || given[0].Is(ValueKind::kList))) {
      given = elaborator.Items(given[0], position);
    }
  }
  std::vector<std::int64_t> sizes;
  for (const Value& one : given) {
    if (one.Is(ValueKind::kBatchSize)) {
      sizes.push_back(TensorMath::kKnownBatch);
    } else if (one.Is(ValueKind::kInteger) && one.integer >= -1 && one.integer < (1 << 30)) {
      sizes.push_back(one.integer);
    } else {
      if (one.Is(ValueKind::kUndefined)) elaborator.math().FromValue(one, position);
      Fail("arguments", position, "a size is a whole number, this is " + Describe(one));
    }
  }
  return sizes;
}

Shape ShapeFrom(const std::vector<std::int64_t>& sizes, Position position) {
  Shape shape;
  for (const std::int64_t size : sizes) {
    if (size == -1) Fail("shape", position, "a size of -1 is not possible here");
    shape.push_back(size == TensorMath::kKnownBatch ? kBatch : static_cast<int>(size));
  }
  return shape;
}

DataType TypeArgument(const Arguments& arguments, std::size_t i, DataType otherwise) {
  const Value& value = arguments[i];
  if (value.Is(ValueKind::kType)) return static_cast<DataType>(value.integer);
  if (value.Is(ValueKind::kNone) || value.Is(ValueKind::kOpaque)) return otherwise;
  if (value.Is(ValueKind::kLibrary)) {  // Python's own float, int and bool
    if (value.text == "float") return DataType::kFloat;
    if (value.text == "int") return DataType::kInteger;
    if (value.text == "bool") return DataType::kBool;
  }
  Fail("arguments", arguments.Place(i),
       "a type such as torch.float32 is wanted here, this is " + Describe(value));
}

Value NamedTuple(std::vector<Value> items, std::vector<std::string> names) {
  Value tuple = TupleValue(std::move(items));
  tuple.field_names = std::make_shared<const std::vector<std::string>>(std::move(names));
  return tuple;
}

}  // namespace simwright::reward
