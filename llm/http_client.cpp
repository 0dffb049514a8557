#include "llm/http_client.h"

#include <arpa/inet.h>
#include <curl/curl.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <memory>

#include "core/error.h"

namespace simwright::llm {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Closes a curl handle with its own function; CURL and CURLM are both void.
template <auto Close>
struct Closer {
  template <typename Handle>
  void operator()(Handle* handle) const {
    Close(handle);
  }
};
using UrlHandle = std::unique_ptr<CURLU, Closer<curl_url_cleanup>>;
using EasyHandle = std::unique_ptr<CURL, Closer<curl_easy_cleanup>>;
using MultiHandle = std::unique_ptr<CURLM, Closer<curl_multi_cleanup>>;
using List = std::unique_ptr<curl_slist, Closer<curl_slist_free_all>>;

void InitialiseOnce() {
  static const CURLcode code = curl_global_init(CURL_GLOBAL_DEFAULT);
  if (code != CURLE_OK) throw core::Error("the network library does not start", "libcurl");
}

// Returns a part of the address, or `missing` if it has none. Never throws for a missing part.
std::string Part(CURLU* url, CURLUPart part, unsigned flags, const std::string& missing = "") {
  char* text = nullptr;
  if (curl_url_get(url, part, &text, flags) != CURLUE_OK || text == nullptr) return missing;
  const std::string value = text;
  curl_free(text);
  return value;
}

UrlHandle ParseUrl(const std::string& url, const UrlRole& role = {}) {
  InitialiseOnce();
  UrlHandle handle(curl_url());
  if (handle == nullptr) throw std::bad_alloc();
  const CURLUcode code = curl_url_set(handle.get(), CURLUPART_URL, url.c_str(), 0);
  const std::string scheme = code == CURLUE_OK ? Part(handle.get(), CURLUPART_SCHEME, 0) : "";
  if (url.find('\0') != std::string::npos || (scheme != "http" && scheme != "https")) {
    throw core::Error("is not an http or https address", role.name, role.remedy);
  }
  return handle;
}

// The data of one exchange, filled by curl's callbacks.
struct Exchange {
  HttpReply* reply;
  std::size_t limit;
  bool too_large = false;
  SteadyClock::time_point last_byte;
  bool begun = false;
};

std::size_t OnBody(char* bytes, std::size_t, std::size_t count, void* user) {
  Exchange* exchange = static_cast<Exchange*>(user);
  exchange->begun = true;
  exchange->last_byte = SteadyClock::now();
  if (count > exchange->limit - exchange->reply->body.size()) {
    exchange->too_large = true;
    return 0;  // curl stops the transfer
  }
  exchange->reply->body.append(bytes, count);
  return count;
}

std::string LowerCaseHeader(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::size_t OnHeader(char* bytes, std::size_t, std::size_t count, void* user) {
  HttpReply* reply = static_cast<Exchange*>(user)->reply;
  const std::string line(bytes, count);
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos) return count;
  const std::size_t first = line.find_first_not_of(" \t", colon + 1);
  const std::size_t last = line.find_last_not_of(" \t\r\n");
  if (first == std::string::npos || last < first) return count;
  const std::string name = LowerCaseHeader(line.substr(0, colon));
  const std::string value = line.substr(first, last - first + 1);
  if (name == "content-type") reply->content_type = value;
  if (name == "retry-after") reply->retry_after = value;
  return count;
}

HttpOutcome OutcomeOf(CURLcode code) {
  switch (code) {
    case CURLE_OK:
      return HttpOutcome::kAnswered;
    case CURLE_COULDNT_RESOLVE_HOST:
    case CURLE_COULDNT_CONNECT:
    case CURLE_PARTIAL_FILE:
    case CURLE_GOT_NOTHING:
    case CURLE_SEND_ERROR:
    case CURLE_RECV_ERROR:
    case CURLE_HTTP2:
    case CURLE_HTTP2_STREAM:
    case CURLE_WEIRD_SERVER_REPLY:
    case CURLE_SSL_CONNECT_ERROR:
      return HttpOutcome::kBroken;
    case CURLE_OPERATION_TIMEDOUT:
      return HttpOutcome::kTimedOut;
    default:
      return HttpOutcome::kRefused;
  }
}

long Milliseconds(double seconds) {
  return std::max(1L, static_cast<long>(seconds * 1e3));
}

// `body`: null for a GET.
void Configure(CURL* easy, const std::string& url, curl_slist* headers, const std::string* body,
               const HttpLimits& limits, Exchange* exchange) {
  curl_easy_setopt(easy, CURLOPT_URL, url.c_str());
#if CURL_AT_LEAST_VERSION(7, 85, 0)
  curl_easy_setopt(easy, CURLOPT_PROTOCOLS_STR, "http,https");
#else
  curl_easy_setopt(easy, CURLOPT_PROTOCOLS, CURLPROTO_HTTP | CURLPROTO_HTTPS);
#endif
  curl_easy_setopt(easy, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(easy, CURLOPT_USERAGENT, "simwright/" SIMWRIGHT_VERSION);
  curl_easy_setopt(easy, CURLOPT_HTTPHEADER, headers);
  if (body != nullptr) {
    curl_easy_setopt(easy, CURLOPT_POSTFIELDS, body->data());
    curl_easy_setopt(easy, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(body->size()));
  }
  curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT_MS, Milliseconds(limits.connect_timeout));
  curl_easy_setopt(easy, CURLOPT_TIMEOUT_MS, Milliseconds(limits.total_timeout));
  // A body whose header states too many bytes is refused before the first of them.
  curl_easy_setopt(easy, CURLOPT_MAXFILESIZE_LARGE, static_cast<curl_off_t>(limits.max_body_bytes));
  curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, OnBody);
  curl_easy_setopt(easy, CURLOPT_WRITEDATA, exchange);
  curl_easy_setopt(easy, CURLOPT_HEADERFUNCTION, OnHeader);
  curl_easy_setopt(easy, CURLOPT_HEADERDATA, exchange);
  if (limits.no_proxy) curl_easy_setopt(easy, CURLOPT_PROXY, "");
#if CURL_AT_LEAST_VERSION(7, 87, 0)
  curl_easy_setopt(easy, CURLOPT_QUICK_EXIT, 1L);  // do not wait for a cancelled name look-up
#endif
}

