#include "llm/response_reader.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/json.h"

namespace simwright::llm {
namespace {

using core::Json;

std::int64_t CountMember(const Json* object, const char* name) {
  const double count = object == nullptr ? 0.0 : core::NumberMember(*object, name, 0.0);
  constexpr double kMost = 1e12;  // no model reads more; larger values are not counts
  return count >= 0.0 && count <= kMost ? static_cast<std::int64_t>(count) : 0;
}

// Returns a string, or the texts of an array of parts.
std::string ContentText(const Json& content) {
  if (content.is_string()) return content.get<std::string>();
  std::string text;
  if (content.is_array()) {
    for (const Json& part : content) text += core::TextMember(part, "text");
  }
  return text;
}

ReadResponse NoResponse(const std::string& message) {
  ReadResponse response;
  response.message = message;
  return response;
}

// Reads {"error": {"message", "type", "code"}}, {"error": "text"}, and vLLM's {"object": "error",
// ...}.
ReadResponse ErrorResponse(const Json& error) {
  ReadResponse response;
  response.kind = ReadResponse::Kind::kError;
  if (error.is_string()) response.message = error.get<std::string>();
  response.message += core::TextMember(error, "message");
  if (response.message.empty()) {
    response.message = core::JsonLine(error, core::InvalidUtf8::kReplace);
  }
  response.error_code = core::TextMember(error, "code");
  if (response.error_code.empty()) response.error_code = core::TextMember(error, "type");
  response.error_status =
      static_cast<int>(std::min<std::int64_t>(CountMember(&error, "code"), 999));
  return response;
}

ReadResponse FromChoice(const Json& json, const Json& choice) {
  ReadResponse response;
  const Json* message = core::FindMember(choice, "message");
  const Json* content =
      message == nullptr ? core::FindMember(choice, "text") : core::FindMember(*message, "content");
  const std::string refusal = message == nullptr ? "" : core::TextMember(*message, "refusal");
  if (!refusal.empty()) {
    response.kind = ReadResponse::Kind::kError;
    response.message = "the model refuses: " + refusal;
    return response;
  }
  if (content == nullptr) return NoResponse("the answer's first choice has no content");
  response.kind = ReadResponse::Kind::kAnswer;
  response.answer.text = WithoutReasoning(ContentText(*content));
  response.answer.finish_reason = core::TextMember(choice, "finish_reason");
  const Json* usage = core::FindMember(json, "usage");
  response.answer.tokens.input = CountMember(usage, "prompt_tokens");
  response.answer.tokens.output = CountMember(usage, "completion_tokens");
  return response;
}

}  // namespace

ReadResponse ReadChatResponse(std::string_view body) {
  const std::size_t first = body.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) {
    ReadResponse empty = NoResponse("the answer is empty");
    empty.kind = ReadResponse::Kind::kTruncated;
    return empty;
  }
  bool too_deep = false;
  const std::optional<Json> parsed = core::TryParseJson(body, false, &too_deep);
  if (too_deep) return NoResponse("the answer is nested deeper than 64 levels");
  if (!parsed) {
    if (body[first] == '<') return NoResponse("the answer is HTML, not JSON");
    ReadResponse response = NoResponse("the answer is not JSON");
    if (body[first] == '{') {
      response.kind = ReadResponse::Kind::kTruncated;
      response.message = "the answer is truncated or damaged JSON";
    }
    return response;
  }
  const Json& json = *parsed;
  const Json* error = core::FindMember(json, "error");
  if (error != nullptr && !error->is_null()) return ErrorResponse(*error);
  if (core::TextMember(json, "object") == "error") return ErrorResponse(json);
  const Json* choices = core::FindMember(json, "choices");
  if (choices == nullptr || !choices->is_array() || choices->empty()) {
    ReadResponse response = NoResponse("the answer is JSON without choices");
    // FastAPI servers (vLLM) report errors in "detail".
    const Json* detail = core::FindMember(json, "detail");
    if (detail != nullptr) {
      response.kind = ReadResponse::Kind::kError;
      response.message = core::JsonLine(*detail, core::InvalidUtf8::kReplace);
    }
    return response;
  }
  return FromChoice(json, (*choices)[0]);
}

std::string WithoutReasoning(std::string_view text) {
  constexpr std::string_view kOpen = "<think>", kClose = "</think>", kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos || !text.substr(first).starts_with(kOpen)) {
    return std::string(text);
  }
  const std::size_t end = text.find(kClose, first);
  if (end == std::string_view::npos) return "";
  std::string_view answer = text.substr(end + kClose.size());
  answer.remove_prefix(std::min(answer.find_first_not_of(kBlanks), answer.size()));
  return std::string(answer);
}

}  // namespace simwright::llm
