#include "rl/crc32c.h"

namespace simwright::rl {

std::uint32_t Crc32c(std::string_view bytes) {
  constexpr std::uint32_t kPolynomial = 0x82F63B78u;  // 0x1EDC6F41, bits reversed
  std::uint32_t remainder = 0xFFFFFFFFu;
  for (const char byte : bytes) {
    remainder ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ (remainder & 1u ? kPolynomial : 0u);
    }
  }
  return ~remainder;
}

}  // namespace simwright::rl