// Runs the transfer to its end. Throws Cancelled; `stalled` is set if the connection went silent.
CURLcode Transfer(CURLM* multi, const HttpLimits& limits, const Exchange& exchange,
                  const std::function<bool()>& cancelled, bool* stalled) {
  constexpr int kPollMilliseconds = 100;
  for (int running = 1;;) {
    if (cancelled()) throw core::Cancelled();
    if (curl_multi_perform(multi, &running) != CURLM_OK) return CURLE_FAILED_INIT;
    if (running == 0) break;
    const std::chrono::duration<double> quiet = SteadyClock::now() - exchange.last_byte;
    *stalled = exchange.begun && quiet.count() > limits.stall_timeout;
    if (*stalled) return CURLE_RECV_ERROR;
    curl_multi_poll(multi, nullptr, 0, kPollMilliseconds, nullptr);
  }
  int left = 0;
  const CURLMsg* message = curl_multi_info_read(multi, &left);
  return message == nullptr ? CURLE_FAILED_INIT : message->data.result;
}

void Conclude(CURL* easy, CURLcode code, bool stalled, const HttpLimits& limits,
              const Exchange& exchange, HttpReply* reply) {
  curl_easy_getinfo(easy, CURLINFO_RESPONSE_CODE, &reply->status);
  reply->outcome = OutcomeOf(code);
  if (exchange.too_large || code == CURLE_FILESIZE_EXCEEDED) {
    reply->outcome = HttpOutcome::kTooLarge;
    reply->fault = "the answer is larger than " + std::to_string(limits.max_body_bytes) + " bytes";
  } else if (stalled) {
    reply->fault = "the connection went silent in the middle of the answer";
  } else if (code == CURLE_OPERATION_TIMEDOUT) {
    double connected = 0.0;
    curl_easy_getinfo(easy, CURLINFO_CONNECT_TIME, &connected);
    if (connected <= 0.0) reply->outcome = HttpOutcome::kBroken;
    reply->fault = connected <= 0.0 ? "no connection in time" : "no complete answer in time";
  } else if (code == CURLE_UNSUPPORTED_PROTOCOL) {
    reply->fault = "the server does not speak HTTP";  // or speaks https but was asked over http
  } else if (code != CURLE_OK) {
    reply->fault = curl_easy_strerror(code);
  }
  char* redirect = nullptr;
  if (curl_easy_getinfo(easy, CURLINFO_REDIRECT_URL, &redirect) == CURLE_OK && redirect) {
    reply->redirect = redirect;
  }
}

HttpReply Request(const std::string& url, const std::vector<std::string>& headers,
                  const std::string* body, const HttpLimits& limits,
                  const std::function<bool()>& cancelled) {
  InitialiseOnce();
  HttpReply reply;
  Exchange exchange{&reply, limits.max_body_bytes, false, SteadyClock::now(), false};
  List list;
  for (const std::string& header : headers) {
    curl_slist* longer = curl_slist_append(list.get(), header.c_str());
    if (longer == nullptr) throw std::bad_alloc();
    (void)list.release();
    list.reset(longer);
  }
  const EasyHandle easy(curl_easy_init());
  const MultiHandle multi(curl_multi_init());
  if (easy == nullptr || multi == nullptr) throw std::bad_alloc();
  Configure(easy.get(), url, list.get(), body, limits, &exchange);
  // Removes the easy handle from the multi handle before either is closed, also when cancelled.
  struct Membership {
    CURLM* multi;
    CURL* easy;
    ~Membership() { curl_multi_remove_handle(multi, easy); }
  };
  if (curl_multi_add_handle(multi.get(), easy.get()) != CURLM_OK) throw std::bad_alloc();
  const Membership membership{multi.get(), easy.get()};
  bool stalled = false;
  const CURLcode code = Transfer(multi.get(), limits, exchange, cancelled, &stalled);
  Conclude(easy.get(), code, stalled, limits, exchange, &reply);
  return reply;
}

