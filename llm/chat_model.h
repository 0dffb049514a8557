#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"

namespace simwright::llm {

enum class Role { kSystem, kUser, kAssistant };

// A picture in a message; it travels inside the request as a data: URL.
struct ChatImage {
  std::string mime_type;  // "image/png", "image/jpeg" ...
  std::string bytes;      // the picture file as it is
};

struct ChatMessage {
  Role role = Role::kUser;
  std::string text;  // UTF-8; what is not is sent as the replacement character
  std::vector<ChatImage> images;
};

struct ChatRequest {
  // What the question is for, e.g. "physics of mug": named in errors and transcripts, never sent
  // and no part of the request's key.
  std::string task;
  std::vector<ChatMessage> messages;
  std::optional<double> temperature;  // unset: the server's own
  std::optional<int> max_tokens;      // of the answer; unset: the server's own
  // Another seed is another request: how several answers to one question are asked for, since an
  // equal request may be answered from the cache.
  std::optional<std::uint64_t> seed;
  bool json = false;  // the answer should be one JSON object
};

struct TokenCounts {
  std::int64_t input = 0;
  std::int64_t output = 0;
};

struct ChatAnswer {
  std::string text;           // without a leading <think> block of a reasoning model
  std::string finish_reason;  // "stop"; "length" where max_tokens cut it off; may be empty
  TokenCounts tokens;         // 0 where the server does not count
  bool from_cache = false;    // from the cache or a transcript: nothing was sent
  int attempts = 0;           // requests sent for it, refused ones included
};

// What a model's answers have cost so far.
struct Usage {
  std::int64_t answers = 0;
  std::int64_t from_cache = 0;  // those of `answers` for which nothing was sent
  std::int64_t attempts = 0;    // requests sent
  TokenCounts tokens;           // of what was sent
  std::optional<double> cost;   // in the currency of the prices; unset without prices
};

// Something that answers chats. One thread at a time.
class ChatModel {
 public:
  virtual ~ChatModel() = default;

  // The answer to `request`. `progress` (may be null) gets one stage. Throws core::Error where no
  // answer can be had, saying why, and core::Cancelled after Ctrl-C, also while it waits.
  virtual ChatAnswer Ask(const ChatRequest& request, core::Progress* progress = nullptr) = 0;

  // The model's name as the server knows it; may be empty (the server's only one).
  virtual std::string name() const = 0;
  virtual Usage usage() const = 0;
  // What there was to report since the last call, e.g. a damaged cache entry.
  virtual core::Findings TakeFindings() = 0;
};

// "system", "user" or "assistant".
const char* RoleName(Role role);

// Throws core::Error unless there is a message, every image has a type and bytes, and the numbers
// lie in the ranges that servers take (temperature 0 to 2, max_tokens >= 1).
void RequireValid(const ChatRequest& request);

}  // namespace simwright::llm
