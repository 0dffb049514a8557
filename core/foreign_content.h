#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace simwright::core {

// Content that differs from what the file's name announces, and what to do about it.
struct ForeignContent {
  std::string what;    // "this is a Git LFS pointer, not the file itself"
  std::string remedy;  // "run 'git lfs pull' ..."
};

// Recognises, by the first bytes, content that may replace any kind of file: a Git LFS or git-annex
// pointer, a web page saved by a failed download, an archive, an encrypted file, or only zeros.
std::optional<ForeignContent> FindForeignContent(std::string_view bytes);

// Recognises, by the first bytes, known image formats that cannot be read: HEIC, AVIF, KTX, KTX2
// (Basis), DDS, SVG, Photoshop, JPEG XL.
std::optional<ForeignContent> FindUnsupportedImageFormat(std::string_view bytes);

}  // namespace simwright::core
