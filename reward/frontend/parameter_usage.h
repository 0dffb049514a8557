#pragma once

#include <map>
#include <set>
#include <string>

#include "reward/frontend/syntax.h"

namespace simwright::reward {

// The constraints that the indices x[...] put on the shape of a parameter x.
struct Usage {
  int width = 0;  // minimum size of the last dimension; 0: unknown
  int rank = 0;   // number of trailing dimensions seen in an index
};

// Returns the names of all functions that the module calls, as f(...) or self.f(...).
std::set<std::string> CalledNames(const Module& module);

// Adds the indices in `body` to the usages of the names in `usages`.
void CollectUsages(const Block& body, std::map<std::string, Usage>* usages);

// Returns the lengths of the lists of plain numbers in a program, [0.1, 0.2, 0.3]: candidate widths
// of parameters.
std::set<int> ListLengths(const Module& module);

// Returns the type name in a parameter's annotation: "Tensor", "float". For Optional[Tensor] and
// Tensor | None it is the first that is not None, for List[float] "List". Returns "Tensor" if there
// is no annotation.
std::string AnnotatedType(const Parameter& parameter);

// Returns true if `type` is a tensor type of torch or numpy.
bool IsTensorType(const std::string& type);

}  // namespace simwright::reward
