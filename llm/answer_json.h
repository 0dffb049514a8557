#pragma once

#include "core/json.h"
#include "llm/chat_model.h"

namespace simwright::llm {

// Returns an answer's JSON form in cache and transcript: text, finish_reason, tokens.
core::OrderedJson AnswerToJson(const ChatAnswer& answer);

// Parses an answer. Returns false and leaves `answer` unchanged if `json` is not such an object.
bool AnswerFromJson(const core::Json& json, ChatAnswer* answer);

}  // namespace simwright::llm
