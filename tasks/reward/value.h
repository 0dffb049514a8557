#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tasks/reward/graph.h"
#include "tasks/reward/syntax.h"

namespace simwright::tasks::reward {

struct LibraryFunction;

enum class DataType { kBool, kInteger, kFloat };

// The size of a dimension that runs over the environments.
constexpr int kBatch = -1;
using Shape = std::vector<int>;

// The size of a dimension that runs over the environments where a flag is set, x[mask]: equal flags
// give equal sizes, so that only what was picked alike fits together.
constexpr int PickedBy(NodeId flag) {
  return kBatch - 1 - flag;
}
constexpr bool IsPicked(int size) {
  return size < kBatch;
}
constexpr NodeId PickingFlag(int size) {
  return kBatch - 1 - size;
}
// All environments, or those that are picked.
constexpr bool RunsOverEnvironments(int size) {
  return size <= kBatch;
}
bool HoldsPicked(const Shape& shape);

// "[N, 3]"; a scalar is "a scalar", M stands for the environments that a mask picks.
std::string ShapeText(const Shape& shape);

// Numbers an environment of a tensor of this shape: the product of its sizes, N left out.
std::int64_t LaneCount(const Shape& shape);

// The dimension over the environments, or -1.
int BatchDimension(const Shape& shape);

// A view of a storage: lane i (row-major over the shape, N left out) is number lanes[i] there.
// A tensor without a dimension N may still differ between environments: the program is then
// written for one environment (a scalar distance, a position [3]).
struct Tensor {
  DataType type = DataType::kFloat;
  Shape shape;
  int storage = -1;
  std::vector<int> lanes;
};

enum class ValueKind {
  kNone,
  kBool,     // integer
  kInteger,  // integer
  kFloat,    // number
  kString,   // text
  kTensor,
  kTuple,      // items
  kList,       // object
  kDict,       // object
  kBatchSize,  // the number of environments
  kSlice,      // items: start, stop, step
  kEllipsis,
  kModule,       // text: "torch.nn"
  kEnvironment,  // text: as written, "env"
  kFunction,     // of the program: function
  kLibrary,      // library, text: as written; items: the receiver where it is a method
  kApi,          // text: a function of the environment; integer: 1 where called on it
  kType,         // of numbers: integer is a DataType; text
  kOpaque,       // a device, an annotation: harmless, of no use
  kUndefined,    // text: why it cannot be used; empty where reported already
};

struct Value;

// What a function that was defined inside another carries with it.
struct Closure {
  int frame = 0;                // the number of the call that it was defined in
  std::vector<Value> initials;  // of its parameters
};

struct Value {
  ValueKind kind = ValueKind::kNone;
  std::int64_t integer = 0;
  double number = 0.0;
  std::string text;
  std::shared_ptr<const Tensor> tensor;
  std::shared_ptr<const std::vector<Value>> items;
  int object = -1;
  const Function* function = nullptr;
  const LibraryFunction* library = nullptr;
  std::shared_ptr<const Closure> closure;  // of a function inside another
  // An index along a dimension that is not offered is named only where it is used: the second of
  // (values, indices) carries its names.
  std::shared_ptr<const std::vector<std::string>> field_names;

  bool Is(ValueKind wanted) const { return kind == wanted; }
  bool IsNumber() const {
    return kind == ValueKind::kBool || kind == ValueKind::kInteger || kind == ValueKind::kFloat;
  }
  double Number() const {
    return kind == ValueKind::kFloat ? number : static_cast<double>(integer);
  }
  // A number of this type, as an operand of tensors.
  DataType NumberType() const;
};

Value BoolValue(bool value);
Value IntegerValue(std::int64_t value);
Value FloatValue(double value);
Value StringValue(std::string text);
Value TensorValue(Tensor tensor);
Value TupleValue(std::vector<Value> items);
Value PlainValue(ValueKind kind, std::string text = "");

// A list or dictionary, or a tuple with one in it. What is changed later may take none of these, so
// that nothing ever holds itself.
bool HoldsContainer(const Value& value);

// "a tensor [N, 3]", "a string", for sentences.
std::string Describe(const Value& value);

// What can be changed in place, and is shared by all that name it.
struct Object {
  std::shared_ptr<const std::vector<NodeId>> nodes;  // a storage
  std::shared_ptr<const std::vector<Value>> items;   // a list, or a dictionary's values
  std::shared_ptr<const std::vector<Value>> keys;    // a dictionary's keys, in order
};

// All objects of a program, by number. Contents are copied on writing, so that keeping the whole
// heap (before a branch that only some environments take) is cheap.
class Heap {
 public:
  int AddStorage(std::vector<NodeId> nodes);
  int AddList(std::vector<Value> items);
  int AddDict(std::vector<Value> keys, std::vector<Value> items);

  const Object& operator[](int object) const { return objects_[object]; }
  void Set(int object, Object contents) { objects_[object] = std::move(contents); }
  int size() const { return static_cast<int>(objects_.size()); }
  std::vector<Object> Copy() const { return objects_; }

 private:
  std::vector<Object> objects_;
};

}  // namespace simwright::tasks::reward
