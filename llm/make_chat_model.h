#pragma once

#include <memory>

#include "llm/chat_model.h"
#include "llm/chat_model_options.h"

namespace simwright::llm {

// The model that `options` describe: a transcript's (replay), else the server's, through the cache
// and onto the record where those are given. Sends nothing. Throws core::Error where the options
// are not valid, or a folder or transcript is not there.
std::unique_ptr<ChatModel> MakeChatModel(const ChatModelOptions& options);

}  // namespace simwright::llm
