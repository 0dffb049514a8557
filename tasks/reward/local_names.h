#pragma once

#include <set>
#include <string>

#include "tasks/reward/syntax.h"

namespace simwright::tasks::reward {

// The names that a function's body sets anywhere, its loops' and inner functions' names too;
// what it imports is left out, since unknown modules set nothing. As in
// Python these are its own: they hide what is called so outside, in lines before they are set as
// well.
std::set<std::string> LocalNames(const Block& body);

}  // namespace simwright::tasks::reward
