#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace simwright::assets {

// A file that a mesh names, beside the mesh.
struct FileBeside {
  std::filesystem::path path;
  bool as_named = true;  // false: found by its file name alone, in another folder than named
};

// `name` as a mesh in `folder` gives it, with '\' or '/', in upper or lower case, relative or with
// another machine's folders before it. It is looked for as named, then by its file name, in
// `folder`, in the folders of textures inside it and in those beside it ("../textures", as download
// sites pack "source/" and "textures/"); nowhere else. Links that lead out are not followed. What
// is not there as written is looked for with its percent escapes decoded ("a%20b.png").
std::optional<FileBeside> FindTextureFile(const std::filesystem::path& folder,
                                          const std::string& name);

// The same for files other than pictures (material libraries, buffers): inside `folder` alone.
std::optional<FileBeside> FindFileBeside(const std::filesystem::path& folder,
                                         const std::string& name);

// "a%20b" -> "a b".
std::string PercentDecoded(std::string_view text);

}  // namespace simwright::assets
