#include "texture/endpoints/endpoint_connection.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "core/progress.h"
#include "llm/redaction.h"

namespace simwright::texture {
namespace {

constexpr std::size_t kShortestSecret = 6;  // shorter keys are placeholders
constexpr std::size_t kLongestQuote = 200;  // bytes of a server's message
constexpr int kMostRedirects = 5;
constexpr const char* kKeyVariable = "SIMWRIGHT_IMAGE_KEY";

std::string SecondsText(double seconds) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g s", seconds);
  return text;
}

}  // namespace

const llm::UrlRole& ImageServerUrl() {
  static const llm::UrlRole role = {"the image server's URL", "for example http://localhost:7860"};
  return role;
}

EndpointConnection::EndpointConnection(const ImageGeneratorOptions& options, llm::Clock& clock)
    : options_(options), clock_(clock) {
  const llm::UrlParts parts = llm::SplitUrl(options_.url, ImageServerUrl());
  host_ = parts.host;
  path_ = parts.path;
  while (!path_.empty() && path_.back() == '/') path_.pop_back();
  if (options_.key.size() >= kShortestSecret) secrets_.push_back(options_.key);
  if (parts.password.size() >= kShortestSecret) secrets_.push_back(parts.password);
  shown_ = llm::Redact(llm::ShownUrl(options_.url), secrets_);
  if (!secrets_.empty() && parts.scheme == "http" && !llm::IsLoopback(host_)) {
    Report("image-server-key-in-clear", core::Severity::kWarning,
           "the key goes to " + host_ + " over http, readable in transit; use https");
  }
}

std::string EndpointConnection::AddressOf(const std::string& path) const {
  const std::size_t query = path.find('?');
  std::string url = llm::WithPath(options_.url, path_ + path.substr(0, query));
  if (query != std::string::npos) {
    url += (url.find('?') == std::string::npos ? '?' : '&') + path.substr(query + 1);
  }
  return url;
}

std::vector<std::string> EndpointConnection::Headers(const std::string& url,
                                                     const std::string& content_type) const {
  // Without "Expect:", curl waits for a "100 Continue" that some servers never send.
  std::vector<std::string> headers = {"Accept: */*", "Expect:"};
  if (!content_type.empty()) headers.push_back("Content-Type: " + content_type);
  if (!options_.key.empty() && llm::OriginOf(url) == llm::OriginOf(options_.url)) {
    headers.push_back("Authorization: Bearer " + options_.key);
  }
  return headers;
}

void EndpointConnection::Sleep(double seconds) {
  if (spent_ + seconds >= options_.timeout) FailLate();
  spent_ += seconds;
  clock_.Sleep(seconds);
  if (clock_.Cancelled()) throw core::Cancelled();
}

llm::HttpReply EndpointConnection::SendOnce(const std::string& url, const Send& send) {
  if (clock_.Cancelled()) throw core::Cancelled();
  const double left = options_.timeout - spent_;
  if (left <= 0.0) FailLate();
  llm::HttpLimits limits;
  limits.connect_timeout = std::min(options_.connect_timeout, left);
  limits.total_timeout = left;
  limits.max_body_bytes = options_.max_answer_bytes;
  limits.no_proxy = llm::IsLoopback(llm::SplitUrl(url, ImageServerUrl()).host);
  const auto start = std::chrono::steady_clock::now();
  llm::HttpReply reply = send(url, limits);
  spent_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return reply;
}

void EndpointConnection::RequireComplete(const llm::HttpReply& reply) const {
  switch (reply.outcome) {
    case llm::HttpOutcome::kTimedOut:
      FailLate();
    case llm::HttpOutcome::kTooLarge:
      Fail("its answer is larger than " + std::to_string(options_.max_answer_bytes >> 20) +
               " MiB, and the transfer was stopped",
           "have the server make smaller pictures");
    case llm::HttpOutcome::kRefused:
      Fail(reply.fault);
    default:
      break;
  }
}

// A server elsewhere must not make this program talk to services of this machine.
void EndpointConnection::RequireForeignAddress(const std::string& url) const {
  if (llm::IsLoopback(llm::SplitUrl(url, ImageServerUrl()).host) && !llm::IsLoopback(host_)) {
    Fail("it names an address on this machine, " + llm::ShownUrl(url) + ", which is not followed");
  }
}

std::string EndpointConnection::FollowedAddress(const llm::HttpReply& reply, bool get) const {
  if (reply.redirect.empty()) Fail("the server redirects without an address");
  if (!get && llm::OriginOf(reply.redirect) != llm::OriginOf(options_.url)) {
    Fail("the server redirects to " + llm::ShownUrl(reply.redirect) +
             ", which is not the server that the request is for",
         "give that address if you trust it");
  }
  RequireForeignAddress(reply.redirect);
  return reply.redirect;
}

