#include "core/foreign_content.h"

#include <algorithm>
#include <cctype>

namespace simwright::core {
namespace {

constexpr size_t kHead = 512;  // bytes that identify a file

std::string LowerHead(std::string_view bytes) {
  std::string head(bytes.substr(0, kHead));
  const size_t start = head.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  head.erase(0, std::min(start, head.size()));
  std::transform(head.begin(), head.end(), head.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return head;
}

bool IsArchive(std::string_view bytes) {
  using namespace std::literals;
  for (const std::string_view magic :
       {"PK\3\4"sv, "\x1f\x8b"sv, "7z\xbc\xaf\x27\x1c"sv, "Rar!\x1a\7"sv, "BZh"sv,
        "\xfd"
        "7zXZ\0"sv,
        "\x28\xb5\x2f\xfd"sv}) {
    if (bytes.starts_with(magic)) return true;
  }
  return false;
}

bool IsEncrypted(std::string_view bytes) {
  using namespace std::literals;
  for (const std::string_view magic :
       {"Salted__"sv, "-----BEGIN PGP MESSAGE"sv, "age-encryption.org/"sv, "\0GITCRYPT\0"sv}) {
    if (bytes.starts_with(magic)) return true;
  }
  return false;
}

// Returns the brand of an ISO base media file ("ftyp" box), such as HEIC and AVIF; else empty.
std::string_view MediaBrand(std::string_view bytes) {
  return bytes.size() >= 12 && bytes.substr(4, 4) == "ftyp" ? bytes.substr(8, 4) : "";
}

}  // namespace

std::optional<ForeignContent> FindForeignContent(std::string_view bytes) {
  if (bytes.empty()) return std::nullopt;
  if (bytes.starts_with("version https://git-lfs.github.com/spec/")) {
    return ForeignContent{"this is a Git LFS pointer, not the file itself",
                          "run 'git lfs install' and 'git lfs pull' in its repository"};
  }
  if (bytes.size() < 1024 && bytes.find("annex/objects/") != std::string_view::npos) {
    return ForeignContent{"this is a git-annex pointer, not the file itself",
                          "run 'git annex get' in its repository"};
  }
  const std::string head = LowerHead(bytes);
  if (head.starts_with("<!doctype html") || head.starts_with("<html")) {
    return ForeignContent{"this is a web page, not the file itself",
                          "the download failed: download the file again, from its raw address"};
  }
  if (IsArchive(bytes)) {
    return ForeignContent{"this is an archive or a compressed file", "unpack it first"};
  }
  if (IsEncrypted(bytes)) return ForeignContent{"this file is encrypted", "decrypt it first"};
  const std::string_view first = bytes.substr(0, kHead);
  if (first.size() == kHead && first.find_first_not_of('\0') == std::string_view::npos) {
    return ForeignContent{"this file contains only zeros at its start",
                          "the copy or download was cut short: copy it again"};
  }
  return std::nullopt;
}

std::optional<ForeignContent> FindUnsupportedImageFormat(std::string_view bytes) {
  using namespace std::literals;
  const auto named = [](const char* format) {
    return ForeignContent{std::string("this is ") + format + ", which cannot be read",
                          "convert it to PNG or JPEG"};
  };
  const std::string_view brand = MediaBrand(bytes);
  for (const std::string_view heic :
       {"heic"sv, "heix"sv, "hevc"sv, "mif1"sv, "msf1"sv, "heim"sv, "heis"sv}) {
    if (brand != heic) continue;
    ForeignContent found = named("an HEIC image (the iPhone default)");
    found.remedy =
        "convert it to JPEG, e.g. by heif-convert PHOTO.heic PHOTO.jpg, or set the phone's camera "
        "to 'Most Compatible'";
    return found;
  }
  if (brand == "avif" || brand == "avis") return named("an AVIF image");
  if (bytes.starts_with("\xabKTX 20\xbb"sv)) return named("a KTX2 (Basis Universal) texture");
  if (bytes.starts_with("\xabKTX 11\xbb"sv)) return named("a KTX texture");
  if (bytes.starts_with("DDS "sv)) return named("a DDS texture");
  if (bytes.starts_with("8BPS"sv)) return named("a Photoshop image");
  if (bytes.starts_with("\xff\x0a"sv) || bytes.starts_with("\0\0\0\x0cJXL "sv)) {
    return named("a JPEG XL image");
  }
  if (LowerHead(bytes).find("<svg") != std::string::npos) return named("an SVG drawing");
  return std::nullopt;
}

}  // namespace simwright::core
