#include "llm/request_key.h"

#include "core/content_hash.h"
#include "core/json.h"
#include "llm/redaction.h"

namespace simwright::llm {
namespace {

using core::Json;

constexpr std::size_t kWordsShown = 60;  // bytes

}  // namespace

std::string CanonicalRequest(const ChatRequest& request) {
  Json json;
  json["messages"] = Json::array();
  for (const ChatMessage& message : request.messages) {
    Json entry = {{"role", RoleName(message.role)}, {"text", message.text}};
    for (const ChatImage& image : message.images) {
      entry["images"].push_back({{"type", image.mime_type},
                                 {"bytes", image.bytes.size()},
                                 {"hash", core::ContentHash(image.bytes)}});
    }
    json["messages"].push_back(std::move(entry));
  }
  if (request.temperature) json["temperature"] = *request.temperature;
  if (request.max_tokens) json["max_tokens"] = *request.max_tokens;
  if (request.seed) json["seed"] = *request.seed;
  if (request.json) json["json"] = true;
  return core::JsonLine(json, core::InvalidUtf8::kReplace);
}

std::string FirstWords(const ChatRequest& request) {
  for (auto message = request.messages.rbegin(); message != request.messages.rend(); ++message) {
    if (message->role == Role::kUser) return Shortened(message->text, kWordsShown);
  }
  return "";
}

}  // namespace simwright::llm
