#pragma once

#include <string>

#include "llm/chat_model.h"

namespace simwright::llm {

// The protocol features that a server supports; narrowed as it refuses them.
struct Dialect {
  bool json_mode = true;    // response_format json_object
  bool temperature = true;  // reasoning models allow only their default
  bool seed = true;
  bool max_completion_tokens = false;  // the newer name of max_tokens
};

// Returns the body of POST /chat/completions: one JSON object in UTF-8. `model` is omitted if
// empty.
std::string RequestBody(const ChatRequest& request, const std::string& model,
                        const Dialect& dialect);

// Disables the optional field of `request` that the server's refusal (status 400 or 422, with this
// message) names. Returns a sentence about the disabled field; empty if there is none and the
// request itself is at fault.
std::string Narrow(const std::string& message, const ChatRequest& request, Dialect* dialect);

}  // namespace simwright::llm
