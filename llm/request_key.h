#pragma once

#include <string>
#include <string_view>

#include "llm/chat_model.h"

namespace simwright::llm {

// All of `request` but its task, as one line of JSON with sorted keys: equal requests give equal
// text. A picture is there as its type, size and hash. Holds no address and no key.
std::string CanonicalRequest(const ChatRequest& request);

// The first words of the last user message, at most 60 bytes on one line: how a person knows a
// request again.
std::string FirstWords(const ChatRequest& request);

}  // namespace simwright::llm
