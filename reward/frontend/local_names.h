#pragma once

#include <set>
#include <string>

#include "reward/frontend/syntax.h"

namespace simwright::reward {

// Returns the names that a function's body binds anywhere, including those of its loops and inner
// functions. Imported names are left out, since unknown modules bind nothing. As in Python these
// names are local to the whole body: they hide outer names even in lines before they are bound.
std::set<std::string> LocalNames(const Block& body);

}  // namespace simwright::reward
