#include "assets/dae_metadata.h"

#include <cctype>
#include <string>
#include <utility>

namespace simwright::assets {
namespace {

constexpr size_t kHead = 1 << 16;  // <asset> comes first

}  // namespace

// Scans the text, so that a document of 500 MB is not parsed twice.
DaeMetadata ReadDaeMetadata(std::string_view text) {
  DaeMetadata head;
  const std::string_view start = text.substr(0, kHead);
  const size_t open = start.find("<up_axis>");
  if (open != std::string_view::npos) {
    size_t at = open + 9;
    while (at < start.size() && std::isspace(static_cast<unsigned char>(start[at]))) ++at;
    const std::string_view value = start.substr(at, 4);
    if (value == "X_UP") head.up = 'x';
    if (value == "Y_UP") head.up = 'y';
    if (value == "Z_UP") head.up = 'z';
  }
  constexpr std::pair<const char*, const char*> kUnread[] = {
      {"<instance_controller", "skins"}, {"<library_animations", "animations"}, {"<ph>", "holes"}};
  for (const auto& [element, name] : kUnread) {
    if (text.find(element) == std::string_view::npos) continue;
    head.unread += (head.unread.empty() ? "" : ", ") + std::string(name);
  }
  return head;
}

}  // namespace simwright::assets
