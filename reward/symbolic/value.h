#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "reward/frontend/syntax.h"
#include "reward/ir/graph.h"

namespace simwright::reward {

struct LibraryFunction;

enum class DataType { kBool, kInteger, kFloat };

// The size of a dimension that runs over the environments.
constexpr int kBatch = -1;
using Shape = std::vector<int>;

// Returns the size of a dimension that runs over the environments where a flag is set, x[mask].
// Equal flags give equal sizes, so only tensors selected by the same mask are compatible.
constexpr int SelectedBy(NodeId flag) {
  return kBatch - 1 - flag;
}
constexpr bool IsSelected(int size) {
  return size < kBatch;
}
constexpr NodeId SelectionFlag(int size) {
  return kBatch - 1 - size;
}
// Returns true if the dimension runs over all environments or over the selected ones.
constexpr bool RunsOverEnvironments(int size) {
  return size <= kBatch;
}
bool HasSelectedDimension(const Shape& shape);

// Returns "[N, 3]"; a scalar is "a scalar", and M is the number of environments that a mask
// selects.
std::string ShapeText(const Shape& shape);

// Returns the numbers per environment of a tensor of this shape: the product of its sizes without
// N.
std::int64_t LaneCount(const Shape& shape);

// Returns the dimension over the environments, or -1.
int BatchDimension(const Shape& shape);

// A view of a storage: lane i (row-major over the shape, without N) is element lanes[i] of the
// storage. A tensor without a dimension N may still differ between environments: the program is
// then written for one environment (a scalar distance, a position [3]).
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
  kEnvironment,  // text: the name as written, "env"
  kFunction,     // function: a function of the program
  kLibrary,      // library; text: the name as written; items: the receiver of a method
  kApi,          // text: a function of the environment; integer: 1 if called on it
  kType,         // a number type: integer is a DataType; text
  kOpaque,       // a device or an annotation: accepted and ignored
  kUndefined,    // text: the reason why it cannot be used; empty if already reported
};

struct Value;

// The captured state of a function defined inside another.
struct Closure {
  int frame = 0;                // number of the call in which it was defined
  std::vector<Value> initials;  // default values of its parameters
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
  std::shared_ptr<const Closure> closure;  // set for a function defined inside another
  // The names of a tuple's elements. An index along a dimension that does not support one is
  // reported only when it is used: the second element of (values, indices) carries its names.
  std::shared_ptr<const std::vector<std::string>> field_names;

  bool Is(ValueKind wanted) const { return kind == wanted; }
  bool IsNumber() const {
    return kind == ValueKind::kBool || kind == ValueKind::kInteger || kind == ValueKind::kFloat;
  }
  double Number() const {
    return kind == ValueKind::kFloat ? number : static_cast<double>(integer);
  }
  // Returns the type of this number as an operand of tensors.
  DataType NumberType() const;
};

Value BoolValue(bool value);
Value IntegerValue(std::int64_t value);
Value FloatValue(double value);
Value StringValue(std::string text);
Value TensorValue(Tensor tensor);
Value TupleValue(std::vector<Value> items);
Value PlainValue(ValueKind kind, std::string text = "");

// Returns true for a list or dictionary, or a tuple that contains one. Mutable objects must not
// contain these, so no object ever contains itself.
bool HoldsContainer(const Value& value);

// Returns a description for messages: "a tensor [N, 3]", "a string".
std::string Describe(const Value& value);

// An object that can be modified in place and is shared by all its names.
struct Object {
  std::shared_ptr<const std::vector<NodeId>> nodes;  // elements of a storage
  std::shared_ptr<const std::vector<Value>> items;   // elements of a list, or values of a
                                                     // dictionary
  std::shared_ptr<const std::vector<Value>> keys;    // keys of a dictionary, in order
};

// The objects of a program, by number. Contents are copied on write, so a snapshot of the whole
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

}  // namespace simwright::reward
