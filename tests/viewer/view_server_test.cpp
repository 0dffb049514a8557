#include "viewer/view_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <memory>
#include <thread>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "core/progress.h"
#include "tests/assets/sample_asset.h"
#include "viewer/live_content.h"
#include "viewer/model_document.h"
#include "viewer/page.h"

// Last: it brings <resolv.h>, whose macros disturb Eigen.
#include <httplib.h>

namespace simwright::viewer {
namespace {
namespace fs = std::filesystem;

constexpr const char* kHostile = "<img src=x onerror=alert(1)></script><script>alert(2)</script>";

std::unique_ptr<Content> ReadFolder(const fs::path& folder) {
  DocumentBuilder builder("asset", kHostile);
  const int model = builder.AddModel(ModelOf(assets::ReadAsset(folder), &builder));
  builder.AddWorld({{"name", kHostile}, {"bodies", BodiesJson({{kHostile, model}})}});
  return std::make_unique<Content>(builder.Take());
}

ContentSource SourceOf(const fs::path& folder) {
  return {[folder] { return ReadFolder(folder); },
          [folder] { return FingerprintOf(folder.string()); }};
}

class Server : public ::testing::Test {
 protected:
  void SetUp() override {
    assets::WriteAsset(assets::SampleAsset(), folder_.path());
    core::WriteFile(folder_.path() / "secret.txt", "a secret");
    server_ = std::make_unique<ViewServer>(SourceOf(folder_.path()), 0);
    thread_ = std::thread([this] { server_->Run(); });
  }
  void TearDown() override {
    server_->Stop();
    thread_.join();
  }

  httplib::Result Get(const std::string& path, const httplib::Headers& headers = {}) {
    httplib::Client client("127.0.0.1", server_->port());
    return client.Get(path, headers);
  }

  core::TemporaryFolder folder_;
  std::unique_ptr<ViewServer> server_;
  std::thread thread_;
};

TEST_F(Server, AnswersPageManifestAndBuffers) {
  const auto page = Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_NE(page->body.find("/main.js"), std::string::npos);
  EXPECT_NE(page->get_header_value("Content-Security-Policy").find("default-src 'none'"),
            std::string::npos);
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  for (const WebFile& file : WebFiles()) {
    const auto answer = Get("/" + std::string(file.name));
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->body, file.text) << file.name;
  }
  const auto manifest = core::ParseJson(Get("/manifest")->body, "manifest");
  EXPECT_EQ(manifest["version"], 1);
  EXPECT_EQ(manifest["title"], kHostile);
  for (const auto& mesh : manifest["meshes"]) {
    const auto buffer = Get("/buffer/1/" + std::to_string(mesh["buffer"].get<int>()));
    const auto vertices = mesh["vertices"].get<std::size_t>();
    EXPECT_EQ(buffer->body.size(), vertices * 16 + mesh["triangles"].get<std::size_t>() * 12);
  }
}

TEST_F(Server, NoRequestReachesAFile) {
  for (const char* path :
       {"/../../etc/passwd", "/..%2f..%2fetc%2fpasswd", "/secret.txt", "//etc/passwd",
        "/%2e%2e/secret.txt", "/buffer/1/../../secret.txt", "/buffer/1/-1", "/buffer/1/99999999",
        "/buffer/1/9999999999999999999", "/buffer/1/1e3", "/world/1/7", "/asset.json", "/buffer",
        "/.", "/%00", "/main.js/x", "/main.js%00.txt"}) {
    const auto answer = Get(path);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 404) << path;
    EXPECT_EQ(answer->body.find("secret"), std::string::npos) << path;
    EXPECT_EQ(answer->body.find("root:"), std::string::npos) << path;
  }
  EXPECT_EQ(Get("/buffer/2/0")->status, 410) << "a version that does not exist";
  EXPECT_EQ(Get("/replay/1/0")->status, 500) << "nothing moves here";
}

