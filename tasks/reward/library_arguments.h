#pragma once

#include <vector>

#include "tasks/reward/elaborator.h"
#include "tasks/reward/library.h"

namespace simwright::tasks::reward {

// True where the function is torch's, which takes tensors and no plain numbers.
bool WantsTensors(const Arguments& arguments);

// Argument i as a tensor. Plain numbers are let through unless torch itself refuses them; lists
// become arrays where numpy makes them so.
Tensor TensorArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i);

// The same, where a plain number is fine in torch too (torch.where, torch.clamp).
Tensor NumberOrTensor(Elaborator& elaborator, const Arguments& arguments, std::size_t i);

// The same, with whole numbers and flags turned into floats.
Tensor FloatArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i);

// Numbers in lists, to any depth, as a tensor; elements that are tensors are stacked.
Tensor ArrayFrom(Elaborator& elaborator, const Value& value, Position position);

std::int64_t IntegerArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i);
double NumberArgument(Elaborator& elaborator, const Arguments& arguments, std::size_t i);
bool FlagArgument(const Arguments& arguments, std::size_t i);

// Argument i as dimensions of `tensor`: a number, a tuple of them, or None for all.
std::vector<int> Dimensions(Elaborator& elaborator, const Arguments& arguments, std::size_t i,
                            const Tensor& tensor);

// Sizes given one by one or as one tuple; TensorMath::kKnownBatch stands for N.
std::vector<std::int64_t> Sizes(Elaborator& elaborator, const Value& value, Position position);

// Sizes as a shape, which may not hold -1.
Shape ShapeFrom(const std::vector<std::int64_t>& sizes, Position position);

// The type named by argument i, or `otherwise`.
DataType TypeArgument(const Arguments& arguments, std::size_t i, DataType otherwise);

// (values, indices) and the like: a tuple whose elements also have names.
Value NamedTuple(std::vector<Value> items, std::vector<std::string> names);

}  // namespace simwright::tasks::reward
