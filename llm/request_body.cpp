#include "llm/request_body.h"

#include <algorithm>
#include <cctype>

#include "core/base64.h"
#include "core/json.h"

namespace simwright::llm {
namespace {

using core::OrderedJson;

OrderedJson MessageJson(const ChatMessage& message) {
  OrderedJson json = {{"role", RoleName(message.role)}};
  if (message.images.empty()) {
    json["content"] = message.text;
    return json;
  }
  OrderedJson parts = OrderedJson::array();
  if (!message.text.empty()) parts.push_back({{"type", "text"}, {"text", message.text}});
  for (const ChatImage& image : message.images) {
    const std::string url = "data:" + image.mime_type + ";base64," + core::Base64(image.bytes);
    parts.push_back({{"type", "image_url"}, {"image_url", {{"url", url}}}});
  }
  json["content"] = std::move(parts);
  return json;
}

std::string LowerCaseName(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

std::string RequestBody(const ChatRequest& request, const std::string& model,
                        const Dialect& dialect) {
  OrderedJson json;
  if (!model.empty()) json["model"] = model;
  json["messages"] = OrderedJson::array();
  for (const ChatMessage& message : request.messages) {
    json["messages"].push_back(MessageJson(message));
  }
  if (request.temperature && dialect.temperature) json["temperature"] = *request.temperature;
  if (request.max_tokens) {
    json[dialect.max_completion_tokens ? "max_completion_tokens" : "max_tokens"] =
        *request.max_tokens;
  }
  if (request.seed && dialect.seed) json["seed"] = *request.seed;
  if (request.json && dialect.json_mode) json["response_format"] = {{"type", "json_object"}};
  json["stream"] = false;
  return core::JsonLine(json, core::InvalidUtf8::kReplace);
}

std::string Narrow(const std::string& message, const ChatRequest& request, Dialect* dialect) {
  const std::string text = LowerCaseName(message);
  const auto names = [&](const char* word) { return text.find(word) != std::string::npos; };
  if (request.max_tokens && !dialect->max_completion_tokens && names("max_completion_tokens")) {
    dialect->max_completion_tokens = true;
    return "the server wants max_completion_tokens instead of max_tokens";
  }
  if (request.json && dialect->json_mode &&
      (names("response_format") || names("json_object") || names("json mode"))) {
    dialect->json_mode = false;
    return "the server has no JSON mode; JSON is requested in the prompt only";
  }
  if (request.temperature && dialect->temperature && names("temperature")) {
    dialect->temperature = false;
    return "the model allows only its default temperature";
  }
  if (request.seed && dialect->seed && names("seed")) {
    dialect->seed = false;
    return "the server accepts no seed: its answers are not repeatable";
  }
  return "";
}

}  // namespace simwright::llm
