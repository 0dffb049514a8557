#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace simwright::llm {

// The source of answers, and its timeouts and retries.
struct ChatModelOptions {
  // http(s)://host[:port][/v1]. Without a path, /v1 is used; an address that ends in
  // /chat/completions is used unchanged.
  std::string url;
  std::string model;  // empty: not sent; llama.cpp's server then uses its only model
  std::string key;    // sent as a bearer token; empty: none

  double connect_timeout = 10.0;  // s; a reachable host answers within one
  // The longest silence (s) after the first byte of an answer, beyond which the connection counts
  // as broken. It does not apply before the first byte, since a model at work sends nothing until
  // its answer is complete.
  double stall_timeout = 60.0;
  double total_timeout = 600.0;  // s; about the time in which a 7B model on two cores writes 2000
                                 // tokens
  std::size_t max_answer_bytes = 8u << 20;  // 100k tokens take half a MiB

  int max_attempts = 5;        // with the waits below, covers half a minute of a server's restart
  double first_wait = 1.0;     // s before the second attempt; doubled each time, with jitter
  double longest_wait = 30.0;  // s; longer does not help with a passing fault
  double longest_retry_after = 120.0;  // s; if the server asks for more, the request fails with
                                       // that message
  int max_redirects = 3;               // only within the same scheme, host and port
  std::uint64_t jitter_seed = 1;

  // Prices per million tokens, in any currency; if both are unset, no cost is counted.
  std::optional<double> input_price, output_price;

  std::filesystem::path cache;   // folder of cached answers; empty: none
  std::filesystem::path record;  // transcript to write; empty: none
  std::filesystem::path replay;  // transcript to replay without network; empty: none
  bool replace_record = false;   // an existing transcript may be overwritten

  // Returns true if the values are consistent; else sets `error` (may be null) to a sentence, which
  // never contains the key.
  bool IsValid(std::string* error) const;
};

// Fills unset `options` from the environment: `url` from SIMWRIGHT_LLM_URL, `model` from
// SIMWRIGHT_LLM_MODEL, `key` from SIMWRIGHT_LLM_KEY, and from OPENAI_API_KEY only if the host is
// api.openai.com, so that a key is never sent to a server it was not issued for. `variable` returns
// an environment variable's value or null (std::getenv).
ChatModelOptions WithEnvironment(ChatModelOptions options,
                                 const std::function<const char*(const char*)>& variable);

// The parts of a server URL. ResolveEndpoint throws core::Error, which does not repeat user,
// password or query, unless `url` is an http or https address with a host.
struct Endpoint {
  std::string address;   // the address to post to: base path with /chat/completions
  std::string shown;     // the same without user, password and query, for messages
  std::string origin;    // scheme://host:port, for comparison
  std::string host;      // lower case
  std::string password;  // of user:password@, decoded; may be empty
  bool https = false;
  bool loopback = false;  // localhost, 127.x.x.x or ::1
};
Endpoint ResolveEndpoint(const std::string& url);

// Returns the strings to redact from any text: the key and the address's password. Placeholders
// shorter than 6 characters ("none", "EMPTY") are not secret.
std::vector<std::string> Secrets(const ChatModelOptions& options);

}  // namespace simwright::llm
