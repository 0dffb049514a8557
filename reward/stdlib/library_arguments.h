#pragma once

#include <vector>

#include "reward/stdlib/library.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {

// Returns true if the function is torch's, which takes tensors but no plain numbers.
bool WantsTensors(const Arguments& arguments);

// Returns argument i as a tensor. Accepts plain numbers unless torch itself refuses them; converts
// lists to arrays where numpy does.
Tensor TensorArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i);

// Returns argument i as a tensor where torch accepts a plain number too (torch.where, torch.clamp).
Tensor NumberOrTensor(Elaborator& elaborator, const Arguments& arguments, std::size_t i);

// Returns argument i as a float tensor; converts whole numbers and flags.
Tensor FloatArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i);

// Returns nested lists of numbers, of any depth, as a tensor; stacks elements that are tensors.
Tensor ArrayFrom(Elaborator& elaborator, const Value& value, Position position);

std::int64_t IntegerArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i);
double NumberArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i);
bool FlagArgument(const Arguments& arguments, std::size_t i);

// Returns argument i as dimensions of `tensor`: a number, a tuple of numbers, or None for all.
std::vector<int> Dimensions(Elaborator& elaborator, const Arguments& arguments, std::size_t i,
                            const Tensor& tensor);

// Returns sizes given one by one or as one tuple; TensorMath::kKnownBatch represents N.
std::vector<std::int64_t> Sizes(Elaborator& elaborator, const Value& value, Position position);

// Returns sizes as a shape. The sizes must not contain -1.
Shape ShapeFrom(const std::vector<std::int64_t>& sizes, Position position);

// Returns the type named by argument i, or `otherwise`.
DataType TypeArgument(const Arguments& arguments, std::size_t i, DataType otherwise);

// Returns a tuple whose elements also have names, such as (values, indices).
Value NamedTuple(std::vector<Value> items, std::vector<std::string> names);

}  // namespace simwright::reward
