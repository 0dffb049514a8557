#pragma once

// Ours first: httplib brings <resolv.h>, whose macros disturb Eigen.
#include "core/base64.h"
#include "core/error.h"
#include "core/image.h"
#include "tests/llm/chat_server.h"
#include "texture/endpoints/make_image_generator.h"
#include "texture/image_generator.h"

#include <gtest/gtest.h>
#include <httplib.h>

#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

namespace simwright::texture {

inline constexpr const char* kImageKey = "img-test-0123456789abcdef";

// A request as a server saw it.
struct SeenImageRequest {
  std::string method, target, path, content_type, authorization, body;
  httplib::MultipartFormDataMap files;
};

// An HTTP server on its own port that records requests. `handler` gets each.
class ImageServer {
 public:
  using Handler = std::function<void(const httplib::Request&, httplib::Response&)>;

  explicit ImageServer(Handler handler) : handler_(std::move(handler)) {
    const auto handle = [this](const httplib::Request& request, httplib::Response& response) {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        seen_.push_back({request.method, request.target, request.path,
                         request.get_header_value("Content-Type"),
                         request.get_header_value("Authorization"), request.body, request.files});
      }
      handler_(request, response);
    };
    server_.Post(".*", handle);
    server_.Get(".*", handle);
    server_.set_keep_alive_max_count(1);
    port_ = server_.bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::yield();
  }
  ~ImageServer() {
    server_.stop();
    thread_.join();
  }

  std::string origin() const { return "http://127.0.0.1:" + std::to_string(port_); }
  std::vector<SeenImageRequest> seen() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return seen_;
  }
  // Returns the requests to a path.
  std::vector<SeenImageRequest> SeenAt(const std::string& path) {
    std::vector<SeenImageRequest> found;
    for (const SeenImageRequest& request : seen()) {
      if (request.path == path) found.push_back(request);
    }
    return found;
  }

 private:
  Handler handler_;
  httplib::Server server_;
  std::mutex mutex_;
  std::vector<SeenImageRequest> seen_;
  int port_ = 0;
  std::thread thread_;
};

// A picture whose red grows to the right and whose green grows downwards.
inline core::Image RampPicture(int width, int height) {
  core::Image image(width, height, 3, 40);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.At(x, y)[0] = static_cast<std::uint8_t>(255 * x / std::max(width - 1, 1));
      image.At(x, y)[1] = static_cast<std::uint8_t>(255 * y / std::max(height - 1, 1));
    }
  }
  return image;
}

inline ImageRequest WordsRequest(int width = 128, int height = 96) {
  ImageRequest request;
  request.prompt = "a red \"apple\" on white";
  request.negative_prompt = "hands";
  request.width = width;
  request.height = height;
  request.seed = (7ull << 32) + 42;  // 42 in 32 bits
  return request;
}

// A view of `width` x `height` pixels. The left third of its trimap is kept, the middle third is
// refined, the right third generated. Its depth is 2 m in the upper half and 4 m in the lower one,
// and nothing in the first row.
inline ImageRequest ViewRequest(int width = 96, int height = 64) {
  ImageRequest request = WordsRequest(0, 0);
  request.render = RampPicture(width, height);
  request.trimap = core::Image(width, height, 1, kTrimapKeep);
  request.depth = core::FloatImage(width, height, 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int third = 3 * x / width;
      *request.trimap.At(x, y) =
          third == 0 ? kTrimapKeep : (third == 1 ? kTrimapRefine : kTrimapGenerate);
      *request.depth.At(x, y) = y == 0 ? 0.0f : (2 * y < height ? 2.0f : 4.0f);
    }
  }
  request.camera.width = width;
  request.camera.height = height;
  return request;
}

inline ImageGeneratorOptions ImagesFrom(const std::string& url, ImageDialect dialect) {
  ImageGeneratorOptions options;
  options.url = url;
  options.dialect = dialect;
  options.key = kImageKey;
  options.timeout = 60.0;
  return options;
}

// Returns the message of the failure, which has one line and not the key.
inline std::string PictureFailure(const ImageGeneratorOptions& options,
                                  const ImageRequest& request = WordsRequest()) {
  llm::StillClock clock;
  try {
    MakeImageGenerator(options, clock)->Generate(request);
  } catch (const core::Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.find(kImageKey), std::string::npos) << message;
    return message;
  }
  return "no failure";
}

inline void ExpectPart(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

inline bool HasFinding(const core::Findings& findings, const std::string& code) {
  for (const core::Finding& finding : findings) {
    if (finding.code == code) return true;
  }
  return false;
}

inline std::string PngBase64(const core::Image& image) {
  return core::Base64(core::EncodePng(image));
}

inline core::Image FromPngBase64(const std::string& text) {
  return core::DecodeImage(core::FromBase64(text).value(), "a picture that arrived");
}

}  // namespace simwright::texture
