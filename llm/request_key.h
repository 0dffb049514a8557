#pragma once

#include <string>
#include <string_view>

#include "llm/chat_model.h"

namespace simwright::llm {

// Returns `request` without its task as one line of JSON with sorted keys: equal requests give
// equal text. An image is represented by its type, size and hash. Contains no address and no key.
std::string CanonicalRequest(const ChatRequest& request);

// Returns the first words of the last user message, at most 60 bytes on one line, by which a person
// recognises a request.
std::string FirstWords(const ChatRequest& request);

}  // namespace simwright::llm
