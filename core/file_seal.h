#pragma once

#include <filesystem>

namespace simwright::core {

// The last line of a file that says what the hash (core/content_hash) of all before it is: for
// files whose format lets other bytes follow (HDF5) and whose library is no match for a flipped
// bit. Against accidents: whoever means harm can seal anew.
enum class FileSeal {
  kNone,  // of another program, or cut off
  kHolds,
  kBroken,  // something in the file is not as it was written
};

// Appends one. Throws core::Error where the file cannot be read or written.
void SealFile(const std::filesystem::path& path);

// Throws core::Error where the file cannot be read.
FileSeal SealOf(const std::filesystem::path& path);

}  // namespace simwright::core
