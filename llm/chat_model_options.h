#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace simwright::llm {

// Where answers come from, and with how much patience.
struct ChatModelOptions {
  // http(s)://host[:port][/v1]; without a path, /v1 is meant; an address that ends in
  // /chat/completions is taken as it is.
  std::string url;
  std::string model;  // empty: not sent; llama.cpp's server then takes its only one
  std::string key;    // sent as a bearer token; empty: none is sent

  double connect_timeout = 10.0;  // s; a host that is there answers within one
  // s from the first byte of an answer to its last silence: a connection that has gone quiet for
  // this long is broken. A model at work says nothing before its answer is whole, so that it does
  // not count before the first byte.
  double stall_timeout = 60.0;
  double total_timeout = 600.0;  // s; a 7B model on two cores writes 2000 tokens in about that
  std::size_t max_answer_bytes = 8u << 20;  // an answer of 100k tokens has half a MiB

  int max_attempts = 5;        // with the waits below, half a minute of a server's restart
  double first_wait = 1.0;     // s before the second attempt; doubled each time, with jitter
  double longest_wait = 30.0;  // s; more is no use for a passing fault
  double longest_retry_after = 120.0;  // s; told to wait longer, the program says so and ends
  int max_redirects = 3;               // within the same scheme, host and port only
  std::uint64_t jitter_seed = 1;

  // Prices per million tokens, in any currency; both unset: no cost is counted.
  std::optional<double> input_price, output_price;

  std::filesystem::path cache;   // folder of answers kept; empty: none
  std::filesystem::path record;  // transcript to write; empty: none
  std::filesystem::path replay;  // transcript to answer from, without network; empty: none
  bool replace_record = false;   // an existing transcript may be written over

  // True where the values make sense together; else a sentence in `error` (may be null), which
  // never holds the key.
  bool IsValid(std::string* error) const;
};

// `options` with what it leaves open filled in: `url` from SIMWRIGHT_LLM_URL, `model` from
// SIMWRIGHT_LLM_MODEL, `key` from SIMWRIGHT_LLM_KEY, and from OPENAI_API_KEY only where the host
// is api.openai.com, so that a key never goes to a server it was not made for. `variable` returns
// an environment variable's value or null (std::getenv).
ChatModelOptions WithEnvironment(ChatModelOptions options,
                                 const std::function<const char*(const char*)>& variable);

// The parts of `url` that matter here. Throws core::Error, which does not repeat user, password or
// query, unless it is an http or https address with a host.
struct Endpoint {
  std::string address;   // what is posted to: base path with /chat/completions
  std::string shown;     // the same without user, password, query: fit for messages
  std::string origin;    // scheme://host:port, for comparison
  std::string host;      // lower case
  std::string password;  // of user:password@, decoded; may be empty
  bool https = false;
  bool loopback = false;  // localhost, 127.x.x.x or ::1
};
Endpoint ResolveEndpoint(const std::string& url);

// What must not be seen in any text: the key and the address's password. Placeholders shorter than
// 6 characters ("none", "EMPTY") are not secret.
std::vector<std::string> Secrets(const ChatModelOptions& options);

}  // namespace simwright::llm
