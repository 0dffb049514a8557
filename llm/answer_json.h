#pragma once

#include <nlohmann/json_fwd.hpp>

#include "llm/chat_model.h"

namespace simwright::llm {

// Returns an answer's JSON form in cache and transcript: text, finish_reason, tokens.
nlohmann::ordered_json AnswerToJson(const ChatAnswer& answer);

// Parses an answer. Returns false and leaves `answer` unchanged if `json` is not such an object.
bool AnswerFromJson(const nlohmann::json& json, ChatAnswer* answer);

}  // namespace simwright::llm
