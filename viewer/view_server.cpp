#include "viewer/view_server.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <exception>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "core/base64.h"
#include "core/error.h"
#include "core/progress.h"
#include "viewer/live_content.h"
#include "viewer/page.h"

// Last: it brings <resolv.h>, whose macros disturb Eigen.
#include <httplib.h>

namespace simwright::viewer {
namespace {

constexpr int kBacklog = 1024;              // connections that wait to be accepted
constexpr int kThreads = 16;                // answer requests
constexpr std::size_t kLargestBody = 1024;  // bytes: a GET has none
constexpr const char* kJson = "application/json; charset=utf-8";
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; "
    "img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

std::string Text(const core::OrderedJson& json) {
  return core::JsonLine(json, core::InvalidUtf8::kReplace);
}

// Returns a number of a path, -1 if it is too long.
std::int64_t NumberOf(const std::string& digits) {
  std::int64_t number = -1;
  const char* const end = digits.data() + digits.size();
  const auto [stop, fault] = std::from_chars(digits.data(), end, number);
  return fault == std::errc() && stop == end ? number : -1;
}

// Returns true if a request's header `Host` names this computer, at any port: a tunnel ends at
// another port than the server's.
bool IsThisComputer(const std::string& host) {
  for (const char* const name : {"localhost", "127.0.0.1", "[::1]"}) {
    if (host == name) return true;
    const std::string with_port = std::string(name) + ":";
    if (host.starts_with(with_port) && NumberOf(host.substr(with_port.size())) >= 0) return true;
  }
  return false;
}

// Ends the server's connections at `port`. The library's threads wait for seconds for the next
// request of each, which a stopped server does not answer.
void EndConnections(int port) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", none)) {
    const auto file = static_cast<int>(NumberOf(entry.path().filename().string()));
    sockaddr_in own{};
    socklen_t size = sizeof own;
    if (::getsockname(file, reinterpret_cast<sockaddr*>(&own), &size) != 0) continue;
    if (own.sin_family == AF_INET && ntohs(own.sin_port) == port) ::shutdown(file, SHUT_RDWR);
  }
}

void Refuse(int status, const std::string& what, httplib::Response* response) {
  response->status = status;
  response->set_content(Text({{"error", what}}), kJson);
}

}  // namespace

struct ViewServer::Server {
  explicit Server(ContentSource source) : live(std::move(source)) {}

  // Calls `answer` with a version's content and the number in the path, if there are such.
  template <typename Answer>
  void AnswerNumbered(const httplib::Request& request, httplib::Response* response,
                      const Answer& answer) {
    const std::shared_ptr<Content> content = live.Version(NumberOf(request.matches[1].str()));
    if (!content) {
      Refuse(410, "this version is gone: load the page again", response);
      return;
    }
    try {
      answer(content.get(), NumberOf(request.matches[2].str()));
    } catch (const std::exception& error) {
      Refuse(500, error.what(), response);
    }
  }

  void AddFiles();
  void AddManifest();
  void AddNumbered();
  void Protect(int idle_seconds);

  LiveContent live;
  httplib::Server http;
  std::mutex replaying;  // one replay at a time
  int socket = -1;
  std::atomic<bool> stopped{false};
};

void ViewServer::Server::AddFiles() {
  http.Get("/", [](const httplib::Request&, httplib::Response& response) {
    response.set_content(ServedPage(), "text/html; charset=utf-8");
  });
  for (const WebFile& file : WebFiles()) {
    http.Get("/" + std::string(file.name),
             [&file](const httplib::Request&, httplib::Response& response) {
               response.set_content(file.text.data(), file.text.size(), std::string(file.type));
             });
  }
}

void ViewServer::Server::AddManifest() {
  http.Get("/manifest", [this](const httplib::Request&, httplib::Response& response) {
    live.Refresh();
    const ContentVersion current = live.Current();
    core::OrderedJson manifest = current.content->document().manifest;
    manifest["version"] = current.number;
    response.set_content(Text(manifest), kJson);
  });
  http.Get("/version", [this](const httplib::Request&, httplib::Response& response) {
    live.Refresh();
    response.set_content(Text({{"version", live.Current().number}, {"fault", live.fault()}}),
                         kJson);
  });
  http.Get("/charts", [this](const httplib::Request&, httplib::Response& response) {
    try {
      response.set_content(Text(live.Current().content->Charts()), kJson);
    } catch (const std::exception& error) {
      Refuse(500, error.what(), &response);
    }
  });
}

