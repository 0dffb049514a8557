#pragma once

#include <set>
#include <string>
#include <string_view>

namespace simwright::tasks {

// `title` as a name that is safe in a file system and on a command line: ASCII letters, digits,
// '_' and '-' and the letters of other scripts stay, runs of anything else become one '_'. At most
// 64 bytes of whole characters, begins with a letter or digit; empty where nothing is left.
std::string SafeName(std::string_view title);

// `name`, or `name_2`, `name_3` ... where that is taken, within 64 bytes; what it returns is added
// to `taken`.
// Names that differ in the case of ASCII letters alone count as one: some file systems hold only
// one of them.
std::string UniqueName(const std::string& name, std::set<std::string>* taken);

// True where a program can call an asset so: a letter, then letters, digits, '_', '-'; at most 64.
bool IsAssetName(std::string_view name);

}  // namespace simwright::tasks
