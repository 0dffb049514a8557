#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace simwright::llm {

struct UrlParts {
  std::string scheme;  // "http" or "https"
  std::string host;    // lower case; an IPv6 address in brackets
  std::string port;    // the scheme's own where none is given
  std::string path;
  std::string password;  // decoded
};

// Throws core::Error, without a secret in it, unless `url` is an http or https address with a host.
UrlParts SplitUrl(const std::string& url);
// `url` with its path replaced and its fragment dropped; user and query stay.
std::string WithPath(const std::string& url, const std::string& path);

struct HttpLimits {
  double connect_timeout = 10.0;  // s
  double stall_timeout = 60.0;    // s without a byte, once the body has begun
  double total_timeout = 600.0;   // s
  std::size_t max_body_bytes = 8u << 20;
  bool no_proxy = false;  // leave http_proxy out, as for this machine's own servers
};

// How an exchange ended.
enum class HttpOutcome {
  kAnswered,  // headers and body are whole, whatever the status
  kBroken,    // no connection, or it broke: worth another try
  kTimedOut,  // the total time has passed
  kTooLarge,  // the body was cut off at the limit
  kRefused    // asking again will not help: bad address, certificate ...
};

struct HttpReply {
  HttpOutcome outcome = HttpOutcome::kRefused;
  std::string fault;  // a sentence, unless answered
  long status = 0;    // 0 where no status line came
  std::string body;
  std::string content_type, retry_after;  // headers; may be empty
  std::string redirect;                   // absolute address of a 3xx, not followed
};

// Posts `body` and waits for the reply. Only http and https are spoken; redirects are not
// followed. `cancelled` is asked ten times a second; true ends the exchange with core::Cancelled.
HttpReply HttpPost(const std::string& url, const std::vector<std::string>& headers,
                   const std::string& body, const HttpLimits& limits,
                   const std::function<bool()>& cancelled);

// Seconds since 1970 of an HTTP date, or -1 where `text` is none.
double ParseHttpDate(const std::string& text);

}  // namespace simwright::llm
