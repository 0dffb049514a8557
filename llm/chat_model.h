#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"

namespace simwright::llm {

enum class Role { kSystem, kUser, kAssistant };

// An image in a message, sent inside the request as a data: URL.
struct ChatImage {
  std::string mime_type;  // "image/png", "image/jpeg" ...
  std::string bytes;      // the encoded image file
};

struct ChatMessage {
  Role role = Role::kUser;
  std::string text;  // UTF-8; invalid bytes are sent as the replacement character
  std::vector<ChatImage> images;
};

struct ChatRequest {
  // The purpose of the question, e.g. "physics of mug": named in errors and transcripts, but never
  // sent and not part of the request's key.
  std::string task;
  std::vector<ChatMessage> messages;
  std::optional<double> temperature;  // unset: the server's default
  std::optional<int> max_tokens;      // of the answer; unset: the server's default
  // Requests with different seeds are different requests: use it to get several answers to one
  // question, since an equal request may be answered from the cache.
  std::optional<std::uint64_t> seed;
  bool json = false;  // request one JSON object as the answer
};

struct TokenCounts {
  std::int64_t input = 0;
  std::int64_t output = 0;
};

struct ChatAnswer {
  std::string text;           // without a leading <think> block of a reasoning model
  std::string finish_reason;  // "stop"; "length" if max_tokens cut it off; may be empty
  TokenCounts tokens;         // 0 if the server does not count
  bool from_cache = false;    // from the cache or a transcript, without a request
  int attempts = 0;           // requests sent for it, including refused ones
};

// The accumulated cost of a model's answers.
struct Usage {
  std::int64_t answers = 0;
  std::int64_t from_cache = 0;  // of `answers`, those without a request
  std::int64_t attempts = 0;    // requests sent
  TokenCounts tokens;           // of the requests sent
  std::optional<double> cost;   // in the currency of the prices; unset without prices
};

// A chat model. Use it from one thread at a time.
class ChatModel {
 public:
  virtual ~ChatModel() = default;

  // Returns the answer to `request`. `progress` (may be null) gets one stage. Throws core::Error,
  // with the reason, if there is no answer, and core::Cancelled after Ctrl-C, also while waiting.
  virtual ChatAnswer Ask(const ChatRequest& request, core::Progress* progress = nullptr) = 0;

  // Returns the model's name on the server; may be empty (the server's only one).
  virtual std::string name() const = 0;
  virtual Usage usage() const = 0;
  // Returns the findings since the last call, e.g. a damaged cache entry.
  virtual core::Findings TakeFindings() = 0;
};

// Returns "system", "user" or "assistant".
const char* RoleName(Role role);

// Throws core::Error unless there is a message, every image has a type and bytes, and the numbers
// are in the ranges that servers accept (temperature 0 to 2, max_tokens >= 1).
void RequireValid(const ChatRequest& request);

}  // namespace simwright::llm