// Returns true for 127.0.0.0/8 and for 0.0.0.0, which reaches this machine too.
bool IsLoopbackV4(const std::uint8_t* bytes) {
  return bytes[0] == 127 || std::all_of(bytes, bytes + 4, [](std::uint8_t b) { return b == 0; });
}

// Returns true for ::1, for ::, and for an IPv4 address of this machine in IPv6 (::ffff:127.0.0.1).
bool IsLoopbackV6(const std::array<std::uint8_t, 16>& bytes) {
  const auto zeros = [&](std::size_t count) {
    return std::all_of(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count),
                       [](std::uint8_t b) { return b == 0; });
  };
  if (zeros(15)) return bytes[15] <= 1;
  if (zeros(10) && bytes[10] == 0xff && bytes[11] == 0xff) return IsLoopbackV4(&bytes[12]);
  return false;
}

}  // namespace

UrlParts SplitUrl(const std::string& url, const UrlRole& role) {
  const UrlHandle handle = ParseUrl(url, role);
  UrlParts parts;
  parts.scheme = Part(handle.get(), CURLUPART_SCHEME, 0);
  parts.host = LowerCaseHeader(Part(handle.get(), CURLUPART_HOST, 0));
  parts.port = Part(handle.get(), CURLUPART_PORT, CURLU_DEFAULT_PORT);
  parts.path = Part(handle.get(), CURLUPART_PATH, 0);
  parts.password = Part(handle.get(), CURLUPART_PASSWORD, CURLU_URLDECODE);
  return parts;
}

std::string WithPath(const std::string& url, const std::string& path) {
  const UrlHandle handle = ParseUrl(url);
  curl_url_set(handle.get(), CURLUPART_PATH, path.c_str(), 0);
  curl_url_set(handle.get(), CURLUPART_FRAGMENT, nullptr, 0);
  return Part(handle.get(), CURLUPART_URL, 0);
}

std::string ResolvedUrl(const std::string& base, const std::string& reference) {
  try {
    const UrlHandle handle = ParseUrl(base);
    if (curl_url_set(handle.get(), CURLUPART_URL, reference.c_str(), 0) != CURLUE_OK) return "";
    const std::string url = Part(handle.get(), CURLUPART_URL, 0);
    ParseUrl(url);  // throws for other schemes
    return url;
  } catch (const core::Error&) {
    return "";
  }
}

std::string OriginOf(const std::string& url) {
  try {
    const UrlParts parts = SplitUrl(url);
    return parts.scheme + "://" + parts.host + ":" + parts.port;
  } catch (const core::Error&) {
    return "";
  }
}

std::string ShownUrl(const std::string& url) {
  try {
    const UrlParts parts = SplitUrl(url);
    const bool usual_port = parts.port == (parts.scheme == "https" ? "443" : "80");
    return parts.scheme + "://" + parts.host + (usual_port ? "" : ":" + parts.port) + parts.path;
  } catch (const core::Error&) {
    return "not an http or https address";
  }
}

bool IsLoopback(const std::string& host) {
  std::string name = LowerCaseHeader(host);
  if (name.ends_with('.')) name.pop_back();
  std::array<std::uint8_t, 16> bytes{};
  if (inet_pton(AF_INET, name.c_str(), bytes.data()) == 1) return IsLoopbackV4(bytes.data());
  if (name.starts_with('[') && name.ends_with(']')) {
    name =
        name.substr(1, name.find('%') == std::string::npos ? name.size() - 2 : name.find('%') - 1);
    return inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1 && IsLoopbackV6(bytes);
  }
  return name == "localhost" || name.ends_with(".localhost");
}

HttpReply HttpPost(const std::string& url, const std::vector<std::string>& headers,
                   const std::string& body, const HttpLimits& limits,
                   const std::function<bool()>& cancelled) {
  return Request(url, headers, &body, limits, cancelled);
}

HttpReply HttpGet(const std::string& url, const std::vector<std::string>& headers,
                  const HttpLimits& limits, const std::function<bool()>& cancelled) {
  return Request(url, headers, nullptr, limits, cancelled);
}

bool IsRedirect(long status) {
  return status == 301 || status == 302 || status == 307 || status == 308;
}

bool WorthAnotherTry(long status) {
  return status == 429 || (status >= 500 && status <= 599);
}

double ParseHttpDate(const std::string& text) {
  return static_cast<double>(curl_getdate(text.c_str(), nullptr));
}

}  // namespace simwright::llm
