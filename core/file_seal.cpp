#include "core/file_seal.h"

#include <fstream>
#include <string>
#include <string_view>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::core {
namespace {

constexpr std::string_view kBegin = "\nseal ", kEnd = "\n";
constexpr std::size_t kDigits = 32;
constexpr std::size_t kLength = kBegin.size() + kDigits + kEnd.size();

}  // namespace

void SealFile(const std::filesystem::path& path) {
  const std::string seal = std::string(kBegin) + ContentHash(ReadFile(path)) + std::string(kEnd);
  std::ofstream file(path, std::ios::binary | std::ios::app);
  file << seal << std::flush;
  if (!file) throw Error("cannot finish writing the file", path.string());
}

FileSeal CheckSeal(const std::filesystem::path& path) {
  const std::string bytes = ReadFile(path);
  if (bytes.size() < kLength) return FileSeal::kNone;
  const std::string_view all = bytes;
  const std::string_view seal = all.substr(all.size() - kLength);
  if (!seal.starts_with(kBegin) || !seal.ends_with(kEnd)) return FileSeal::kNone;
  const bool holds =
      seal.substr(kBegin.size(), kDigits) == ContentHash(all.substr(0, all.size() - kLength));
  return holds ? FileSeal::kHolds : FileSeal::kBroken;
}

}  // namespace simwright::core
