#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reward/ir/scalar_operation.h"
#include "reward/symbolic/value.h"

namespace simwright::reward {

class Elaborator;

// The arguments of one call, in the order of the function's parameters.
struct Arguments {
  const LibraryFunction* function = nullptr;
  std::string called;  // the name as written, "torch.norm" or ".norm"
  Position position;
  std::vector<Value> values;
  std::vector<Position> places;
  std::vector<bool> given;

  const Value& operator[](std::size_t i) const { return values[i]; }
  Position Place(std::size_t i) const { return places[i]; }
};

using Handler = Value (*)(Elaborator&, const Arguments&);

// A function of torch, numpy, math, Python or Isaac Gym's utilities that programs may call.
struct LibraryFunction {
  std::string_view names;       // "torch.norm Tensor.norm np.linalg.norm"
  std::string_view parameters;  // "input p=2 dim=None"; "*sizes" takes the remaining arguments
  Handler handler;
  ScalarOperation operation = ScalarOperation::kConstant;  // of an elementwise function
  int variant = 0;                                         // distinguishes functions with the same
                                                           // handler
};

struct LibraryPart {
  const LibraryFunction* functions;
  std::size_t count;
};

// The tables of functions, one per file.
LibraryPart ElementwiseFunctions();
LibraryPart ReductionFunctions();
LibraryPart CreationFunctions();
LibraryPart ShapeFunctions();
LibraryPart ProductFunctions();
LibraryPart RotationFunctions();
LibraryPart PythonFunctions();
LibraryPart StringFunctions();
LibraryPart OrderFunctions();
LibraryPart ActivationFunctions();
LibraryPart LossFunctions();

// Returns null if there is no function of this name.
const LibraryFunction* FindLibraryFunction(const std::string& name);

// Returns true if some name begins with "module.".
bool IsLibraryModule(const std::string& module);

// Returns the names that follow "prefix" ("torch.", "Tensor.", "" for bare names), for suggestions.
std::vector<std::string> LibraryNames(const std::string& prefix);

}  // namespace simwright::reward
