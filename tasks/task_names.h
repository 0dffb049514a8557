#pragma once

#include <set>
#include <string>
#include <string_view>

namespace simwright::tasks {

// Returns `title` as a name that is safe in a file system and on a command line: ASCII letters,
// digits, '_', '-' and the letters of other scripts are kept, runs of other characters become one
// '_'. The name has at most 64 bytes of whole characters and begins with a letter or digit; it is
// empty if nothing is left.
std::string SafeName(std::string_view title);

// Returns `name`, or `name_2`, `name_3` ... where that is taken, within 64 bytes, and adds the
// result to `taken`. Names that differ only in the case of ASCII letters count as equal, because
// some file systems hold only one of them.
std::string UniqueName(const std::string& name, std::set<std::string>* taken);

// Returns true if programs can refer to an asset by `name`: a letter, then letters, digits, '_',
// '-'; at most 64.
bool IsAssetName(std::string_view name);

}  // namespace simwright::tasks
