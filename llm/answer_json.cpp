#include "llm/answer_json.h"

#include <algorithm>
#include <cstdint>

namespace simwright::llm {

core::OrderedJson AnswerToJson(const ChatAnswer& answer) {
  return {{"text", answer.text},
          {"finish_reason", answer.finish_reason},
          {"input_tokens", answer.tokens.input},
          {"output_tokens", answer.tokens.output}};
}

bool AnswerFromJson(const core::Json& json, ChatAnswer* answer) {
  const core::Json* text = core::FindMember(json, "text");
  if (text == nullptr || !text->is_string()) return false;
  const auto count = [&](const char* name) -> std::int64_t {
    const core::Json* found = core::FindMember(json, name);
    if (found == nullptr || !found->is_number_unsigned()) return 0;
    return static_cast<std::int64_t>(
        std::min<std::uint64_t>(found->get<std::uint64_t>(), 1u << 30));
  };
  ChatAnswer read;
  read.text = text->get<std::string>();
  read.finish_reason = core::TextMember(json, "finish_reason");
  read.tokens = {count("input_tokens"), count("output_tokens")};
  read.from_cache = true;
  *answer = std::move(read);
  return true;
}

}  // namespace simwright::llm
