#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace simwright::core {

// Returns the 128-bit FNV-1a hash as 32 hexadecimal digits. It does not resist forgery: compare the
// full contents where a collision would matter.
std::string ContentHash(std::string_view bytes);

// Returns the hash of a file's contents, or, for a folder, the hash over the relative names and
// hashes of all files in it and its subfolders, in order of their names, except those for which
// `leaves_out` is true. Links to folders are not followed. Throws core::Error if something cannot
// be read.
std::string ContentHashOf(const std::filesystem::path& path,
                          bool (*leaves_out)(const std::filesystem::path& file) = nullptr);

}  // namespace simwright::core
