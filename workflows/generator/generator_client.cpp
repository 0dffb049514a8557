#include "workflows/generator/generator_client.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>

#include "core/error.h"
#include "core/log.h"
#include "llm/http_client.h"
#include "llm/redaction.h"
#include "workflows/generator/generator_answer.h"
#include "workflows/generator/generator_command.h"
#include "workflows/generator/generator_request.h"

namespace simwright::workflows {
namespace {

const llm::UrlRole kGeneratorUrl = {"the generator's URL",
                                    "for example http://localhost:8081/generate"};
constexpr std::size_t kLongestQuote = 200;  // bytes of a server's message
constexpr std::size_t kShortestSecret = 6;  // shorter keys are placeholders
constexpr int kMostRedirects = 5, kMostAddresses = 4;
constexpr const char* kKeyVariable = "SIMWRIGHT_GENERATOR_KEY";

std::string Figure(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

// Returns true for the refusals of a server that expects the photo in another form.
bool RefusesForm(long status) {
  return status == 400 || status == 415 || status == 422;
}

// Returns true if `id` can stand in the path of an address.
bool IsPlainId(const std::string& id) {
  return !id.empty() && id.size() <= 200 &&
         std::all_of(
             id.begin(), id.end(),
             [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.'; }) &&
         id != "." && id != "..";
}

class GeneratorClient {
 public:
  GeneratorClient(const GeneratorOptions& options, llm::Clock& clock, core::Progress* progress)
      : options_(options), clock_(clock), progress_(progress) {
    const llm::UrlParts parts = llm::SplitUrl(options.url, kGeneratorUrl);
    host_ = parts.host;
    if (options.key.size() >= kShortestSecret) secrets_.push_back(options.key);
    if (parts.password.size() >= kShortestSecret) secrets_.push_back(parts.password);
    shown_ = llm::Redact(llm::ShownUrl(options.url), secrets_);
    if (!secrets_.empty() && parts.scheme == "http" && !llm::IsLoopback(host_)) {
      Report("generator-key-in-clear", core::Severity::kWarning,
             "the key goes to " + host_ + " over http, readable in transit; use https");
    }
  }

  GeneratedMesh Ask(std::string_view png);

 private:
  using Send = std::function<llm::HttpReply(const std::string& url, const llm::HttpLimits&)>;

  GeneratorAnswer Post(std::string_view png);
  GeneratorAnswer Get(const std::string& url);
  llm::HttpReply Exchange(std::string url, bool get, const Send& send);
  llm::HttpReply SendOnce(const std::string& url, const Send& send);
  void FollowRedirect(const llm::HttpReply& reply, bool get, std::string* url);
  void WaitToRetry(const std::string& sentence, const std::string& retry_after,
                   llm::RetrySchedule* schedule);
  std::string StateAddress(const GeneratorAnswer& answer);
  std::string AddressOf(const std::string& reference);
  std::vector<std::string> Headers(const std::string& url, const std::string& content_type) const;
  void Sleep(double seconds);
  double Left() const { return options_.timeout - spent_; }

  void Report(const std::string& code, core::Severity severity, const std::string& sentence) {
    findings_.push_back({code, severity, shown_, llm::Redact(sentence, secrets_), 0.0});
  }
  [[noreturn]] void Fail(const std::string& sentence, const std::string& remedy = "") const {
    throw core::Error(llm::Redact(sentence, secrets_), shown_, remedy);
  }
  [[noreturn]] void FailLate() const {
    Fail("no mesh arrived within " + Figure("%.3g s", options_.timeout),
         "allow more time with --generator-timeout");
  }
  // Fails unless the reply is complete.
  void RequireComplete(const llm::HttpReply& reply) const;
  [[noreturn]] void FailForStatus(const llm::HttpReply& reply) const;

  const GeneratorOptions& options_;
  llm::Clock& clock_;
  core::Progress* progress_;
  std::string host_, shown_;
  std::vector<std::string> secrets_;
  core::Findings findings_;
  std::string state_url_;  // of the task that is polled
  double spent_ = 0.0;     // s in exchanges and waits
};

std::vector<std::string> GeneratorClient::Headers(const std::string& url,
                                                  const std::string& content_type) const {
  // Without "Expect:", curl waits for a "100 Continue" that some servers never send.
  std::vector<std::string> headers = {"Accept: model/gltf-binary, application/json, */*",
                                      "Expect:"};
  if (!content_type.empty()) headers.push_back("Content-Type: " + content_type);
  if (!options_.key.empty() && llm::OriginOf(url) == llm::OriginOf(options_.url)) {
    headers.push_back("Authorization: Bearer " + options_.key);
  }
  return headers;
}

void GeneratorClient::Sleep(double seconds) {
  if (seconds >= Left()) FailLate();
  spent_ += seconds;
  clock_.Sleep(seconds);
  if (clock_.Cancelled()) throw core::Cancelled();
}

llm::HttpReply GeneratorClient::SendOnce(const std::string& url, const Send& send) {
  if (clock_.Cancelled()) throw core::Cancelled();
  if (Left() <= 0.0) FailLate();
  llm::HttpLimits limits;
  limits.connect_timeout = std::min(options_.connect_timeout, Left());
  limits.total_timeout = Left();
  limits.max_body_bytes = options_.max_answer_bytes;
  limits.no_proxy = llm::IsLoopback(llm::SplitUrl(url, kGeneratorUrl).host);
  const auto start = std::chrono::steady_clock::now();
  const llm::HttpReply reply = send(url, limits);
  spent_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return reply;
}

void GeneratorClient::RequireComplete(const llm::HttpReply& reply) const {
  switch (reply.outcome) {
    case llm::HttpOutcome::kTimedOut:
      FailLate();
    case llm::HttpOutcome::kTooLarge:
      Fail("its answer is larger than " +
               Figure("%.0f MiB", static_cast<double>(options_.max_answer_bytes) / (1 << 20)) +
               ", and the transfer was stopped",
           "have the server simplify the mesh and its textures");
    case llm::HttpOutcome::kRefused:
      Fail(reply.fault);
    default:
      break;
  }
}

void GeneratorClient::FailForStatus(const llm::HttpReply& reply) const {
  const GeneratorAnswer answer = ReadGeneratorAnswer(reply.body);
  std::string sentence = "status " + std::to_string(reply.status);
  if (!answer.message.empty() && answer.message != "empty") {
    sentence += ": " + llm::Shortened(llm::Redact(answer.message, secrets_), kLongestQuote);
  }
  std::string remedy = "the server's own log says more";
  if (reply.status == 401 || reply.status == 403) {
    remedy = std::string("set ") + kKeyVariable + " to a valid key";
  } else if (reply.status == 404 || reply.status == 405) {
    remedy = "check the path of the address, e.g. /generate, and the server's log";
  } else if (RefusesForm(reply.status)) {
    remedy = "--generator-format and --generator-field state the form of the request";
  }
  Fail(sentence, remedy);
}

void GeneratorClient::FollowRedirect(const llm::HttpReply& reply, bool get, std::string* url) {
  if (reply.redirect.empty()) Fail("the server redirects without an address");
  if (!get && llm::OriginOf(reply.redirect) != llm::OriginOf(options_.url)) {
    Fail("the server redirects to " + llm::ShownUrl(reply.redirect) +
             ", which is not the server that the photo is for",
         "give that address if you trust it");
  }
  *url = AddressOf(reply.redirect);
}

// Sends until there is a complete reply that no retry can improve.
llm::HttpReply GeneratorClient::Exchange(std::string url, bool get, const Send& send) {
  llm::RetrySchedule schedule(options_.first_wait, options_.longest_wait,
                              core::Rng(options_.jitter_seed));
  int redirects = 0;
  for (int failures = 0;;) {
    const llm::HttpReply reply = SendOnce(url, send);
    RequireComplete(reply);
    const bool answered = reply.outcome == llm::HttpOutcome::kAnswered;
    if (answered && llm::IsRedirect(reply.status)) {
      if (++redirects > kMostRedirects) Fail("the server redirects more than 5 times");
      FollowRedirect(reply, get, &url);
      continue;
    }
    if (answered && !llm::WorthAnotherTry(reply.status)) return reply;
    if (++failures == options_.max_attempts) {
      if (answered) FailForStatus(reply);
      Fail(reply.fault + ", " + std::to_string(failures) + " times in a row",
           "is the server running and reachable?");
    }
    WaitToRetry(answered ? "status " + std::to_string(reply.status) : reply.fault,
                reply.retry_after, &schedule);
  }
}

void GeneratorClient::WaitToRetry(const std::string& sentence, const std::string& retry_after,
                                  llm::RetrySchedule* schedule) {
  const double planned = schedule->NextWait();
  const double wait = llm::RetryAfterSeconds(retry_after, clock_.UnixSeconds()).value_or(planned);
  core::Log(core::LogLevel::kWarn, "generator", shown_, ": ", llm::Redact(sentence, secrets_),
            "; the next request follows in ", Figure("%.0f s", wait));
  Sleep(wait);
}

GeneratorAnswer GeneratorClient::Post(std::string_view png) {
  const auto post = [&](const GeneratorRequest& request) {
    return Exchange(options_.url, false,
                    [&](const std::string& url, const llm::HttpLimits& limits) {
                      return llm::HttpPost(url, Headers(url, request.content_type), request.body,
                                           limits, [this] { return clock_.Cancelled(); });
                    });
  };
  const bool json_first = options_.format != GeneratorFormat::kMultipart;
  llm::HttpReply reply = post(json_first ? JsonGeneratorRequest(png, options_)
                                         : MultipartGeneratorRequest(png, options_));
  if (options_.format == GeneratorFormat::kAuto && RefusesForm(reply.status)) {
    const long refusal = reply.status;
    reply = post(MultipartGeneratorRequest(png, options_));
    Report("generator-format", core::Severity::kInfo,
           "the photo was sent as multipart/form-data, because the server refused JSON with "
           "status " +
               std::to_string(refusal));
  }
  if (reply.status < 200 || reply.status > 299) FailForStatus(reply);
  return ReadGeneratorAnswer(std::move(reply.body));
}

GeneratorAnswer GeneratorClient::Get(const std::string& url) {
  llm::HttpReply reply =
      Exchange(url, true, [&](const std::string& to, const llm::HttpLimits& limits) {
        return llm::HttpGet(to, Headers(to, ""), limits, [this] { return clock_.Cancelled(); });
      });
  if (reply.status < 200 || reply.status > 299) FailForStatus(reply);
  return ReadGeneratorAnswer(std::move(reply.body));
}

// Returns the absolute address that the server names.
std::string GeneratorClient::AddressOf(const std::string& reference) {
  const std::string url = llm::ResolvedUrl(options_.url, reference);
  if (url.empty()) {
    Fail("it names an address that is no http or https address: " +
         llm::Shortened(llm::Redact(reference, secrets_), 60));
  }
  // A server elsewhere must not make this program talk to services of this machine.
  if (llm::IsLoopback(llm::SplitUrl(url, kGeneratorUrl).host) && !llm::IsLoopback(host_)) {
    Fail("it names an address on this machine, " + llm::ShownUrl(url) + ", which is not followed");
  }
  return url;
}

std::string GeneratorClient::StateAddress(const GeneratorAnswer& answer) {
  if (!state_url_.empty()) return state_url_;
  if (!answer.address.empty()) return AddressOf(answer.address);
  if (!IsPlainId(answer.task)) {
    Fail("it began a task, state '" + llm::Shortened(answer.state, 40) +
             "', without an id that can be polled",
         "the server's documentation says how its tasks are polled");
  }
  if (!options_.status_url.empty()) {
    std::string url = options_.status_url;
    const std::size_t at = url.find("{id}");
    if (at != std::string::npos) url.replace(at, 4, answer.task);
    return AddressOf(url);
  }
  return AddressOf("status/" + answer.task);
}

GeneratedMesh GeneratorClient::Ask(std::string_view png) {
  progress_->Stage("generator " + host_);
  core::Log(core::LogLevel::kInfo, "generator", "posting ", png.size(), " bytes to ", shown_);
  GeneratorAnswer answer = Post(png);
  for (int addresses = 0;;) {
    switch (answer.kind) {
      case GeneratorAnswer::Kind::kMesh:
        core::Log(core::LogLevel::kInfo, "generator", "received ", answer.mesh.size(), " bytes");
        progress_->Finish();
        return {std::move(answer.mesh), answer.extension, shown_, std::move(findings_)};
      case GeneratorAnswer::Kind::kAddress:
        if (++addresses > kMostAddresses) Fail("it names one address after the other, no mesh");
        answer = Get(AddressOf(answer.address));
        break;
      case GeneratorAnswer::Kind::kTask:
        state_url_ = StateAddress(answer);
        progress_->Say(llm::Shortened(llm::Redact(answer.state, secrets_), 40), Left());
        Sleep(options_.poll_wait);
        answer = Get(state_url_);
        break;
      case GeneratorAnswer::Kind::kFailed:
        Fail("the generator failed: " +
                 llm::Shortened(llm::Redact(answer.message, secrets_), kLongestQuote),
             "the server's own log says more");
      case GeneratorAnswer::Kind::kUnusable:
        Fail("its answer is " +
                 llm::Shortened(llm::Redact(answer.message, secrets_), kLongestQuote) +
                 ", expected a GLB, OBJ or PLY",
             "check the path of the address, e.g. /generate");
    }
  }
}

bool IsFieldName(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '-' || c == '_' || c == '.' || c == '[' || c == ']';
  });
}

}  // namespace

GeneratedMesh AskGeneratorServer(std::string_view png, const GeneratorOptions& options,
                                 core::Progress* progress, llm::Clock& clock) {
  Validate(options);
  return GeneratorClient(options, clock, progress).Ask(png);
}

void Validate(const GeneratorOptions& options) {
  if (!options.url.empty() && !options.command.empty()) {
    throw core::Error("exclude each other", "--generator and --generator-command");
  }
  if (!options.url.empty()) llm::SplitUrl(options.url, kGeneratorUrl);
  if (!options.command.empty()) GeneratorArguments(options.command, "in", "out");
  if (!(options.timeout > 0.0 && std::isfinite(options.timeout) && options.timeout <= 86400.0)) {
    throw core::Error("must be above 0 s and at most a day", "--generator-timeout");
  }
  const bool blank = std::any_of(options.key.begin(), options.key.end(),
                                 [](unsigned char c) { return c <= 0x20 || c == 0x7f; });
  if (blank) throw core::Error("contains a blank or a line break", kKeyVariable);
  bool names = IsFieldName(options.field);
  for (const auto& [name, value] : options.parameters) names = names && IsFieldName(name);
  if (!names) {
    throw core::Error("a field's name has letters, digits, '-', '_', '.', '[' and ']'",
                      "--generator-field and --generator-parameter");
  }
  if (!options.status_url.empty() && options.status_url.find("{id}") == std::string::npos) {
    throw core::Error("has no {id}", "--generator-status",
                      "for example http://localhost:8081/status/{id}");
  }
}

}  // namespace simwright::workflows
