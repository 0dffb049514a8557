#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace simwright::core {

// Encodes `bytes` as Base64 (RFC 4648) with padding.
std::string Base64(std::string_view bytes);

// Decodes `text`. Line breaks are skipped, padding may be missing, and the URL-safe '-' and '_' are
// accepted for '+' and '/'. Returns nothing if `text` is not Base64.
std::optional<std::string> FromBase64(std::string_view text);

}  // namespace simwright::core
