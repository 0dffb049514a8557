#include "core/content_hash.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "core/error.h"
#include "core/files.h"

namespace simwright::core {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kBasis = 14695981039346656037ull;
constexpr std::uint64_t kPrime = 1099511628211ull;

std::uint64_t Fold(std::string_view bytes, std::uint64_t hash) {
  for (const char byte : bytes) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * kPrime;
  }
  return hash;
}

std::string Digits(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace

std::string ContentHash(std::string_view bytes) {
  return Digits(Fold(bytes, kBasis));
}

std::string ContentHashOf(const fs::path& path) {
  if (!fs::is_directory(path)) return ContentHash(ReadFile(path));
  std::vector<fs::path> files;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(path, code)) {
    if (entry.is_regular_file(code)) files.push_back(entry.path());
  }
  if (code) throw Error("cannot list the folder", path.string(), "check its permissions");
  std::sort(files.begin(), files.end());
  std::uint64_t hash = kBasis;
  for (const fs::path& file : files) {
    hash = Fold(file.filename().string(), hash);
    hash = Fold(ReadFile(file), hash);
  }
  return Digits(hash);
}

}  // namespace simwright::core
