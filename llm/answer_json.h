#pragma once

#include <nlohmann/json_fwd.hpp>

#include "llm/chat_model.h"

namespace simwright::llm {

// An answer as cache and transcript keep it: text, finish_reason, tokens.
nlohmann::ordered_json AnswerToJson(const ChatAnswer& answer);

// False, and `answer` untouched, where `json` is no such object.
bool AnswerFromJson(const nlohmann::json& json, ChatAnswer* answer);

}  // namespace simwright::llm
