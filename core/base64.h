#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace simwright::core {

// RFC 4648 with padding.
std::string Base64(std::string_view bytes);

// The bytes that `text` stands for; line breaks are passed over, padding may be missing, '-' and
// '_' stand for '+' and '/'. Nothing where it is no Base64.
std::optional<std::string> FromBase64(std::string_view text);

}  // namespace simwright::core
