#include <cmath>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

bool HoldsRows(Elaborator& elaborator, const Value& value, Position position) {
  elaborator.Step(position);
  if (value.Is(ValueKind::kTensor)) return BatchDimension(value.tensor->shape) >= 0;
  if (!value.Is(ValueKind::kList) && !value.Is(ValueKind::kTuple)) return false;
  for (const Value& item : elaborator.Items(value, position)) {
    if (HoldsRows(elaborator, item, position)) return true;
  }
  return false;
}

// Implements torch.tensor and np.array.
Value FromData(Elaborator& elaborator, const Arguments& arguments) {
  const Value& data = arguments[0];
  const bool list = data.Is(ValueKind::kList) || data.Is(ValueKind::kTuple);
  if (list && WantsTensors(arguments) && HoldsRows(elaborator, data, arguments.Place(0))) {
    Fail("type", arguments.Place(0),
         "'" + arguments.called +
             "' makes a tensor of numbers, but this list holds tensors with "
             "a row an environment; use torch.stack([...], dim=-1)");
  }
  const Tensor tensor = ArrayFrom(elaborator, data, arguments.Place(0));
  const DataType type = TypeArgument(arguments, 1, tensor.type);
  // torch.tensor copies; as_tensor and asarray do not.
  const bool shares = arguments.called.find("as") != std::string::npos && type == tensor.type;
  if (shares) return TensorValue(tensor);
  const Tensor cast = elaborator.math().Cast(tensor, type, arguments.position);
  return TensorValue(elaborator.math().Copy(cast, arguments.position));
}

// Implements torch.zeros, torch.ones and torch.empty.
Value FilledTensor(Elaborator& elaborator, const Arguments& arguments) {
  const Shape shape =
      ShapeFrom(Sizes(elaborator, arguments[0], arguments.Place(0)), arguments.Place(0));
  const NodeId node = elaborator.graph().Constant(arguments.function->variant);
  return TensorValue(elaborator.math().Full(TypeArgument(arguments, 1, DataType::kFloat), shape,
                                            node, arguments.position));
}

Value Full(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Shape shape =
      ShapeFrom(Sizes(elaborator, arguments[0], arguments.Place(0)), arguments.Place(0));
  Tensor value = NumberOrTensor(elaborator, arguments, 1);
  value = math.Cast(value, TypeArgument(arguments, 2, value.type), arguments.position);
  if (!value.shape.empty()) {
    Fail("shape", arguments.Place(1), "the value to fill with is one number");
  }
  return TensorValue(math.Full(value.type, shape, math.At(value, 0), arguments.position));
}

// Implements torch.zeros_like, torch.ones_like and x.new_zeros.
Value FilledLike(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor like = TensorArgument(elaborator, arguments, 0);
  const NodeId node = elaborator.graph().Constant(arguments.function->variant);
  return TensorValue(elaborator.math().Full(TypeArgument(arguments, 1, like.type), like.shape, node,
                                            arguments.position));
}

Value NewFilled(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor like = TensorArgument(elaborator, arguments, 0);
  const Shape shape =
      ShapeFrom(Sizes(elaborator, arguments[1], arguments.Place(1)), arguments.Place(1));
  const NodeId node = elaborator.graph().Constant(arguments.function->variant);
  return TensorValue(elaborator.math().Full(like.type, shape, node, arguments.position));
}

Value FullLike(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor like = TensorArgument(elaborator, arguments, 0);
  const DataType type = TypeArgument(arguments, 2, like.type);
  const Tensor value =
      math.Cast(NumberOrTensor(elaborator, arguments, 1), type, arguments.Place(1));
  if (!value.shape.empty()) {
    Fail("shape", arguments.Place(1), "the value to fill with is one number");
  }
  return TensorValue(math.Full(type, like.shape, math.At(value, 0), arguments.position));
}

