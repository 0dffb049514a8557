// Requests of any bytes to the viewer's server: it answers or ends the connection, with none of its
// own faults (500), and goes on.
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "viewer/page.h"
#include "viewer/view_server.h"

namespace simwright::viewer {

// In place of the page's scripts.
const std::vector<WebFile>& WebFiles() {
  static const std::vector<WebFile> files = {{"main.js", "text/javascript", "0;"}};
  return files;
}

std::string ServedPage() {
  return "<!doctype html><title>page</title>";
}

namespace {

class OneWorld : public Content {
 public:
  OneWorld() : Content(Made()) {}
  core::OrderedJson Bodies(int) override { return core::OrderedJson::array(); }
  Timeline Replay(int) override { return {}; }

 private:
  static Document Made() {
    DocumentBuilder builder("asset", "one");
    builder.AddWorld({{"name", "one"}});
    Document document = builder.Take();
    document.buffers.push_back({"bytes", "application/octet-stream"});
    return document;
  }
};

// The server of this process; it is never stopped.
int Port() {
  static ViewServer* const server = [] {
    const ContentSource source = {[] { return std::make_unique<OneWorld>(); },
                                  [] { return std::string("same"); }};
    auto* const made = new ViewServer(source, 0);
    std::thread([made] { made->Run(); }).detach();
    return made;
  }();
  return server->port();
}

int Connect() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(Port()));
  for (;;) {
    const int client = ::socket(AF_INET, SOCK_STREAM, 0);
    if (client < 0) std::abort();
    if (::connect(client, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
      return client;
    }
    // Ports of ended connections are free again after a while.
    if (errno != EADDRNOTAVAIL && errno != EINTR) std::abort();
    ::close(client);
    ::usleep(10000);
  }
}

// Sends bytes and returns the answer; the server ends the connection.
std::string Ask(const std::string& request) {
  const int client = Connect();
  for (std::size_t sent = 0; sent < request.size();) {
    const ssize_t count =
        ::send(client, request.data() + sent, request.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) break;  // refused before its end
    sent += static_cast<std::size_t>(count);
  }
  ::shutdown(client, SHUT_WR);
  std::string answer;
  char buffer[4096];
  for (ssize_t count; (count = ::recv(client, buffer, sizeof buffer, 0)) > 0;) {
    answer.append(buffer, static_cast<std::size_t>(count));
  }
  ::close(client);
  return answer;
}

}  // namespace
}  // namespace simwright::viewer

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  std::string request(reinterpret_cast<const char*>(data + 1), size - 1);
  // Half of the inputs are the target of a request that reaches the routes.
  if (data[0] % 2 == 0) {
    request = "GET /" + request + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  }
  const std::string answer = simwright::viewer::Ask(request);
  if (!answer.empty() && !answer.starts_with("HTTP/1.")) std::abort();
  if (answer.size() > 9 && std::string_view(answer).substr(9, 1) == "5") std::abort();
  return 0;
}
