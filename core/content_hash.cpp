#include "core/content_hash.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "core/files.h"

namespace simwright::core {
namespace fs = std::filesystem;
namespace {

// A 128-bit integer as two words, so that no compiler extension is needed.
struct Wide {
  std::uint64_t high, low;
};

// Multiplies by the 128-bit FNV prime, 2^88 + 0x13b.
Wide TimesPrime(Wide value) {
  constexpr std::uint64_t kSmall = 0x13b;
  const std::uint64_t low_half = (value.low & 0xffffffffu) * kSmall;
  const std::uint64_t high_half = (value.low >> 32) * kSmall + (low_half >> 32);
  Wide product;
  product.low = (high_half << 32) | (low_half & 0xffffffffu);
  product.high = value.high * kSmall + (high_half >> 32) + (value.low << 24);
  return product;
}

std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code code;
  for (fs::recursive_directory_iterator entry(folder, code), end; !code && entry != end;
       entry.increment(code)) {
    if (entry->is_regular_file()) files.push_back(entry->path());
  }
  if (code) throw Error("cannot list the folder", folder.string(), "check its permissions");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::string ContentHash(std::string_view bytes) {
  Wide hash{0x6c62272e07bb0142u, 0x62b821756295c58du};  // the 128-bit offset basis
  for (const char c : bytes) {
    hash.low ^= static_cast<unsigned char>(c);
    hash = TimesPrime(hash);
  }
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint64_t word : {hash.high, hash.low}) {
    for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[word >> shift & 15u];
  }
  return text;
}

std::string ContentHashOf(const fs::path& path, bool (*leaves_out)(const fs::path& file)) {
  if (!fs::is_directory(path)) return ContentHash(ReadFile(path));
  std::string listing;
  for (const fs::path& file : FilesIn(path)) {
    if (leaves_out != nullptr && leaves_out(file)) continue;
    listing += ContentHash(ReadFile(file)) + " " + file.lexically_relative(path).string() + "\n";
  }
  return ContentHash(listing);
}

}  // namespace simwright::core
