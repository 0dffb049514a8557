#include "assets/texture_files.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <vector>

#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr int kMostEntries = 20'000;  // maximum folder entries compared case-insensitively

std::string LowerPath(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool IsTextureFolder(const std::string& name) {
  static const char* const kNames[] = {"textures", "texture", "tex",       "maps",    "map",
                                       "images",   "image",   "materials", "material"};
  const std::string lower = LowerPath(name);
  return std::find(std::begin(kNames), std::end(kNames), lower) != std::end(kNames);
}

// Returns the path with '/' separators only, without quotes, a "file://" prefix or a drive letter.
std::string Portable(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  const auto is_padding = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!name.empty() && is_padding(name.back())) name.pop_back();
  size_t start = 0;
  while (start < name.size() && is_padding(name[start])) ++start;
  name.erase(0, start);
  if (name.starts_with("file://")) name.erase(0, 7);
  if (name.size() > 1 && name[1] == ':') name.erase(0, 2);
  return name;
}

// Finds `relative` below `root`, component by component, with the exact case first and then
// case-insensitively.
std::optional<fs::path> FindBelow(const fs::path& root, const fs::path& relative) {
  std::error_code code;
  fs::path at = root;
  for (const fs::path& component : relative.lexically_normal()) {
    if (component == "." || component.empty()) continue;
    if (component == ".." || component == "/") return std::nullopt;
    fs::path next = at / component;
    if (!fs::exists(next, code)) {
      const std::string wanted = LowerPath(component.string());
      std::vector<fs::path> alike;
      int looked = 0;
      for (const auto& entry : fs::directory_iterator(at, code)) {
        if (++looked > kMostEntries) break;
        if (LowerPath(entry.path().filename().string()) == wanted) alike.push_back(entry.path());
      }
      if (alike.empty()) return std::nullopt;
      next = *std::min_element(alike.begin(), alike.end());
    }
    at = next;
  }
  if (!fs::is_regular_file(at, code)) return std::nullopt;
  try {
    return core::ResolveInside(root, fs::relative(at, root));
  } catch (const std::exception&) {
    return std::nullopt;  // a link that leads outside
  }
}

// Returns the texture folders directly in `parent`, by name.
std::vector<fs::path> TextureFoldersIn(const fs::path& parent) {
  std::vector<fs::path> folders;
  std::error_code code;
  int looked = 0;
  for (const auto& entry : fs::directory_iterator(parent, code)) {
    if (++looked > kMostEntries) break;
    if (entry.is_symlink(code) || !entry.is_directory(code)) continue;
    if (IsTextureFolder(entry.path().filename().string())) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

// Implements FindSiblingFile for a name as written.
std::optional<SiblingFile> FindWritten(const fs::path& folder, const std::string& name) {
  const fs::path named = Portable(name);
  if (named.filename().empty()) return std::nullopt;
  if (!named.is_absolute()) {
    if (const auto found = FindBelow(folder, named)) return SiblingFile{*found, true};
  }
  if (const auto found = FindBelow(folder, named.filename())) return SiblingFile{*found, false};
  return std::nullopt;
}

// Implements FindTextureFile for a name as written.
std::optional<SiblingFile> FindWrittenTexture(const fs::path& folder, const std::string& name) {
  if (auto found = FindWritten(folder, name); found && found->as_named) return found;
  const fs::path named = fs::path(Portable(name)).lexically_normal();
  if (named.filename().empty()) return std::nullopt;
  const fs::path parent = folder.parent_path();
  // "../textures/x.png"
  auto component = named.begin();
  if (!parent.empty() && component != named.end() && *component == "..") {
    fs::path rest;
    for (++component; component != named.end(); ++component) rest /= *component;
    if (rest.begin() != rest.end() && IsTextureFolder(rest.begin()->string())) {
      if (const auto found = FindBelow(parent, rest)) return SiblingFile{*found, true};
    }
  }
  if (auto found = FindWritten(folder, name)) return found;
  for (const fs::path& place : {folder, parent}) {
    if (place.empty()) continue;
    for (const fs::path& textures : TextureFoldersIn(place)) {
      if (const auto found = FindBelow(textures, named.filename())) {
        return SiblingFile{*found, false};
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::string PercentDecoded(std::string_view text) {
  std::string decoded;
  for (size_t i = 0; i < text.size(); ++i) {
    const auto hex = [&](size_t at) { return std::isxdigit(static_cast<unsigned char>(text[at])); };
    if (text[i] == '%' && i + 2 < text.size() && hex(i + 1) && hex(i + 2)) {
      const std::string digits(text.substr(i + 1, 2));
      decoded.push_back(static_cast<char>(std::strtol(digits.c_str(), nullptr, 16)));
      i += 2;
    } else {
      decoded.push_back(text[i]);
    }
  }
  return decoded;
}

std::optional<SiblingFile> FindSiblingFile(const fs::path& folder, const std::string& name) {
  auto found = FindWritten(folder, name);
  if (!found && name.find('%') != std::string::npos) {
    found = FindWritten(folder, PercentDecoded(name));
  }
  return found;
}

std::optional<SiblingFile> FindTextureFile(const fs::path& folder, const std::string& name) {
  auto found = FindWrittenTexture(folder, name);
  if (!found && name.find('%') != std::string::npos) {
    found = FindWrittenTexture(folder, PercentDecoded(name));
  }
  return found;
}

}  // namespace simwright::assets