// Sends until there is a complete reply that no retry can improve.
std::string EndpointConnection::Exchange(const std::string& first_url, bool get, const Send& send) {
  llm::RetrySchedule schedule(options_.first_wait, options_.longest_wait,
                              core::Rng(options_.jitter_seed));
  std::string url = first_url;
  int redirects = 0;
  for (int failures = 0;;) {
    llm::HttpReply reply = SendOnce(url, send);
    RequireComplete(reply);
    const bool answered = reply.outcome == llm::HttpOutcome::kAnswered;
    if (answered && llm::IsRedirect(reply.status)) {
      if (++redirects > kMostRedirects) Fail("the server redirects more than 5 times");
      url = FollowedAddress(reply, get);
      continue;
    }
    if (answered && reply.status >= 200 && reply.status <= 299) return std::move(reply.body);
    if (answered && !llm::WorthAnotherTry(reply.status)) FailForStatus(reply);
    // A refusal of the content is final, whatever its status.
    if (answered && SpeaksOfContentFilter(MessageInAnswer(reply.body))) FailForStatus(reply);
    if (++failures == options_.max_attempts) {
      if (answered) FailForStatus(reply);
      Fail(reply.fault + ", " + std::to_string(failures) + " times in a row",
           "is the server running and reachable?");
    }
    const double planned = schedule.NextWait();
    const double wait =
        llm::RetryAfterSeconds(reply.retry_after, clock_.UnixSeconds()).value_or(planned);
    core::Log(
        core::LogLevel::kWarn, "texture", shown_, ": ",
        answered ? "status " + std::to_string(reply.status) : llm::Redact(reply.fault, secrets_),
        "; the next request follows in ", SecondsText(wait));
    Sleep(wait);
  }
}

std::string EndpointConnection::Get(const std::string& path) {
  return Exchange(AddressOf(path), true, [&](const std::string& url, const llm::HttpLimits& l) {
    return llm::HttpGet(url, Headers(url, ""), l, [this] { return clock_.Cancelled(); });
  });
}

std::string EndpointConnection::Post(const std::string& path, const std::string& content_type,
                                     const std::string& body) {
  return Exchange(AddressOf(path), false, [&](const std::string& url, const llm::HttpLimits& l) {
    return llm::HttpPost(url, Headers(url, content_type), body, l,
                         [this] { return clock_.Cancelled(); });
  });
}

std::string EndpointConnection::Fetch(const std::string& url) {
  const std::string absolute = llm::ResolvedUrl(options_.url, url);
  if (absolute.empty()) {
    Fail("it names an address that is no http or https address: " + Clean(url, 60));
  }
  RequireForeignAddress(absolute);
  return Exchange(absolute, true, [&](const std::string& to, const llm::HttpLimits& l) {
    return llm::HttpGet(to, Headers(to, ""), l, [this] { return clock_.Cancelled(); });
  });
}

llm::HttpReply EndpointConnection::Probe(const std::string& path) {
  llm::HttpReply reply =
      SendOnce(AddressOf(path), [&](const std::string& url, const llm::HttpLimits& limits) {
        return llm::HttpGet(url, Headers(url, ""), limits, [this] { return clock_.Cancelled(); });
      });
  RequireComplete(reply);
  if (reply.outcome != llm::HttpOutcome::kAnswered) {
    Fail(reply.fault, "is the server running and reachable?");
  }
  return reply;
}

std::string EndpointConnection::Clean(const std::string& text, std::size_t limit) const {
  return llm::Shortened(llm::Redact(text, secrets_), limit);
}

void EndpointConnection::Fail(const std::string& sentence, const std::string& remedy) const {
  throw core::Error(llm::Redact(sentence, secrets_), shown_, remedy);
}

void EndpointConnection::FailWithMessage(const std::string& message) const {
  const std::string quote = Clean(message, kLongestQuote);
  if (SpeaksOfContentFilter(message)) {
    Fail("its content filter refuses the request: " + quote, "word the prompt differently");
  }
  Fail("the server failed: " + quote, "the server's own log says more");
}

void EndpointConnection::FailLate() const {
  Fail("no picture arrived within " + SecondsText(options_.timeout),
       "allow more time with --generator-timeout");
}

void EndpointConnection::FailForStatus(const llm::HttpReply& reply) const {
  const std::string message = MessageInAnswer(reply.body);
  if (SpeaksOfContentFilter(message)) FailWithMessage(message);
  std::string sentence = "status " + std::to_string(reply.status);
  const std::string quote = message.empty() ? DescribeAnswer(reply.body) : message;
  if (quote != "empty") sentence += ": " + Clean(quote, kLongestQuote);
  std::string remedy = "the server's own log says more";
  if (reply.status == 401 || reply.status == 403) {
    remedy = std::string("set ") + kKeyVariable + " to a valid key";
  } else if (reply.status == 404 || reply.status == 405) {
    remedy = "check the address and --dialect; the web UI needs the flag --api";
  }
  Fail(sentence, remedy);
}

void EndpointConnection::Report(const std::string& code, core::Severity severity,
                                const std::string& sentence, double figure) {
  if (std::find(reported_.begin(), reported_.end(), code) != reported_.end()) return;
  reported_.push_back(code);
  findings_.push_back({code, severity, shown_, llm::Redact(sentence, secrets_), figure});
}

core::Findings EndpointConnection::TakeFindings() {
  return std::exchange(findings_, {});
}

}  // namespace simwright::texture
