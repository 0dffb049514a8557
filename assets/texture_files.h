#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace simwright::assets {

// A file that a mesh names, beside the mesh.
struct SiblingFile {
  std::filesystem::path path;
  bool as_named = true;  // false: found by its file name in another folder than named
};

// Finds the texture `name` as given by a mesh in `folder`: with '\' or '/', in upper or lower case,
// relative or with another machine's folders before it. It is searched as named, then by its file
// name, in `folder` and in texture folders inside it and beside it ("../textures", as download
// sites pack "source/" and "textures/"); nowhere else. Links that lead outside are not followed. A
// name that is not found as written is searched with its percent escapes decoded ("a%20b.png").
std::optional<SiblingFile> FindTextureFile(const std::filesystem::path& folder,
                                           const std::string& name);

// Finds other files than images (material libraries, buffers), inside `folder` alone.
std::optional<SiblingFile> FindSiblingFile(const std::filesystem::path& folder,
                                           const std::string& name);

// Decodes percent escapes: "a%20b" -> "a b".
std::string PercentDecoded(std::string_view text);

}  // namespace simwright::assets
