#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace simwright::llm {

struct UrlParts {
  std::string scheme;  // "http" or "https"
  std::string host;    // lower case; an IPv6 address in brackets
  std::string port;    // the scheme's default if none is given
  std::string path;
  std::string password;  // decoded
};

// The name of an address and an example of it, for messages about an address that is none.
struct UrlRole {
  std::string name = "the LLM server's URL";
  std::string remedy = "for example http://localhost:8080/v1";
};

// Splits a URL. Throws core::Error, without a secret in it, unless `url` is an http or https
// address with a host.
UrlParts SplitUrl(const std::string& url, const UrlRole& role = {});
// Returns `url` with its path replaced and its fragment dropped; user and query stay.
std::string WithPath(const std::string& url, const std::string& path);
// Returns the absolute address of `reference`, which may be relative to `base`; "" if it is no http
// or https address.
std::string ResolvedUrl(const std::string& base, const std::string& reference);
// Returns scheme://host:port, for comparison; "" if `url` is no http or https address.
std::string OriginOf(const std::string& url);
// Returns the address without user, password, query and fragment, and without the scheme's default
// port, for messages.
std::string ShownUrl(const std::string& url);
// Returns true for the host, as SplitUrl gives it, of an address on this machine: localhost and
// names below it, 127.0.0.0/8, 0.0.0.0, [::1], [::] and these IPv4 addresses within IPv6. Names are
// not resolved.
bool IsLoopback(const std::string& host);

struct HttpLimits {
  double connect_timeout = 10.0;  // s
  double stall_timeout = 60.0;    // s without a byte after the body has begun
  double total_timeout = 600.0;   // s
  std::size_t max_body_bytes = 8u << 20;
  bool no_proxy = false;  // ignore http_proxy, for servers on this machine
};

// The outcome of an exchange.
enum class HttpOutcome {
  kAnswered,  // headers and body are complete, whatever the status
  kBroken,    // no connection, or it broke: may be retried
  kTimedOut,  // the total timeout expired
  kTooLarge,  // the body was cut off at the limit
  kRefused    // retrying will not help: bad address, certificate ...
};

struct HttpReply {
  HttpOutcome outcome = HttpOutcome::kRefused;
  std::string fault;  // a sentence, unless answered
  long status = 0;    // 0 if no status line arrived
  std::string body;
  std::string content_type, retry_after;  // headers; may be empty
  std::string redirect;                   // absolute address of a 3xx redirect, not followed
};

// Posts `body` and waits for the reply. Supports http and https only and follows no redirects.
// Polls `cancelled` ten times a second; if it returns true, throws core::Cancelled.
HttpReply HttpPost(const std::string& url, const std::vector<std::string>& headers,
                   const std::string& body, const HttpLimits& limits,
                   const std::function<bool()>& cancelled);
// Requests `url` by GET; otherwise like HttpPost.
HttpReply HttpGet(const std::string& url, const std::vector<std::string>& headers,
                  const HttpLimits& limits, const std::function<bool()>& cancelled);

// Returns true for a redirect after which the same request may be sent again.
bool IsRedirect(long status);
// Returns true for a status that may pass: 429 and 5xx.
bool WorthAnotherTry(long status);

// Returns the seconds since 1970 of an HTTP date, or -1 if `text` is not one.
double ParseHttpDate(const std::string& text);

}  // namespace simwright::llm
