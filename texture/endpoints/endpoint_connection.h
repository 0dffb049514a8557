#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/finding.h"
#include "llm/http_client.h"
#include "llm/retry_schedule.h"
#include "texture/endpoints/image_generator_options.h"

namespace simwright::texture {

// Returns the name of the address for messages.
const llm::UrlRole& ImageServerUrl();

// Returns a sentence's object for an answer that is not what was asked for: "empty", "a web page
// (HTML)", the server's message if it is JSON with one, else its beginning.
std::string DescribeAnswer(const std::string& body);

// Returns the reason in the JSON of an error: OpenAI's error.message, FastAPI's detail, the web
// UI's error and errors, ComfyUI's error with its node_errors; "" if there is none.
std::string MessageInAnswer(const std::string& body);

// Returns true if the message of a server says that a content filter refused the prompt or the
// picture.
bool SpeaksOfContentFilter(const std::string& message);

// The exchange with an image server: retries, limits of time and size, errors of one line. The key
// is sent to the scheme, host and port of the options' address only, and appears in no error,
// finding or log.
class EndpointConnection {
 public:
  // Requires valid options. `clock` must outlive the connection. Sends nothing.
  EndpointConnection(const ImageGeneratorOptions& options, llm::Clock& clock);

  // Starts the time limit of a picture.
  void Begin() { spent_ = 0.0; }

  // Return the body of the answer to a request at `path` below the server's address. Status 429 and
  // 5xx, and connections that fail or break, are retried. Throw core::Error for other statuses.
  std::string Get(const std::string& path);
  std::string Post(const std::string& path, const std::string& content_type,
                   const std::string& body);
  // Returns the content at an absolute address that the server named, without the key elsewhere.
  // Throws core::Error for an address on this machine that a server elsewhere names.
  std::string Fetch(const std::string& url);
  // Returns the reply at `path`, whatever its status, after one attempt. Throws core::Error if
  // there is none.
  llm::HttpReply Probe(const std::string& path);

  // Waits within the time limit.
  void Sleep(double seconds);

  [[noreturn]] void Fail(const std::string& sentence, const std::string& remedy = "") const;
  // Fails with the server's message; a refusal of the content has its own sentence.
  [[noreturn]] void FailWithMessage(const std::string& message) const;
  // Reports a finding once.
  void Report(const std::string& code, core::Severity severity, const std::string& sentence,
              double figure = 0.0);
  core::Findings TakeFindings();

  const ImageGeneratorOptions& options() const { return options_; }
  const std::string& shown() const { return shown_; }
  const std::string& host() const { return host_; }
  // Removes the key from a server's text.
  std::string Clean(const std::string& text, std::size_t limit) const;

 private:
  using Send = std::function<llm::HttpReply(const std::string& url, const llm::HttpLimits&)>;

  std::string AddressOf(const std::string& path) const;
  std::vector<std::string> Headers(const std::string& url, const std::string& content_type) const;
  llm::HttpReply SendOnce(const std::string& url, const Send& send);
  std::string Exchange(const std::string& url, bool get, const Send& send);
  std::string FollowedAddress(const llm::HttpReply& reply, bool get) const;
  void RequireForeignAddress(const std::string& url) const;
  void RequireComplete(const llm::HttpReply& reply) const;
  [[noreturn]] void FailForStatus(const llm::HttpReply& reply) const;
  [[noreturn]] void FailLate() const;

  ImageGeneratorOptions options_;
  llm::Clock& clock_;
  std::string host_, path_, shown_;
  std::vector<std::string> secrets_;
  core::Findings findings_;
  std::vector<std::string> reported_;  // codes
  double spent_ = 0.0;                 // s in exchanges and waits
};

}  // namespace simwright::texture
