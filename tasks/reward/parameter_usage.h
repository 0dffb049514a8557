#pragma once

#include <map>
#include <set>
#include <string>

#include "tasks/reward/syntax.h"

namespace simwright::tasks::reward {

// What the indices of x[...] say of a parameter x: the least width that its last dimension has to
// have.
struct Usage {
  int width = 0;  // 0: unknown
  int rank = 0;   // trailing dimensions seen in an index
};

// The names of all functions that are called in the module, as f(...) or self.f(...).
std::set<std::string> CalledNames(const Module& module);

// Adds what the indices in `body` say to the usages of the names that are there.
void NoteUsages(const Block& body, std::map<std::string, Usage>* usages);

// The lengths of the lists of plain numbers in a program, [0.1, 0.2, 0.3]: widths that something
// may have to fit.
std::set<int> ListLengths(const Module& module);

// The name that a parameter's annotation comes down to: "Tensor", "float"; of Optional[Tensor] and
// Tensor | None the first that is not None, of List[float] "List". "Tensor" where there is none.
std::string AnnotatedType(const Parameter& parameter);

// Of a tensor, as torch and numpy call it.
bool IsTensorType(const std::string& type);

}  // namespace simwright::tasks::reward
