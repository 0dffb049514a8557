#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace simwright::core {

// 32 hexadecimal digits: FNV-1a, 128 bits. Not proof against forgery, so what is found by it is
// compared in full where that matters.
std::string ContentHash(std::string_view bytes);

// Of a file over its content; of a folder over the hashes and the names, from the folder on, of all
// files in it and in its folders, in order of their names. Links to folders are not followed.
// Throws core::Error where something cannot be read.
std::string ContentHashOf(const std::filesystem::path& path);

}  // namespace simwright::core
