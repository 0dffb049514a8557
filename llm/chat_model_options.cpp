#include "llm/chat_model_options.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/error.h"
#include "llm/http_client.h"

namespace simwright::llm {
namespace {

constexpr std::size_t kShortestSecret = 6;
constexpr std::string_view kOperation = "/chat/completions";

bool InRange(double value, double low, double high) {
  return std::isfinite(value) && value >= low && value <= high;
}

bool HasControlCharacter(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7f;
  });
}

std::string Fault(const ChatModelOptions& o) {
  constexpr double kDay = 86400.0;  // s
  if (!o.record.empty() && !o.replay.empty()) return "record and replay exclude each other";
  if (HasControlCharacter(o.key) || o.key.find(' ') != std::string::npos) {
    return "the key contains a blank or a line break";
  }
  if (HasControlCharacter(o.model)) return "the model's name contains a line break";
  if (!InRange(o.connect_timeout, 0.001, kDay) || !InRange(o.stall_timeout, 0.001, kDay) ||
      !InRange(o.total_timeout, 0.001, kDay)) {
    return "the timeouts must lie between a millisecond and a day";
  }
  if (o.max_answer_bytes < 1) return "max_answer_bytes must be at least 1";
  if (o.max_attempts < 1 || o.max_attempts > 100) return "max_attempts must lie in 1 to 100";
  if (o.max_redirects < 0 || o.max_redirects > 20) return "max_redirects must lie in 0 to 20";
  if (!InRange(o.first_wait, 0.0, kDay) || !InRange(o.longest_wait, o.first_wait, kDay) ||
      !InRange(o.longest_retry_after, 0.0, kDay)) {
    return "the waits must be positive, and longest_wait no less than first_wait";
  }
  if (o.input_price.has_value() != o.output_price.has_value()) {
    return "give the prices of input and output tokens, or neither";
  }
  if (o.input_price &&
      (!InRange(*o.input_price, 0.0, 1e9) || !InRange(*o.output_price, 0.0, 1e9))) {
    return "a price is negative or not a number";
  }
  if (o.replay.empty()) {
    if (o.url.empty()) return "no server is given";
    try {
      ResolveEndpoint(o.url);
    } catch (const core::Error& error) {
      return error.what();
    }
  }
  return "";
}

// Returns "/v1" + "/chat/completions"; a bare host means /v1, where all these servers answer.
std::string OperationPath(std::string path) {
  while (!path.empty() && path.back() == '/') path.pop_back();
  if (path.ends_with(kOperation)) return path;
  return (path.empty() ? "/v1" : path) + std::string(kOperation);
}

}  // namespace

bool ChatModelOptions::IsValid(std::string* error) const {
  const std::string fault = Fault(*this);
  if (error != nullptr) *error = fault;
  return fault.empty();
}

ChatModelOptions WithEnvironment(ChatModelOptions options,
                                 const std::function<const char*(const char*)>& variable) {
  const auto fill = [&](const char* name, std::string* value) {
    const char* text = variable(name);
    if (value->empty() && text != nullptr) *value = text;
  };
  fill("SIMWRIGHT_LLM_URL", &options.url);
  fill("SIMWRIGHT_LLM_MODEL", &options.model);
  fill("SIMWRIGHT_LLM_KEY", &options.key);
  if (options.key.empty() && !options.url.empty()) {
    const Endpoint endpoint = ResolveEndpoint(options.url);
    if (endpoint.https && endpoint.host == "api.openai.com") fill("OPENAI_API_KEY", &options.key);
  }
  return options;
}

Endpoint ResolveEndpoint(const std::string& url) {
  const UrlParts parts = SplitUrl(url);
  Endpoint endpoint;
  endpoint.https = parts.scheme == "https";
  endpoint.host = parts.host;
  endpoint.password = parts.password;
  endpoint.origin = OriginOf(url);
  endpoint.loopback = IsLoopback(parts.host);
  const std::string path = OperationPath(parts.path);
  endpoint.address = WithPath(url, path);
  endpoint.shown = ShownUrl(endpoint.address);
  return endpoint;
}

std::vector<std::string> Secrets(const ChatModelOptions& options) {
  std::vector<std::string> secrets;
  if (options.key.size() >= kShortestSecret) secrets.push_back(options.key);
  if (!options.url.empty()) {
    try {
      const std::string password = ResolveEndpoint(options.url).password;
      if (password.size() >= kShortestSecret) secrets.push_back(password);
    } catch (const core::Error&) {  // no address, no password
    }
  }
  return secrets;
}

}  // namespace simwright::llm
