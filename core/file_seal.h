#pragma once

#include <filesystem>

namespace simwright::core {

// The state of a file's seal: a last line with the hash (core/content_hash) of everything before
// it. Meant for files whose format allows trailing bytes (HDF5) and whose library does not survive
// flipped bits. It protects against accidents only: anyone can recompute a seal.
enum class FileSeal {
  kNone,  // no seal: written by another program, or cut off
  kHolds,
  kBroken,  // the content differs from what was sealed
};

// Appends a seal. Throws core::Error if the file cannot be read or written.
void SealFile(const std::filesystem::path& path);

// Checks a file's seal. Throws core::Error if the file cannot be read.
FileSeal CheckSeal(const std::filesystem::path& path);

}  // namespace simwright::core
