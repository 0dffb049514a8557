#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "core/json.h"
#include "llm/redaction.h"
#include "texture/endpoints/endpoint_connection.h"

namespace simwright::texture {
namespace {

using core::Json;

std::string InLowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Returns the message of one node_errors entry of ComfyUI.
std::string NodeMessage(const Json& node) {
  const Json* errors = core::FindMember(node, "errors");
  if (errors == nullptr || !errors->is_array() || errors->empty()) return "";
  const std::string details = core::TextMember(errors->front(), "details");
  return core::TextMember(errors->front(), "message") + (details.empty() ? "" : ": " + details);
}

// Returns the text of a value that a server uses as its message.
std::string MessageIn(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_array() && !value.empty()) {
    // FastAPI lists faults with a place and a message.
    const std::string message = core::TextMember(value.front(), "msg");
    return message.empty() ? MessageIn(value.front()) : message;
  }
  if (!value.is_object()) return "";
  std::string message = core::TextMember(value, "message");
  const std::string details = core::TextMember(value, "details");
  const std::string code = core::TextMember(value, "code");
  if (!details.empty()) message += ": " + details;
  if (!code.empty()) message += (message.empty() ? "" : " ") + ("(" + code + ")");
  return message;
}

}  // namespace

std::string MessageInAnswer(const std::string& body) {
  const std::optional<Json> json = core::TryParseJson(body);
  if (!json || !json->is_object()) return "";
  std::string message;
  for (const char* name : {"error", "errors", "detail", "message"}) {
    const Json* member = core::FindMember(*json, name);
    if (member == nullptr) continue;
    const std::string text = MessageIn(*member);
    if (text.empty()) continue;
    message = message.empty() ? text : message + ": " + text;
    if (!member->is_string()) break;  // the web UI's "error" is a name that "errors" explains
  }
  const Json* nodes = core::FindMember(*json, "node_errors");
  if (nodes != nullptr && nodes->is_object() && !nodes->empty()) {
    const std::string text = NodeMessage(nodes->front());
    if (!text.empty()) message += (message.empty() ? "" : "; ") + text;
  }
  return message;
}

bool SpeaksOfContentFilter(const std::string& message) {
  const std::string text = InLowerCase(message);
  constexpr std::array<const char*, 7> kWords = {
      "content_policy", "content policy", "moderation_blocked", "safety system",
      "safety checker", "nsfw",           "content filter"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

std::string DescribeAnswer(const std::string& body) {
  const std::size_t first = body.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "empty";
  const std::string start = InLowerCase(body.substr(first, 100));
  if (start.starts_with("<!doctype html") || start.starts_with("<html")) {
    return "a web page (HTML)";
  }
  const std::string message = MessageInAnswer(body);
  if (!message.empty()) return "\"" + message + "\"";
  const std::size_t shown = std::min<std::size_t>(body.size(), 60);
  const bool text = std::all_of(body.begin(), body.begin() + static_cast<long>(shown),
                                [](unsigned char c) { return c >= 0x20 || std::isspace(c); });
  return text ? "\"" + llm::Shortened(body.substr(first), 80) + "\""
              : "of an unknown binary format";
}

}  // namespace simwright::texture