void ViewServer::Server::AddNumbered() {
  http.Get(R"(/buffer/(\d{1,9})/(\d{1,9}))",
           [this](const httplib::Request& request, httplib::Response& response) {
             AnswerNumbered(request, &response, [&](Content* content, std::int64_t number) {
               const std::vector<Buffer>& buffers = content->document().buffers;
               if (number < 0 || number >= std::ssize(buffers)) {
                 return Refuse(404, "there is no such buffer", &response);
               }
               const Buffer& buffer = buffers[static_cast<std::size_t>(number)];
               response.set_content(buffer.bytes, buffer.type);
             });
           });
  http.Get(R"(/world/(\d{1,9})/(\d{1,9}))",
           [this](const httplib::Request& request, httplib::Response& response) {
             AnswerNumbered(request, &response, [&](Content* content, std::int64_t number) {
               if (number < 0 || number >= content->WorldCount()) {
                 return Refuse(404, "there is no such world", &response);
               }
               response.set_content(Text(content->Bodies(static_cast<int>(number))), kJson);
             });
           });
  http.Get(R"(/replay/(\d{1,9})/(\d{1,9}))",
           [this](const httplib::Request& request, httplib::Response& response) {
             AnswerNumbered(request, &response, [&](Content* content, std::int64_t number) {
               if (number < 0 || number >= content->WorldCount()) {
                 return Refuse(404, "there is no such world", &response);
               }
               const std::lock_guard lock(replaying);
               const Timeline timeline = content->Replay(static_cast<int>(number));
               core::OrderedJson json = TimelineJson(timeline);
               json["base64"] = core::Base64(TimelineBytes(timeline));
               response.set_content(Text(json), kJson);
             });
           });
}

void ViewServer::Server::Protect(int idle_seconds) {
  http.set_payload_max_length(kLargestBody);
  http.set_keep_alive_max_count(200);
  http.set_keep_alive_timeout(idle_seconds);
  http.set_read_timeout(5);
  http.set_write_timeout(30);
  http.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };  // httplib deletes it
  http.set_default_headers({{"Content-Security-Policy", kPolicy},
                            {"X-Content-Type-Options", "nosniff"},
                            {"Referrer-Policy", "no-referrer"},
                            {"Cross-Origin-Resource-Policy", "same-origin"},
                            {"Cache-Control", "no-store"}});
  http.set_pre_routing_handler(
      [this](const httplib::Request& request, httplib::Response& response) {
        if (!IsThisComputer(request.get_header_value("Host"))) {
          Refuse(403, "requests must come from this computer", &response);
          return httplib::Server::HandlerResponse::Handled;
        }
        if (request.method != "GET" && request.method != "HEAD") {
          Refuse(405, "only GET is answered", &response);
          return httplib::Server::HandlerResponse::Handled;
        }
        return httplib::Server::HandlerResponse::Unhandled;
      });
  http.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (response.body.empty()) Refuse(response.status, "there is no such page", &response);
  });
  http.set_socket_options([this](socket_t created) {
    const int yes = 1;
    setsockopt(created, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    socket = created;
  });
}

ViewServer::ViewServer(ContentSource source, int port, int idle_seconds)
    : server_(std::make_unique<Server>(std::move(source))) {
  server_->Protect(idle_seconds);
  server_->AddFiles();
  server_->AddManifest();
  server_->AddNumbered();
  if (port == 0) {
    port_ = server_->http.bind_to_any_port("127.0.0.1");
  } else if (server_->http.bind_to_port("127.0.0.1", port)) {
    port_ = port;
  } else {
    port_ = -1;
  }
  if (port_ <= 0) {
    throw core::Error("the port cannot be used", "127.0.0.1:" + std::to_string(port),
                      "another program may have it: give another --port, or none");
  }
  // The library lets five connections wait; a browser and a script may open many more at once.
  ::listen(server_->socket, kBacklog);
}

ViewServer::~ViewServer() = default;

std::string ViewServer::url() const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/";
}

const Content& ViewServer::first_content() const {
  return *server_->live.Current().content;
}

void ViewServer::Run() {
  std::atomic<bool> ended{false};
  std::thread listener([this, &ended] {
    server_->http.listen_after_bind();
    ended = true;
  });
  // The library ignores a stop that comes before it listens.
  while (!server_->http.is_running() && !ended) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  while (!ended && !server_->stopped && !core::CancelRequested()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  server_->http.stop();
  while (!ended) {
    EndConnections(port_);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  listener.join();
}

void ViewServer::Stop() {
  server_->stopped = true;
}

}  // namespace simwright::viewer
