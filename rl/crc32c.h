#pragma once

#include <cstdint>
#include <string_view>

namespace simwright::rl {

// The CRC of Castagnoli's polynomial, as in RFC 3720, appendix B.4.
std::uint32_t Crc32c(std::string_view bytes);

}  // namespace simwright::rl
