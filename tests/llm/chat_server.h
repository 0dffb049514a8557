#pragma once

// Ours first: httplib brings <resolv.h>, whose macros disturb Eigen.
#include "llm/chat_model.h"
#include "llm/chat_model_options.h"
#include "llm/retry_schedule.h"

#include <arpa/inet.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

namespace simwright::llm {

inline constexpr const char* kKey = "sk-test-0123456789abcdefghij";

// Returns a chat completions server's response to a question.
inline std::string GoodBody(const std::string& text, int input = 11, int output = 7) {
  return nlohmann::json{
      {"choices",
       {{{"message", {{"role", "assistant"}, {"content", text}}}, {"finish_reason", "stop"}}}},
      {"usage", {{"prompt_tokens", input}, {"completion_tokens", output}}}}
      .dump();
}

// An HTTP server on its own port. `handler` gets each POST and its number, from 0.
class ChatServer {
 public:
  using Handler = std::function<void(int, const httplib::Request&, httplib::Response&)>;

  explicit ChatServer(Handler handler) : handler_(std::move(handler)) {
    server_.Post(".*", [this](const httplib::Request& request, httplib::Response& response) {
      int number;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        number = static_cast<int>(bodies_.size());
        bodies_.push_back(request.body);
        paths_.push_back(request.target);
        authorizations_.push_back(request.get_header_value("Authorization"));
      }
      handler_(number, request, response);
    });
    server_.set_keep_alive_max_count(1);
    port_ = server_.bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::yield();
  }
  ~ChatServer() {
    stopping_ = true;
    server_.stop();
    thread_.join();
  }

  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/v1"; }
  int port() const { return port_; }
  bool stopping() const { return stopping_; }
  std::vector<std::string> bodies() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return bodies_;
  }
  std::vector<std::string> paths() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return paths_;
  }
  std::vector<std::string> authorizations() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return authorizations_;
  }
  nlohmann::json body(int number) {
    return nlohmann::json::parse(bodies().at(static_cast<std::size_t>(number)));
  }

 private:
  Handler handler_;
  httplib::Server server_;
  std::mutex mutex_;
  std::vector<std::string> bodies_, paths_, authorizations_;
  std::atomic<bool> stopping_ = false;
  int port_ = 0;
  std::thread thread_;
};

// A server that accepts each connection, reads its request, writes `reply` and closes, which no
// HTTP library does.
class RawServer {
 public:
  explicit RawServer(std::string reply) : reply_(std::move(reply)) {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        listen(listener_, 16) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      throw std::runtime_error("no socket");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { Serve(); });
  }
  ~RawServer() {
    shutdown(listener_, SHUT_RDWR);
    thread_.join();
    close(listener_);
  }
  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/v1"; }
  int connections() const { return connections_; }

 private:
  void Serve() {
    for (;;) {
      const int connection = accept(listener_, nullptr, nullptr);
      if (connection < 0) return;
      ++connections_;
      ReadRequest(connection);
      if (!reply_.empty()) (void)!write(connection, reply_.data(), reply_.size());
      close(connection);
    }
  }

  // Unread bytes would turn the close into a reset.
  static void ReadRequest(int connection) {
    std::string request;
    char buffer[4096];
    std::size_t wanted = std::string::npos;
    while (request.size() < wanted) {
      const ssize_t count = read(connection, buffer, sizeof(buffer));
      if (count <= 0) return;
      request.append(buffer, static_cast<std::size_t>(count));
      const std::size_t end = request.find("\r\n\r\n");
      const std::size_t length = request.find("Content-Length: ");
      if (end != std::string::npos && length != std::string::npos) {
        wanted = end + 4 + std::stoul(request.substr(length + 16));
      }
    }
  }

  std::string reply_;
  int listener_ = -1, port_ = 0;
  std::atomic<int> connections_ = 0;
  std::thread thread_;
};

// A clock that advances only by sleeping; cancelled on request.
class StillClock final : public Clock {
 public:
  double UnixSeconds() override { return now; }
  void Sleep(double seconds) override {
    sleeps.push_back(seconds);
    now += seconds;
    if (cancel_in_sleep) cancelled = true;
  }
  bool Cancelled() override { return cancelled; }

  double now = 1445412480.0;  // 21 Oct 2015 07:28:00 GMT
  std::vector<double> sleeps;
  std::atomic<bool> cancelled = false;
  bool cancel_in_sleep = false;
};

inline ChatModelOptions OptionsFor(const std::string& url) {
  ChatModelOptions options;
  options.url = url;
  options.model = "tiny";
  options.key = kKey;
  return options;
}

inline ChatRequest Question(const std::string& text) {
  ChatRequest request;
  request.task = "test question";
  request.messages.push_back({Role::kUser, text, {}});
  return request;
}

}  // namespace simwright::llm
