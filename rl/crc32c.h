#pragma once

#include <cstdint>
#include <string_view>

namespace simwright::rl {

// Returns the CRC with Castagnoli's polynomial (RFC 3720, appendix B.4).
std::uint32_t Crc32c(std::string_view bytes);

}  // namespace simwright::rl
