#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace simwright::core {

// What a file holds in place of what its name says, and what to do about it.
struct ForeignContent {
  std::string what;    // "this is a Git LFS pointer, not the file itself"
  std::string remedy;  // "run 'git lfs pull' ..."
};

// Content that stands in for any kind of file: a Git LFS or git-annex pointer, a web page saved by
// a failed download, an archive, an encrypted file, nothing but zeros. Judged by the first bytes.
std::optional<ForeignContent> FindForeignContent(std::string_view bytes);

// Pictures of formats that are known and not read: HEIC, AVIF, KTX, KTX2 (Basis), DDS, SVG,
// Photoshop, JPEG XL. Judged by the first bytes.
std::optional<ForeignContent> FindUnreadPicture(std::string_view bytes);

}  // namespace simwright::core
