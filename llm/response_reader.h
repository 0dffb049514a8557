#pragma once

#include <string>
#include <string_view>

#include "llm/chat_model.h"

namespace simwright::llm {

// The content of a reply's body.
struct ReadResponse {
  enum class Kind {
    kAnswer,
    kTruncated,   // JSON that does not end: may be retried
    kError,       // an error object, whatever the status
    kNoResponse,  // anything else: HTML, plain text, JSON of another kind
  };
  Kind kind = Kind::kNoResponse;
  ChatAnswer answer;       // kAnswer: text, finish_reason and tokens are set
  std::string message;     // otherwise: the server's message, or the fault of the body
  std::string error_code;  // kError: its code or type, e.g. "insufficient_quota"; may be empty
  int error_status = 0;    // kError: a numeric code in the object, as from gateways; else 0
};

// Reads the body of a reply to POST /chat/completions. Never throws, whatever `body` contains.
ReadResponse ReadChatResponse(std::string_view body);

// Returns `text` without a leading <think>...</think> block. An unclosed block removes all of the
// text: the answer was cut off before it began.
std::string WithoutReasoning(std::string_view text);

}  // namespace simwright::llm
