#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace simwright::core {

// FNV-1a of 64 bits (Fowler, Noll, Vo), as 16 hexadecimal digits. Tells whether content has
// changed; no protection against whoever wants two contents to look the same.
std::string ContentHash(std::string_view bytes);

// The hash over names and contents of the regular files in `folder`, not those of folders in it, in
// order of their names; of a file over its content alone. Throws core::Error where it cannot be
// read.
std::string ContentHashOf(const std::filesystem::path& path);

}  // namespace simwright::core
