#include "llm/openai_chat_model.h"

#include <cstdio>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "llm/redaction.h"

namespace simwright::llm {
namespace {

constexpr std::size_t kLongestQuote = 300;  // bytes of a server's message

std::string Seconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.0f s", seconds);
  return text;
}

}  // namespace

OpenAiChatModel::OpenAiChatModel(const ChatModelOptions& options, Clock& clock)
    : options_(options), clock_(clock), rng_(options.jitter_seed) {
  std::string fault;
  if (!options_.IsValid(&fault)) {
    throw core::Error(Redact(fault, Secrets(options_)), "the LLM's options");
  }
  endpoint_ = ResolveEndpoint(options_.url);
  secrets_ = Secrets(options_);
  address_ = endpoint_.address;
  endpoint_.shown = Redact(endpoint_.shown, secrets_);
  if (options_.input_price) usage_.cost = 0.0;
  if (!secrets_.empty() && !endpoint_.https && !endpoint_.loopback) {
    Report("llm-key-in-clear", core::Severity::kWarning,
           "the key goes to " + endpoint_.host + " over http, readable in transit; use https");
  }
}

ChatAnswer OpenAiChatModel::Ask(const ChatRequest& request, core::Progress* progress) {
  RequireValid(request);
  for (const ChatMessage& message : request.messages) {
    if (Redact(message.text, secrets_) != message.text) {
      Fail(request.task, "the question itself contains the server's key", "remove it");
    }
  }
  if (progress != nullptr) {
    progress->Stage("asking " + (options_.model.empty() ? endpoint_.host : options_.model));
  }
  LogExchange(core::LogLevel::kInfo, request.task, "asking " + options_.model);
  RetrySchedule schedule(options_.first_wait, options_.longest_wait, core::Rng(rng_()));
  redirects_ = 0;
  int attempts = 0;
  for (int failures = 0;;) {
    if (clock_.Cancelled()) throw core::Cancelled();
    const HttpReply reply = Post(request);
    ++attempts;
    ++usage_.attempts;
    Verdict verdict = Judge(reply, request);
    switch (verdict.kind) {
      case Verdict::Kind::kAnswer:
        verdict.answer.attempts = attempts;
        Account(verdict.answer);
        LogExchange(core::LogLevel::kInfo, request.task,
                    "answered after " + std::to_string(attempts) + " requests, " +
                        std::to_string(verdict.answer.tokens.output) + " tokens");
        return verdict.answer;
      case Verdict::Kind::kAgainAtOnce:
        break;
      case Verdict::Kind::kAgainLater:
        if (++failures == options_.max_attempts) {
          Fail(request.task, verdict.sentence + ", " + std::to_string(failures) + " times in a row",
               verdict.remedy);
        }
        WaitBeforeNext(verdict, request.task, &schedule);
        break;
      case Verdict::Kind::kFail:
        Fail(request.task, verdict.sentence, verdict.remedy);
    }
  }
}

HttpReply OpenAiChatModel::Post(const ChatRequest& request) {
  // Disable "Expect: 100-continue": some servers never answer it, which costs a second.
  std::vector<std::string> headers = {"Content-Type: application/json", "Accept: application/json",
                                      "Expect:"};
  if (!options_.key.empty()) headers.push_back("Authorization: Bearer " + options_.key);
  HttpLimits limits;
  limits.connect_timeout = options_.connect_timeout;
  limits.stall_timeout = options_.stall_timeout;
  limits.total_timeout = options_.total_timeout;
  limits.max_body_bytes = options_.max_answer_bytes;
  limits.no_proxy = endpoint_.loopback;
  return HttpPost(address_, headers, RequestBody(request, options_.model, dialect_), limits,
                  [this] { return clock_.Cancelled(); });
}

OpenAiChatModel::Verdict OpenAiChatModel::Judge(const HttpReply& reply,
                                                const ChatRequest& request) {
  Verdict verdict;
  verdict.retry_after = reply.retry_after;
  switch (reply.outcome) {
    case HttpOutcome::kBroken:
      verdict.kind = Verdict::Kind::kAgainLater;
      verdict.sentence = reply.fault;
      verdict.remedy = "is the server running and reachable?";
      return verdict;
    case HttpOutcome::kTimedOut:
      verdict.sentence = reply.fault + " (" + Seconds(options_.total_timeout) + ")";
      verdict.remedy = "allow more time, or use a smaller model";
      return verdict;
    case HttpOutcome::kTooLarge:
    case HttpOutcome::kRefused:
      verdict.sentence = reply.fault;
      return verdict;
    case HttpOutcome::kAnswered:
      break;
  }
  if (IsRedirect(reply.status)) return JudgeRedirect(reply);
  ReadResponse response = ReadChatResponse(reply.body);
  const bool good = reply.status >= 200 && reply.status < 300;
  if (!good || response.kind == ReadResponse::Kind::kError) {
    return JudgeRefusal(reply, response, request);
  }
  if (response.kind == ReadResponse::Kind::kTruncated) {
    verdict.kind = Verdict::Kind::kAgainLater;
    verdict.sentence = response.message;
  } else if (response.kind == ReadResponse::Kind::kNoResponse) {
    verdict.sentence = response.message + ": " + Shortened(Redact(reply.body, secrets_), 80);
    verdict.remedy = "is this the address of a chat server? It usually ends in /v1";
  } else {
    verdict.kind = Verdict::Kind::kAnswer;
    verdict.answer = std::move(response.answer);
    verdict.answer.text = Redact(verdict.answer.text, secrets_);
    verdict.answer.finish_reason = Redact(verdict.answer.finish_reason, secrets_);
  }
  return verdict;
}

