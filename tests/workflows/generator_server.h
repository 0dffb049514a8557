#pragma once

// Ours first: httplib brings <resolv.h>, whose macros disturb Eigen.
#include "tests/assets/gltf_builder.h"
#include "tests/llm/chat_server.h"
#include "workflows/generator/generator_client.h"

#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace simwright::workflows {

inline constexpr const char* kGeneratorKey = "gen-test-0123456789abcdef";

// A request as a server saw it.
struct SeenRequest {
  std::string method, path, content_type, authorization, body;
  httplib::MultipartFormDataMap files;
};

// An HTTP server on its own port that records requests. `handler` gets each with its number, from
// 0.
class GeneratorServer {
 public:
  using Handler = std::function<void(int, const httplib::Request&, httplib::Response&)>;

  explicit GeneratorServer(Handler handler) : handler_(std::move(handler)) {
    const auto handle = [this](const httplib::Request& request, httplib::Response& response) {
      int number;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        number = static_cast<int>(seen_.size());
        seen_.push_back({request.method, request.target, request.get_header_value("Content-Type"),
                         request.get_header_value("Authorization"), request.body, request.files});
      }
      handler_(number, request, response);
    };
    server_.Post(".*", handle);
    server_.Get(".*", handle);
    server_.set_keep_alive_max_count(1);
    port_ = server_.bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::yield();
  }
  ~GeneratorServer() {
    stopping_ = true;
    server_.stop();
    thread_.join();
  }

  std::string origin() const { return "http://127.0.0.1:" + std::to_string(port_); }
  std::string url() const { return origin() + "/generate"; }
  bool stopping() const { return stopping_; }
  std::vector<SeenRequest> seen() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return seen_;
  }

 private:
  Handler handler_;
  httplib::Server server_;
  std::mutex mutex_;
  std::vector<SeenRequest> seen_;
  std::atomic<bool> stopping_ = false;
  int port_ = 0;
  std::thread thread_;
};

// A closed box of x, y and z sides as a GLB, y up.
inline std::string BoxGlb(float x, float y, float z) {
  assets::GltfBuilder builder;
  std::vector<float> positions;
  for (int i = 0; i < 8; ++i) {
    positions.insert(positions.end(), {(i & 1) ? x : 0.0f, (i & 2) ? y : 0.0f, (i & 4) ? z : 0.0f});
  }
  const int vertices = builder.AddFloats(positions, "VEC3", 3);
  const int indices = builder.AddIndices({0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                          2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5});
  builder.root["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", vertices}}}, {"indices", indices}}}}}};
  return builder.Glb();
}

// Expects `part` in `text`.
inline void ExpectIn(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

inline GeneratorOptions GeneratorAt(const std::string& url) {
  GeneratorOptions options;
  options.url = url;
  options.key = kGeneratorKey;
  options.timeout = 100.0;
  return options;
}

// A server that answers every request with these bytes.
inline GeneratorServer::Handler Answering(const std::string& body, int status = 200,
                                          const std::string& type = "application/octet-stream") {
  return [=](int, const httplib::Request&, httplib::Response& response) {
    response.status = status;
    response.set_content(body, type);
  };
}

}  // namespace simwright::workflows