Value Arange(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  double start = 0.0, stop = NumberArgument(elaborator, arguments, 0), step = 1.0;
  if (arguments.given[1]) {
    start = stop;
    stop = NumberArgument(elaborator, arguments, 1);
  }
  if (arguments.given[2]) step = NumberArgument(elaborator, arguments, 2);
  const double count = std::ceil((stop - start) / step);
  if (step == 0.0 || !(count >= 0.0)) {
    Fail("arguments", arguments.position, "the step does not lead from start to end");
  }
  if (count > elaborator.options().max_lanes) {
    Fail("too-large", arguments.position, "the range has too many numbers");
  }
  bool whole = true;
  for (const Value& value : arguments.values) {
    whole = whole && !value.Is(ValueKind::kFloat) && !value.Is(ValueKind::kTensor);
  }
  std::vector<NodeId> nodes;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    nodes.push_back(math.graph().Constant(start + step * i));
  }
  const DataType type = TypeArgument(arguments, 3, whole ? DataType::kInteger : DataType::kFloat);
  const int size = static_cast<int>(nodes.size());
  return TensorValue(math.Make(type, {size}, std::move(nodes), arguments.position));
}

Value Linspace(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const double start = NumberArgument(elaborator, arguments, 0);
  const double stop = NumberArgument(elaborator, arguments, 1);
  const std::int64_t count = IntegerArgument(elaborator, arguments, 2);
  if (count < 1 || count > elaborator.options().max_lanes) {
    Fail("too-large", arguments.position, "the number of steps is out of range");
  }
  std::vector<NodeId> nodes;
  for (std::int64_t i = 0; i < count; ++i) {
    const double way = count == 1 ? 0.0 : static_cast<double>(i) / static_cast<double>(count - 1);
    nodes.push_back(math.graph().Constant(start + (stop - start) * way));
  }
  return TensorValue(
      math.Make(DataType::kFloat, {static_cast<int>(count)}, std::move(nodes), arguments.position));
}

Value Eye(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const std::int64_t size = IntegerArgument(elaborator, arguments, 0);
  if (size < 1 || size * size > elaborator.options().max_lanes) {
    Fail("too-large", arguments.position, "the size is out of range");
  }
  std::vector<NodeId> nodes(static_cast<std::size_t>(size * size), math.graph().Constant(0.0));
  for (std::int64_t i = 0; i < size; ++i) {
    nodes[static_cast<std::size_t>(i * (size + 1))] = math.graph().Constant(1.0);
  }
  const int side = static_cast<int>(size);
  return TensorValue(
      math.Make(DataType::kFloat, {side, side}, std::move(nodes), arguments.position));
}

// Implements x.float(), x.int() and x.bool(); variant is the type.
Value CastTo(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const auto type = static_cast<DataType>(arguments.function->variant);
  return TensorValue(elaborator.math().Cast(tensor, type, arguments.position));
}

// Implements x.to(device), x.to(torch.float32), x.type(torch.float32) and x.astype(float).
Value To(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  DataType type = tensor.type;
  for (const Value& value : *arguments[1].items) {
    if (value.Is(ValueKind::kTensor)) {
      type = value.tensor->type;
    } else if (value.Is(ValueKind::kType)) {
      type = static_cast<DataType>(value.integer);
    } else if (value.Is(ValueKind::kLibrary)) {
      type = value.text == "int"    ? DataType::kInteger
             : value.text == "bool" ? DataType::kBool
                                    : DataType::kFloat;
    }  // devices, as strings or not, have no effect
  }
  if (arguments.given[2]) type = TypeArgument(arguments, 2, type);
  return TensorValue(elaborator.math().Cast(tensor, type, arguments.position));
}

// Implements x.detach(), x.cpu() and x.contiguous(): returns the same tensor.
Value SameShape(Elaborator& elaborator, const Arguments& arguments) {
  return TensorValue(TensorArgument(elaborator, arguments, 0));
}

Value Clone(Elaborator& elaborator, const Arguments& arguments) {
  return TensorValue(
      elaborator.math().Copy(TensorArgument(elaborator, arguments, 0), arguments.position));
}

// Implements x.item(): one number, which may differ between environments if the program is written
// for a single environment.
Value Item(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  if (tensor.lanes.size() != 1 || BatchDimension(tensor.shape) >= 0 ||
      HasSelectedDimension(tensor.shape)) {
    Fail("type", arguments.position,
         "'" + arguments.called + "' takes the one number of a scalar, this is a tensor " +
             ShapeText(tensor.shape) + "; work on all environments at once");
  }
  return TensorValue(
      elaborator.math().Make(tensor.type, {}, elaborator.math().Nodes(tensor), arguments.position));
}

