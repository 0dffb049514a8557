// The exchange with a generator's server, against real servers on this machine.
#include <gtest/gtest.h>

#include "core/base64.h"
#include "core/error.h"
#include "core/progress.h"
#include "workflows/generator/generator_answer.h"

#include "tests/workflows/generator_server.h"  // last: see there

namespace simwright::workflows {
namespace {

constexpr const char* kPhoto = "\x89PNG the bytes of a photo";

GeneratedMesh AskFor(const GeneratorOptions& options, llm::Clock* clock) {
  core::Progress silent;
  return AskGeneratorServer(kPhoto, options, &silent, *clock);
}
GeneratedMesh AskFor(const GeneratorOptions& options) {
  llm::StillClock clock;
  return AskFor(options, &clock);
}

// Returns the message of the failure, which has one line and not the key.
std::string ServerFailure(const GeneratorOptions& options, llm::Clock* clock) {
  try {
    AskFor(options, clock);
  } catch (const core::Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.find(kGeneratorKey), std::string::npos) << message;
    return message;
  }
  return "no failure";
}
std::string ServerFailure(const GeneratorOptions& options) {
  llm::StillClock clock;
  return ServerFailure(options, &clock);
}

TEST(GeneratorClient, PostsJsonAsHunyuanExpectsAndTakesTheGlb) {
  const std::string glb = BoxGlb(1, 2, 3);
  GeneratorServer server(Answering(glb));
  GeneratorOptions options = GeneratorAt(server.url());
  options.parameters = {{"texture", "true"}, {"seed", "7"}, {"note", "a b"}};
  const GeneratedMesh mesh = AskFor(options);
  EXPECT_EQ(mesh.bytes, glb);
  EXPECT_EQ(mesh.extension, ".glb");
  EXPECT_EQ(mesh.generator, server.url());
  const SeenRequest request = server.seen().at(0);
  EXPECT_EQ(request.path, "/generate");
  EXPECT_EQ(request.content_type, "application/json");
  EXPECT_EQ(request.authorization, std::string("Bearer ") + kGeneratorKey);
  const nlohmann::json json = nlohmann::json::parse(request.body);
  EXPECT_EQ(core::FromBase64(json.at("image").get<std::string>()).value(), kPhoto);
  EXPECT_EQ(json.at("texture"), true);
  EXPECT_EQ(json.at("seed"), 7);
  EXPECT_EQ(json.at("note"), "a b");
}

TEST(GeneratorClient, PostsMultipartAsStableFast3dExpects) {
  GeneratorServer server(Answering("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  GeneratorOptions options = GeneratorAt(server.url());
  options.format = GeneratorFormat::kMultipart;
  options.field = "file";
  options.parameters = {{"texture_resolution", "1024"}};
  EXPECT_EQ(AskFor(options).extension, ".obj");
  const SeenRequest request = server.seen().at(0);
  ExpectIn("multipart/form-data; boundary=", request.content_type);
  const auto photo = request.files.find("file");
  ASSERT_NE(photo, request.files.end());
  EXPECT_EQ(photo->second.content, kPhoto);
  EXPECT_EQ(photo->second.content_type, "image/png");
  EXPECT_EQ(photo->second.filename, "photo.png");
  EXPECT_EQ(request.files.find("texture_resolution")->second.content, "1024");
}

TEST(GeneratorClient, TriesMultipartWhereJsonIsRefused) {
  for (const int refusal : {400, 415, 422}) {
    GeneratorServer server([&](int, const httplib::Request& request, httplib::Response& response) {
      if (request.get_header_value("Content-Type") == "application/json") {
        response.status = refusal;
      } else {
        response.set_content(BoxGlb(1, 1, 1), "model/gltf-binary");
      }
    });
    const GeneratedMesh mesh = AskFor(GeneratorAt(server.url()));
    EXPECT_EQ(server.seen().size(), 2u);
    EXPECT_EQ(server.seen().at(1).files.count("image"), 1u);
    ASSERT_EQ(mesh.findings.size(), 1u);
    EXPECT_EQ(mesh.findings[0].code, "generator-format");
    GeneratorOptions json = GeneratorAt(server.url());
    json.format = GeneratorFormat::kJson;
    ExpectIn("--generator-format", ServerFailure(json));
  }
}

TEST(GeneratorClient, TakesBase64AnywhereInJson) {
  const std::string glb = BoxGlb(1, 1, 1), base64 = core::Base64(glb);
  for (const nlohmann::json& answer :
       {nlohmann::json{{"model_base64", base64}}, nlohmann::json{{"output", {{"glb", base64}}}},
        nlohmann::json{{"data", {"data:model/gltf-binary;base64," + base64}}},
        nlohmann::json{{"status", "completed"}, {"id", "x"}, {"mesh", base64}}}) {
    GeneratorServer server(Answering(answer.dump(), 200, "application/json"));
    EXPECT_EQ(AskFor(GeneratorAt(server.url())).bytes, glb) << answer.dump().substr(0, 80);
  }
}

TEST(GeneratorClient, PollsATaskAsHunyuanOffersIt) {
  const std::string glb = BoxGlb(1, 1, 1);
  GeneratorServer server([&](int number, const httplib::Request& request, httplib::Response& r) {
    nlohmann::json answer = {{"status", "processing"}};
    if (request.method == "POST") answer = {{"uid", "0b-1f"}};
    if (number == 3) answer = {{"status", "completed"}, {"model_base64", core::Base64(glb)}};
    r.set_content(answer.dump(), "application/json");
  });
  llm::StillClock clock;
  EXPECT_EQ(AskFor(GeneratorAt(server.origin() + "/send"), &clock).bytes, glb);
  ASSERT_EQ(server.seen().size(), 4u);
  EXPECT_EQ(server.seen()[3].method, "GET");
  EXPECT_EQ(server.seen()[3].path, "/status/0b-1f");
  EXPECT_EQ(clock.sleeps, std::vector<double>(3, 2.0));
}

TEST(GeneratorClient, PollsTheAddressThatIsNamedOrGivenAndFetchesTheMesh) {
  const std::string glb = BoxGlb(1, 1, 1);
  for (const bool named : {true, false}) {
    GeneratorServer server([&](int, const httplib::Request& request, httplib::Response& response) {
      if (request.target == "/api/convert") {
        nlohmann::json answer = {{"job_id", 42}, {"status", "pending"}};
        if (named) answer["status_url"] = "/jobs/42?full=1";
        response.set_content(answer.dump(), "application/json");
      } else if (request.target == "/files/42.glb") {
        response.set_content(glb, "model/gltf-binary");
      } else {
        EXPECT_EQ(request.target, named ? "/jobs/42?full=1" : "/tasks/42");
        response.set_content(R"({"status": "COMPLETED", "download_url": "/files/42.glb"})",
                             "application/json");
      }
    });
    GeneratorOptions options = GeneratorAt(server.origin() + "/api/convert");
    if (!named) options.status_url = server.origin() + "/tasks/{id}";
    EXPECT_EQ(AskFor(options).bytes, glb);
    EXPECT_EQ(server.seen().at(2).authorization, std::string("Bearer ") + kGeneratorKey);
  }
}

TEST(GeneratorClient, TheKeyStaysWithItsServer) {
  const std::string glb = BoxGlb(1, 1, 1);
  GeneratorServer files(Answering(glb));
  GeneratorServer server(
      Answering(nlohmann::json{{"model_mesh", {{"url", files.origin() + "/a.glb"}}}}.dump(), 200));
  EXPECT_EQ(AskFor(GeneratorAt(server.url())).bytes, glb);
  EXPECT_EQ(files.seen().at(0).authorization, "");
  // A photo follows no redirect to another server.
  GeneratorServer moved([&](int, const httplib::Request&, httplib::Response& response) {
    response.set_redirect(files.origin() + "/generate", 307);
  });
  ExpectIn("redirects to " + files.origin(), ServerFailure(GeneratorAt(moved.url())));
  EXPECT_EQ(files.seen().size(), 1u);
  GeneratorServer echo(Answering(std::string("bad key ") + kGeneratorKey, 401, "text/plain"));
  const std::string message = ServerFailure(GeneratorAt(echo.url()));
  ExpectIn("[redacted]", message);
  ExpectIn("SIMWRIGHT_GENERATOR_KEY", message);
}

TEST(GeneratorClient, RetriesWhatMayPass) {
  const std::string glb = BoxGlb(1, 1, 1);
  GeneratorServer server([&](int number, const httplib::Request&, httplib::Response& response) {
    response.status = number == 0 ? 503 : number == 1 ? 429 : 200;
    if (number == 1) response.set_header("Retry-After", "7");
    if (number == 2) response.set_content(glb, "model/gltf-binary");
  });
  llm::StillClock clock;
  EXPECT_EQ(AskFor(GeneratorAt(server.url()), &clock).bytes, glb);
  ASSERT_EQ(clock.sleeps.size(), 2u);
  EXPECT_GE(clock.sleeps[0], 0.5);
  EXPECT_LE(clock.sleeps[0], 1.0);
  EXPECT_EQ(clock.sleeps[1], 7.0);
  GeneratorServer down(Answering("overloaded", 503, "text/plain"));
  llm::StillClock patient;
  ExpectIn("status 503", ServerFailure(GeneratorAt(down.url()), &patient));
  EXPECT_EQ(down.seen().size(), 5u);
  EXPECT_EQ(patient.sleeps.size(), 4u);
  // A Retry-After beyond the timeout is not waited for.
  GeneratorServer late([&](int, const httplib::Request&, httplib::Response& response) {
    response.status = 503;
    response.set_header("Retry-After", "5000");
  });
  ExpectIn("--generator-timeout", ServerFailure(GeneratorAt(late.url())));
}

TEST(GeneratorClient, ARefusedConnectionIsRetriedAndThenReported) {
  std::string url;
  { url = GeneratorServer(Answering("")).url(); }
  llm::StillClock clock;
  const std::string message = ServerFailure(GeneratorAt(url), &clock);
  ExpectIn(url, message);
  ExpectIn("5 times in a row", message);
  ExpectIn("is the server running", message);
  EXPECT_EQ(clock.sleeps.size(), 4u);
}

TEST(GeneratorClient, ASlowServerEndsAtTheTimeout) {
  GeneratorServer* running = nullptr;
  GeneratorServer server([&](int, const httplib::Request&, httplib::Response& response) {
    for (int i = 0; i < 500 && !running->stopping(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    response.set_content(BoxGlb(1, 1, 1), "model/gltf-binary");
  });
  running = &server;
  GeneratorOptions options = GeneratorAt(server.url());
  options.timeout = 0.3;
  ExpectIn("no mesh arrived within 0.3 s", ServerFailure(options));
  // A task that never ends.
  GeneratorServer tasks(Answering(R"({"uid": "a", "status": "queued"})", 200));
  llm::StillClock clock;
  ExpectIn("no mesh arrived within 100 s", ServerFailure(GeneratorAt(tasks.url()), &clock));
  EXPECT_EQ(clock.sleeps.size(), 49u);
}

TEST(GeneratorClient, CtrlCEndsTheWait) {
  GeneratorServer tasks(Answering(R"({"uid": "a", "status": "queued"})", 200));
  llm::StillClock clock;
  clock.cancel_in_sleep = true;
  EXPECT_THROW(AskFor(GeneratorAt(tasks.url()), &clock), core::Cancelled);
  EXPECT_EQ(tasks.seen().size(), 1u);
}

TEST(GeneratorClient, StopsTheTransferOfALargeAnswer) {
  constexpr std::size_t kLength = 2ull << 30;
  std::atomic<std::size_t> sent = 0;
  const std::string block(1 << 16, 'x');
  GeneratorServer stated([&](int, const httplib::Request&, httplib::Response& response) {
    response.set_content_provider(kLength, "model/gltf-binary",
                                  [&](std::size_t, std::size_t length, httplib::DataSink& sink) {
                                    const std::size_t count = std::min(length, block.size());
                                    sent += count;
                                    return sink.write(block.data(), count);
                                  });
  });
  const std::string message = ServerFailure(GeneratorAt(stated.url()));
  ExpectIn("larger than 512 MiB", message);
  EXPECT_LT(sent, 64u << 20);  // the header is enough
  sent = 0;
  GeneratorServer chunked([&](int, const httplib::Request&, httplib::Response& response) {
    response.set_chunked_content_provider("model/gltf-binary",
                                          [&](std::size_t, httplib::DataSink& sink) {
                                            sent += block.size();
                                            return sink.write(block.data(), block.size());
                                          });
  });
  GeneratorOptions options = GeneratorAt(chunked.url());
  options.max_answer_bytes = 1 << 20;
  ExpectIn("larger than 1 MiB", ServerFailure(options));
  EXPECT_LT(sent, 64u << 20);
  EXPECT_EQ(chunked.seen().size(), 1u);  // not retried
}

TEST(GeneratorClient, AnswersThatAreNoMeshAreNamed) {
  const auto failure = [](const std::string& body, int status = 200) {
    GeneratorServer server(Answering(body, status));
    return ServerFailure(GeneratorAt(server.url()));
  };
  ExpectIn("a web page (HTML)", failure("<!DOCTYPE html><html><title>Gradio</title></html>"));
  ExpectIn("its answer is empty", failure(""));
  ExpectIn("damaged JSON", failure("{\"model_base64\": \"Z2x"));
  ExpectIn("JSON without a mesh", failure("{\"hello\": 1}"));
  ExpectIn("no mesh but \"sorry\"", failure("sorry"));
  ExpectIn("unknown binary format", failure(std::string("\x01\x02\x00\x03", 4)));
  ExpectIn("the generator failed: CUDA out of memory",
           failure(R"({"status": "failed", "error": "CUDA out of memory"})"));
  ExpectIn("status 404: NETWORK ERROR",
           failure(R"({"text": "NETWORK ERROR", "error_code": 1})", 404));
  ExpectIn("without an id", failure(R"({"status": "queued"})"));
  ExpectIn("without an id", failure(R"({"uid": "../../etc", "status": "queued"})"));
  ExpectIn("no http or https address", failure(R"({"model_url": "file:///etc/passwd"})"));
}

TEST(GeneratorAnswer, NeverThrowsOnDamagedAnswers) {
  const std::string json = nlohmann::json{
      {"status", "completed"},
      {"output", {{"mesh", core::Base64(BoxGlb(1, 1, 1))}, {"url", "http://a/b.glb"}}},
      {"id", 3}}.dump();
  for (std::size_t i = 0; i <= json.size(); i += 3) {
    ReadGeneratorAnswer(json.substr(0, i));
    std::string changed = json;
    if (i < changed.size()) changed[i] = static_cast<char>(changed[i] ^ 0x55);
    ReadGeneratorAnswer(changed);
  }
  EXPECT_EQ(ReadGeneratorAnswer(std::string(100000, '[')).kind, GeneratorAnswer::Kind::kUnusable);
  EXPECT_EQ(MeshExtensionOf("# made by x\r\nmtllib a.mtl\no box\nv 0 0 0\n"), ".obj");
  EXPECT_EQ(MeshExtensionOf("very nice\nv 0 0 0\n"), "");
}

TEST(GeneratorOptions, AreChecked) {
  const auto fault = [](const std::function<void(GeneratorOptions*)>& change) {
    GeneratorOptions options = GeneratorAt("http://localhost:8081/generate");
    change(&options);
    try {
      Validate(options);
      return std::string();
    } catch (const core::Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(fault([](auto*) {}), "");
  ExpectIn("not an http or https address", fault([](auto* o) { o->url = "ftp://a/b"; }));
  ExpectIn("exclude each other", fault([](auto* o) { o->command = "a {in} {out}"; }));
  ExpectIn("--generator-timeout", fault([](auto* o) { o->timeout = 0.0; }));
  ExpectIn("line break", fault([](auto* o) { o->key = "a\r\nHost: b"; }));
  ExpectIn("--generator-field", fault([](auto* o) { o->field = "a\"; x=\""; }));
  ExpectIn("{id}", fault([](auto* o) { o->status_url = "http://localhost/status"; }));
}

}  // namespace
}  // namespace simwright::workflows
