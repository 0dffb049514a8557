#include "llm/answer_json.h"

#include <algorithm>
#include <cstdint>

#include <nlohmann/json.hpp>

namespace simwright::llm {

nlohmann::ordered_json AnswerToJson(const ChatAnswer& answer) {
  return {{"text", answer.text},
          {"finish_reason", answer.finish_reason},
          {"input_tokens", answer.tokens.input},
          {"output_tokens", answer.tokens.output}};
}

bool AnswerFromJson(const nlohmann::json& json, ChatAnswer* answer) {
  if (!json.is_object()) return false;
  const auto text = json.find("text");
  if (text == json.end() || !text->is_string()) return false;
  const auto count = [&](const char* name) -> std::int64_t {
    const auto found = json.find(name);
    if (found == json.end() || !found->is_number_unsigned()) return 0;
    return static_cast<std::int64_t>(
        std::min<std::uint64_t>(found->get<std::uint64_t>(), 1u << 30));
  };
  ChatAnswer read;
  read.text = text->get<std::string>();
  const auto reason = json.find("finish_reason");
  if (reason != json.end() && reason->is_string()) read.finish_reason = reason->get<std::string>();
  read.tokens = {count("input_tokens"), count("output_tokens")};
  read.from_cache = true;
  *answer = std::move(read);
  return true;
}

}  // namespace simwright::llm
