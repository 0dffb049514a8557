#include "llm/chat_model.h"

#include "core/error.h"

namespace simwright::llm {

const char* RoleName(Role role) {
  switch (role) {
    case Role::kSystem:
      return "system";
    case Role::kAssistant:
      return "assistant";
    default:
      return "user";
  }
}

void RequireValid(const ChatRequest& request) {
  const std::string where = request.task.empty() ? "chat request" : request.task;
  if (request.messages.empty()) throw core::Error("there is no message to send", where);
  for (const ChatMessage& message : request.messages) {
    for (const ChatImage& image : message.images) {
      if (image.bytes.empty()) throw core::Error("an image is empty", where);
      if (image.mime_type.rfind("image/", 0) != 0) {
        throw core::Error("'" + image.mime_type + "' is not an image type", where);
      }
    }
  }
  if (request.temperature && !(*request.temperature >= 0.0 && *request.temperature <= 2.0)) {
    throw core::Error("the temperature is outside 0 to 2", where);
  }
  if (request.max_tokens && *request.max_tokens < 1) {
    throw core::Error("max_tokens is less than 1", where);
  }
}

}  // namespace simwright::llm
