#pragma once

#include <string>
#include <vector>

#include "core/log.h"
#include "llm/chat_model.h"
#include "llm/chat_model_options.h"
#include "llm/http_client.h"
#include "llm/request_body.h"
#include "llm/response_reader.h"
#include "llm/retry_schedule.h"

namespace simwright::llm {

// A client of OpenAI's chat completions protocol: llama.cpp, Ollama, vLLM, OpenAI and others.
// Status 429 and 5xx, broken connections and truncated answers are retried, with growing waits or
// as Retry-After says; every other refusal fails at once with the server's message. An optional
// field that the server refuses (JSON mode, seed, temperature) is omitted from then on. The key is
// sent to `options.url`'s own scheme, host and port only, and appears in no answer, error or
// finding.
class OpenAiChatModel final : public ChatModel {
 public:
  // Throws core::Error unless the options are valid. Sends nothing. `clock` must outlive the model.
  explicit OpenAiChatModel(const ChatModelOptions& options, Clock& clock = SystemClock());

  ChatAnswer Ask(const ChatRequest& request, core::Progress* progress = nullptr) override;
  std::string name() const override { return options_.model; }
  Usage usage() const override { return usage_; }
  core::Findings TakeFindings() override;

 private:
  // The action after a reply.
  struct Verdict {
    enum class Kind { kAnswer, kAgainAtOnce, kAgainLater, kFail };
    Kind kind = Kind::kFail;
    ChatAnswer answer;
    std::string sentence;     // the reason, unless answered
    std::string remedy;       // may be empty
    std::string retry_after;  // the header; may be empty
  };

  Verdict Judge(const HttpReply& reply, const ChatRequest& request);
  Verdict JudgeRedirect(const HttpReply& reply);
  Verdict JudgeRefusal(const HttpReply& reply, const ReadResponse& response,
                       const ChatRequest& request);
  HttpReply Post(const ChatRequest& request);
  void WaitBeforeNext(const Verdict& verdict, const std::string& task, RetrySchedule* schedule);
  void Account(const ChatAnswer& answer);
  // Logs what happens to a question, without the server's key.
  void LogExchange(core::LogLevel level, const std::string& task,
                   const std::string& sentence) const;
  [[noreturn]] void Fail(const std::string& task, const std::string& sentence,
                         const std::string& remedy) const;
  void Report(const std::string& code, core::Severity severity, const std::string& sentence);

  ChatModelOptions options_;
  Endpoint endpoint_;
  std::vector<std::string> secrets_;
  Clock& clock_;
  core::Rng rng_;
  std::string address_;  // endpoint_.address, or its redirect within the same origin
  int redirects_ = 0;    // of the current question
  Dialect dialect_;
  Usage usage_;
  core::Findings findings_;
};

}  // namespace simwright::llm
