#pragma once

#include <string>
#include <string_view>

#include "llm/chat_model.h"

namespace simwright::llm {

// What the body of a reply turned out to be.
struct ReadResponse {
  enum class Kind {
    kAnswer,
    kTruncated,   // begins as JSON and does not end: worth another try
    kError,       // an error object, under whatever status
    kNoResponse,  // something else: HTML, plain text, JSON of another kind
  };
  Kind kind = Kind::kNoResponse;
  ChatAnswer answer;       // kAnswer: text, finish_reason and tokens are set
  std::string message;     // else: the server's message, or what is wrong with the body
  std::string error_code;  // kError: its code or type, e.g. "insufficient_quota"; may be empty
  int error_status = 0;    // kError: a numeric code inside, as gateways put it; else 0
};

// Reads the body of POST /chat/completions. Never throws for what is in `body`.
ReadResponse ReadChatResponse(std::string_view body);

// `text` without a <think>...</think> block at its start. An open one takes all of the text: the
// answer was cut off before it began.
std::string WithoutReasoning(std::string_view text);

}  // namespace simwright::llm
