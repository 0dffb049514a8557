#include "llm/request_key.h"

#include <cstdint>

#include <nlohmann/json.hpp>

#include "llm/redaction.h"

namespace simwright::llm {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kWordsShown = 60;  // bytes

// 128 bits as two words: the multiplication needs no compiler extension.
struct Wide {
  std::uint64_t high, low;
};

// The FNV prime of 128 bits is 2^88 + 0x13b.
Wide TimesPrime(Wide value) {
  constexpr std::uint64_t kSmall = 0x13b;
  const std::uint64_t low_half = (value.low & 0xffffffffu) * kSmall;
  const std::uint64_t high_half = (value.low >> 32) * kSmall + (low_half >> 32);
  Wide product;
  product.low = (high_half << 32) | (low_half & 0xffffffffu);
  product.high = value.high * kSmall + (high_half >> 32) + (value.low << 24);
  return product;
}

}  // namespace

std::string CanonicalRequest(const ChatRequest& request) {
  Json json;
  json["messages"] = Json::array();
  for (const ChatMessage& message : request.messages) {
    Json entry = {{"role", RoleName(message.role)}, {"text", message.text}};
    for (const ChatImage& image : message.images) {
      entry["images"].push_back({{"type", image.mime_type},
                                 {"bytes", image.bytes.size()},
                                 {"hash", ContentHash(image.bytes)}});
    }
    json["messages"].push_back(std::move(entry));
  }
  if (request.temperature) json["temperature"] = *request.temperature;
  if (request.max_tokens) json["max_tokens"] = *request.max_tokens;
  if (request.seed) json["seed"] = *request.seed;
  if (request.json) json["json"] = true;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ContentHash(std::string_view bytes) {
  Wide hash{0x6c62272e07bb0142u, 0x62b821756295c58du};  // the offset basis of 128 bits
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

std::string FirstWords(const ChatRequest& request) {
  for (auto message = request.messages.rbegin(); message != request.messages.rend(); ++message) {
    if (message->role == Role::kUser) return Shortened(message->text, kWordsShown);
  }
  return "";
}

}  // namespace simwright::llm
