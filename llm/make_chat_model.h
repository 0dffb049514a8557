#pragma once

#include <memory>

#include "llm/chat_model.h"
#include "llm/chat_model_options.h"

namespace simwright::llm {

// Creates the model that `options` describe: a transcript's (replay), else the server's, with cache
// and recording if those are set. Sends nothing. Throws core::Error if the options are invalid, or
// a folder or transcript is missing.
std::unique_ptr<ChatModel> MakeChatModel(const ChatModelOptions& options);

}  // namespace simwright::llm
