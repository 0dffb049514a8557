#pragma once

#include <string>

#include "llm/chat_model.h"

namespace simwright::llm {

// What a server understands of the protocol; narrowed as it refuses parts of it.
struct Dialect {
  bool json_mode = true;    // response_format json_object
  bool temperature = true;  // models that reason allow only their own
  bool seed = true;
  bool max_completion_tokens = false;  // the newer name of max_tokens
};

// The body of POST /chat/completions: one JSON object in UTF-8. `model` is left out when empty.
std::string RequestBody(const ChatRequest& request, const std::string& model,
                        const Dialect& dialect);

// Takes back what the server's refusal (status 400 or 422, with this message) names among the
// optional fields that `request` used. Returns a sentence about what was given up; empty: nothing,
// the request itself is at fault.
std::string Narrow(const std::string& message, const ChatRequest& request, Dialect* dialect);

}  // namespace simwright::llm
