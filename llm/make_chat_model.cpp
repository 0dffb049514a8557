#include "llm/make_chat_model.h"

#include <utility>

#include "core/error.h"
#include "llm/answer_cache.h"
#include "llm/openai_chat_model.h"
#include "llm/redaction.h"
#include "llm/transcript.h"

namespace simwright::llm {

std::unique_ptr<ChatModel> MakeChatModel(const ChatModelOptions& options) {
  std::string fault;
  if (!options.IsValid(&fault)) {
    throw core::Error(Redact(fault, Secrets(options)), "the LLM's options");
  }
  if (!options.replay.empty()) return std::make_unique<ReplayChatModel>(options.replay);
  std::unique_ptr<ChatModel> model = std::make_unique<OpenAiChatModel>(options);
  if (!options.cache.empty()) {
    const std::string identity =
        options.model.empty() ? Redact(ResolveEndpoint(options.url).shown, Secrets(options)) : "";
    model = std::make_unique<CachingChatModel>(std::move(model), options.cache, identity);
  }
  if (!options.record.empty()) {
    model = std::make_unique<RecordingChatModel>(std::move(model), options.record,
                                                 options.replace_record);
  }
  return model;
}

}  // namespace simwright::llm