// Implements x.fill_(number) and x.zero_().
Value FillInPlace(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  Tensor value = math.Scalar(tensor.type, math.graph().Constant(0.0));
  if (arguments.values.size() > 1) {
    value = math.Cast(NumberOrTensor(elaborator, arguments, 1), tensor.type, arguments.Place(1));
  }
  if (!value.shape.empty()) {
    Fail("shape", arguments.Place(1), "the value to fill with is one number");
  }
  math.Write(tensor, std::vector<NodeId>(tensor.lanes.size(), math.At(value, 0)));
  return arguments[0];
}

Value NewFull(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor like = TensorArgument(elaborator, arguments, 0);
  const Shape shape =
      ShapeFrom(Sizes(elaborator, arguments[1], arguments.Place(1)), arguments.Place(1));
  const Tensor value =
      math.Cast(NumberOrTensor(elaborator, arguments, 2), like.type, arguments.Place(2));
  if (!value.shape.empty()) {
    Fail("shape", arguments.Place(2), "the value to fill with is one number");
  }
  return TensorValue(math.Full(like.type, shape, math.At(value, 0), arguments.position));
}

Value NewTensor(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor like = TensorArgument(elaborator, arguments, 0);
  const Tensor data = ArrayFrom(elaborator, arguments[1], arguments.Place(1));
  return TensorValue(elaborator.math().Copy(
      elaborator.math().Cast(data, like.type, arguments.position), arguments.position));
}

constexpr int CreationType(DataType type) {
  return static_cast<int>(type);
}

constexpr LibraryFunction kCreationFunctions[] = {
    {"torch.tensor torch.as_tensor torch.FloatTensor np.array np.asarray to_torch",
     "data dtype=None", FromData},
    {"torch.zeros torch.empty np.zeros np.empty", "*size dtype=None", FilledTensor,
     ScalarOperation::kConstant, 0},
    {"torch.ones np.ones", "*size dtype=None", FilledTensor, ScalarOperation::kConstant, 1},
    {"torch.full np.full", "size fill_value dtype=None", Full},
    {"torch.zeros_like torch.empty_like np.zeros_like", "input dtype=None", FilledLike,
     ScalarOperation::kConstant, 0},
    {"torch.ones_like np.ones_like", "input dtype=None", FilledLike, ScalarOperation::kConstant, 1},
    {"torch.full_like np.full_like", "input fill_value dtype=None", FullLike},
    {"Tensor.new_zeros", "input *size", NewFilled, ScalarOperation::kConstant, 0},
    {"Tensor.new_ones", "input *size", NewFilled, ScalarOperation::kConstant, 1},
    {"torch.arange np.arange", "start end=None step=None dtype=None", Arange},
    {"torch.linspace np.linspace", "start end steps=50", Linspace},
    {"torch.eye np.eye", "n", Eye},
    {"Tensor.float Tensor.double Tensor.half", "input", CastTo, ScalarOperation::kConstant,
     CreationType(DataType::kFloat)},
    {"Tensor.int Tensor.long", "input", CastTo, ScalarOperation::kConstant,
     CreationType(DataType::kInteger)},
    {"Tensor.bool", "input", CastTo, ScalarOperation::kConstant, CreationType(DataType::kBool)},
    {"Tensor.to Tensor.type Tensor.astype Tensor.type_as", "input *target dtype=None", To},
    {"Tensor.detach Tensor.cpu Tensor.cuda Tensor.numpy Tensor.contiguous Tensor.requires_grad_",
     "input", SameShape},
    {"torch.clone Tensor.clone Tensor.copy np.copy", "input", Clone},
    {"Tensor.item Tensor.tolist", "input", Item},
    {"Tensor.fill_", "input value", FillInPlace},
    {"Tensor.zero_", "input", FillInPlace},
    {"Tensor.new_full", "input size fill_value", NewFull},
    {"Tensor.new_tensor", "input data", NewTensor},
};

}  // namespace

LibraryPart CreationFunctions() {
  return {kCreationFunctions, std::size(kCreationFunctions)};
}

}  // namespace simwright::reward