OpenAiChatModel::Verdict OpenAiChatModel::JudgeRedirect(const HttpReply& reply) {
  Verdict verdict;
  if (reply.redirect.empty()) {
    verdict.sentence = "the server redirects without an address";
  } else if (OriginOf(reply.redirect) != endpoint_.origin) {
    verdict.sentence = "the server redirects to " + ShownUrl(reply.redirect) +
                       ", which is not the server that the key is for";
    verdict.remedy = "give that address if you trust it";
  } else if (++redirects_ > options_.max_redirects) {
    verdict.sentence =
        "the server redirects more than " + std::to_string(options_.max_redirects) + " times";
  } else {
    address_ = reply.redirect;
    verdict.kind = Verdict::Kind::kAgainAtOnce;
  }
  return verdict;
}

OpenAiChatModel::Verdict OpenAiChatModel::JudgeRefusal(const HttpReply& reply,
                                                       const ReadResponse& response,
                                                       const ChatRequest& request) {
  Verdict verdict;
  verdict.retry_after = reply.retry_after;
  const bool explained = response.kind == ReadResponse::Kind::kError;
  const std::string message = explained ? response.message : reply.body;
  const long status = reply.status < 400 ? response.error_status : reply.status;
  if (status == 400 || status == 422) {
    const std::string given_up = Narrow(message, request, &dialect_);
    if (!given_up.empty()) {
      Report("llm-narrower-server", core::Severity::kInfo, given_up);
      verdict.kind = Verdict::Kind::kAgainAtOnce;
      return verdict;
    }
  }
  const std::string quote = Shortened(Redact(message, secrets_), kLongestQuote);
  verdict.sentence = status == 0 ? "the server refuses" : "status " + std::to_string(status);
  if (!quote.empty()) verdict.sentence += ": " + quote;
  // Waiting does not restore a used-up quota.
  const bool spent = response.error_code == "insufficient_quota";
  if (WorthAnotherTry(status) && !spent) verdict.kind = Verdict::Kind::kAgainLater;
  if (status == 401 || status == 403) verdict.remedy = "set SIMWRIGHT_LLM_KEY to a valid key";
  if (status == 404) verdict.remedy = "check the address, usually .../v1, and the model's name";
  return verdict;
}

void OpenAiChatModel::WaitBeforeNext(const Verdict& verdict, const std::string& task,
                                     RetrySchedule* schedule) {
  const double planned = schedule->NextWait();
  const double wait =
      RetryAfterSeconds(verdict.retry_after, clock_.UnixSeconds()).value_or(planned);
  if (wait > options_.longest_retry_after) {
    Fail(task,
         verdict.sentence + "; it asks for a retry in " + Seconds(wait) + ", beyond the " +
             Seconds(options_.longest_retry_after) + " limit",
         "try again later");
  }
  LogExchange(core::LogLevel::kWarn, task,
              verdict.sentence + "; the next request follows in " + Seconds(wait));
  clock_.Sleep(wait);
  if (clock_.Cancelled()) throw core::Cancelled();
}

void OpenAiChatModel::Account(const ChatAnswer& answer) {
  ++usage_.answers;
  usage_.tokens.input += answer.tokens.input;
  usage_.tokens.output += answer.tokens.output;
  if (usage_.cost) {
    *usage_.cost += (static_cast<double>(answer.tokens.input) * *options_.input_price +
                     static_cast<double>(answer.tokens.output) * *options_.output_price) /
                    1e6;
  }
}

void OpenAiChatModel::LogExchange(core::LogLevel level, const std::string& task,
                                  const std::string& sentence) const {
  if (!core::IsLogged(level)) return;
  const std::string about = task.empty() ? "" : " (" + task + ")";
  core::Log(level, "llm", Redact(endpoint_.shown + about + ": " + sentence, secrets_));
}

void OpenAiChatModel::Fail(const std::string& task, const std::string& sentence,
                           const std::string& remedy) const {
  const std::string about = task.empty() ? "" : " (" + task + ")";
  throw core::Error(Redact(sentence, secrets_), endpoint_.shown + about, remedy);
}

void OpenAiChatModel::Report(const std::string& code, core::Severity severity,
                             const std::string& sentence) {
  findings_.push_back({code, severity, endpoint_.shown, sentence, 0.0});
}

core::Findings OpenAiChatModel::TakeFindings() {
  return std::exchange(findings_, {});
}

}  // namespace simwright::llm
