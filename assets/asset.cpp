#include "assets/asset.h"

namespace simwright::assets {

std::string FileSafeName(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '_' || c == '-';
    if (kept) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
    if (name.size() >= 80) break;
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name.empty() ? "asset" : name;
}

}  // namespace simwright::assets