TEST_F(Server, OtherMethodsAndHostsAreRefused) {
  httplib::Client client("127.0.0.1", server_->port());
  EXPECT_EQ(client.Post("/manifest", "{}", "application/json")->status, 405);
  EXPECT_EQ(client.Delete("/manifest")->status, 405);
  EXPECT_EQ(client.Options("/manifest")->status, 405);
  EXPECT_EQ(Get("/manifest", {{"Host", "evil.example"}})->status, 403);
  EXPECT_EQ(Get("/manifest", {{"Host", "evil.example:" + std::to_string(server_->port())}})->status,
            403);
  EXPECT_EQ(Get("/manifest", {{"Host", "localhost.evil.example:80"}})->status, 403);
  // A tunnel of ssh ends at another port of this computer.
  for (const char* host : {"localhost", "localhost:9000", "127.0.0.1:9000", "[::1]:9000"}) {
    EXPECT_EQ(Get("/manifest", {{"Host", host}})->status, 200) << host;
  }
}

TEST_F(Server, AnswersAThousandRequestsAtOnce) {
  std::atomic<int> good{0};
  std::vector<std::thread> clients;
  for (int i = 0; i < 1000; ++i) {
    clients.emplace_back([&, i] {
      httplib::Client client("127.0.0.1", server_->port());
      client.set_connection_timeout(60);
      client.set_read_timeout(60);
      const auto answer = client.Get(i % 2 == 0 ? "/manifest" : "/buffer/1/0");
      if (answer && answer->status == 200) ++good;
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(good, 1000);
}

// The server would wait for ten minutes for another request, longer than the test may take.
TEST_F(Server, EndsWithAConnectionThatIsIdle) {
  ViewServer server(SourceOf(folder_.path()), 0, 600);
  std::thread running([&] { server.Run(); });
  httplib::Client client("127.0.0.1", server.port());
  client.set_keep_alive(true);
  ASSERT_EQ(client.Get("/version")->status, 200);
  server.Stop();
  running.join();
  EXPECT_FALSE(client.Get("/version")) << "it still answers";
}

TEST_F(Server, RefusesAPortThatIsTaken) {
  try {
    ViewServer second(SourceOf(folder_.path()), server_->port());
    FAIL() << "the port is taken";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("--port"), std::string::npos) << error.what();
  }
}

TEST_F(Server, ATruncatedFileKeepsTheLastGoodVersion) {
  const fs::path solid = folder_.path() / "solid.obj";
  const std::string good = core::ReadFile(solid);
  LiveContent live(SourceOf(folder_.path()));
  core::WriteFile(solid, good.substr(0, good.size() / 3) + "\nf 1 2 99999\n");
  live.Refresh(0.0);
  EXPECT_EQ(live.Current().number, 1);
  EXPECT_NE(live.fault(), "");
  EXPECT_EQ(live.Current().content->document().manifest["models"].size(), 1u);
  core::WriteFile(solid, good);
  live.Refresh(0.0);
  EXPECT_EQ(live.Current().number, 2);
  EXPECT_EQ(live.fault(), "");
  EXPECT_NE(live.Version(1), nullptr) << "pages may still load the version before";
  EXPECT_EQ(live.Version(3), nullptr);
}

TEST_F(Server, AChangeIsReadOnceItIsQuiet) {
  LiveContent live(SourceOf(folder_.path()));
  live.Refresh(0.0);
  EXPECT_EQ(live.Current().number, 1) << "nothing has changed";
  core::WriteFile(folder_.path() / "secret.txt", "another text");
  live.Refresh(60.0);
  EXPECT_EQ(live.Current().number, 1) << "the writer may not have finished";
  live.Refresh(0.0);
  EXPECT_EQ(live.Current().number, 2);
}

TEST_F(Server, ASingleFileHoldsTheContentWithoutMarkupFromData) {
  const std::unique_ptr<Content> content = ReadFolder(folder_.path());
  core::Progress progress;
  core::Findings findings;
  const std::string page = SingleFilePage(content.get(), {}, &progress, &findings);
  EXPECT_TRUE(findings.empty());
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_NE(page.find("\\u003cimg src=x"), std::string::npos);
  EXPECT_EQ(page.find("http://"), std::string::npos) << "it loads nothing";
  EXPECT_EQ(page, SingleFilePage(content.get(), {}, &progress, &findings)) << "the same bytes";
  SingleFileOptions small;
  small.largest = 100;
  EXPECT_THROW(SingleFilePage(content.get(), small, &progress, &findings), core::Error);
}

}  // namespace
}  // namespace simwright::viewer
