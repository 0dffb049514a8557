// Tests the client with servers that answer well, late, in pieces, wrongly, too much or not at all.
#include "llm/openai_chat_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/error.h"

#include "exchanges.h"  // last: see there

namespace simwright::llm {
namespace {

using httplib::Request;
using httplib::Response;

TEST(OpenAiChatModel, AsksAndReadsTheAnswer) {
  ChatServer server(Always(200, GoodBody("A mug weighs 300 g.")));
  StillClock clock;
  OpenAiChatModel model(OptionsFor(server.url()), clock);
  ChatRequest request = Question("How heavy is a mug? ü");
  request.messages.insert(request.messages.begin(), {Role::kSystem, "Be short.", {}});
  request.temperature = 0.25;
  request.max_tokens = 100;
  request.seed = 7;
  request.json = true;
  const ChatAnswer answer = model.Ask(request);
  EXPECT_EQ(answer.text, "A mug weighs 300 g.");
  EXPECT_EQ(answer.finish_reason, "stop");
  EXPECT_EQ(answer.tokens.input, 11);
  EXPECT_EQ(answer.tokens.output, 7);
  EXPECT_EQ(answer.attempts, 1);
  EXPECT_FALSE(answer.from_cache);
  const nlohmann::json expected = {{"model", "tiny"},
                                   {"messages",
                                    {{{"role", "system"}, {"content", "Be short."}},
                                     {{"role", "user"}, {"content", "How heavy is a mug? ü"}}}},
                                   {"temperature", 0.25},
                                   {"max_tokens", 100},
                                   {"seed", 7},
                                   {"response_format", {{"type", "json_object"}}},
                                   {"stream", false}};
  EXPECT_EQ(server.body(0), expected);
  EXPECT_EQ(server.paths()[0], "/v1/chat/completions");
  EXPECT_EQ(server.authorizations()[0], std::string("Bearer ") + kKey);
  EXPECT_TRUE(clock.sleeps.empty());
}

TEST(OpenAiChatModel, NoKeyAndNoModelAreNotSent) {
  ChatServer server(Always(200, GoodBody("x")));
  ChatModelOptions options;
  options.url = "http://127.0.0.1:" + std::to_string(server.port());
  OpenAiChatModel model(options);
  EXPECT_EQ(model.Ask(Question("hello")).text, "x");
  EXPECT_EQ(server.authorizations()[0], "");
  EXPECT_FALSE(server.body(0).contains("model"));
  EXPECT_EQ(server.paths()[0], "/v1/chat/completions");
}

TEST(OpenAiChatModel, ImagesTravelAsDataUrls) {
  ChatServer server(Always(200, GoodBody("a dot")));
  OpenAiChatModel model(OptionsFor(server.url()));
  ChatRequest request = Question("What is this?");
  request.messages[0].images.push_back({"image/png", std::string("\x89PNG\0\xff", 6)});
  model.Ask(request);
  const nlohmann::json content = server.body(0)["messages"][0]["content"];
  ASSERT_EQ(content.size(), 2u);
  EXPECT_EQ(content[0]["text"], "What is this?");
  EXPECT_EQ(content[1]["image_url"]["url"], "data:image/png;base64,iVBORwD/");
  request.messages[0].images[0].mime_type = "text/html";
  EXPECT_THROW(model.Ask(request), core::Error);
  EXPECT_EQ(server.bodies().size(), 1u);
}

TEST(OpenAiChatModel, PiecesAreJoined) {
  const std::string body = GoodBody(std::string(100000, 'a'));
  ChatServer server([&](int, const Request&, Response& response) {
    response.set_chunked_content_provider(
        "application/json", [&body](std::size_t offset, httplib::DataSink& sink) {
          if (offset < body.size()) {
            return sink.write(&body[offset], std::min<std::size_t>(977, body.size() - offset));
          }
          sink.done();
          return true;
        });
  });
  OpenAiChatModel model(OptionsFor(server.url()));
  const ChatAnswer answer = model.Ask(Question("hello"));
  EXPECT_EQ(answer.text.size(), 100000u);
  EXPECT_EQ(answer.attempts, 1);
}

TEST(OpenAiChatModel, AServerErrorIsAskedAgainAfterGrowingWaits) {
  ChatServer server(Always(503, R"({"error": {"message": "loading the model"}})"));
  StillClock clock;
  OpenAiChatModel model(OptionsFor(server.url()), clock);
  const std::string error = ErrorOf(&model);
  ExpectHas(error, "status 503: loading the model, 5 times in a row");
  ExpectHas(error, "test question");
  EXPECT_EQ(server.bodies().size(), 5u);
  ASSERT_EQ(clock.sleeps.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const double most = std::pow(2.0, i);
    EXPECT_GE(clock.sleeps[static_cast<std::size_t>(i)], 0.5 * most);
    EXPECT_LE(clock.sleeps[static_cast<std::size_t>(i)], most);
  }
  // Equal seeds give equal waits, different seeds different ones.
  StillClock again, other;
  ErrorOf(std::make_unique<OpenAiChatModel>(OptionsFor(server.url()), again).get());
  ChatModelOptions options = OptionsFor(server.url());
  options.jitter_seed = 2;
  ErrorOf(std::make_unique<OpenAiChatModel>(options, other).get());
  EXPECT_EQ(again.sleeps, clock.sleeps);
  EXPECT_NE(other.sleeps, clock.sleeps);
}

TEST(OpenAiChatModel, WaitsAreBounded) {
  RetrySchedule schedule(1.0, 30.0, core::Rng(3));
  double total = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double wait = schedule.NextWait();
    EXPECT_LE(wait, 30.0);
    total += wait;
  }
  EXPECT_GT(total, 45 * 15.0);
}

TEST(OpenAiChatModel, AFaultThatPassesIsAnsweredByTheSecondAttempt) {
  ChatServer server(Once([](Response& response) { response.status = 500; }));
  StillClock clock;
  OpenAiChatModel model(OptionsFor(server.url()), clock);
  const ChatAnswer answer = model.Ask(Question("hello"));
  EXPECT_EQ(answer.text, "fine");
  EXPECT_EQ(answer.attempts, 2);
  EXPECT_EQ(clock.sleeps.size(), 1u);
  EXPECT_EQ(model.usage().answers, 1);
  EXPECT_EQ(model.usage().attempts, 2);
}

TEST(OpenAiChatModel, RetryAfterIsHonoured) {
  const auto wait_of = [](const std::string& header) {
    ChatServer server(Once([&](Response& response) {
      response.status = 429;
      response.set_header("Retry-After", header);
    }));
    StillClock clock;
    OpenAiChatModel model(OptionsFor(server.url()), clock);
    EXPECT_EQ(model.Ask(Question("hello")).attempts, 2);
    EXPECT_EQ(clock.sleeps.size(), 1u);
    return clock.sleeps.at(0);
  };
  EXPECT_EQ(wait_of("17"), 17.0);
  EXPECT_EQ(wait_of("0.25"), 0.25);
  EXPECT_EQ(wait_of("-5"), 0.0);
  EXPECT_EQ(wait_of("Wed, 21 Oct 2015 07:28:40 GMT"), 40.0);
  EXPECT_EQ(wait_of("Wed, 21 Oct 2015 07:00:00 GMT"), 0.0);
  const double planned = wait_of("soon");  // no date: as without the header
  EXPECT_GE(planned, 0.5);
  EXPECT_LE(planned, 1.0);
}

TEST(OpenAiChatModel, ALongRetryAfterEndsAtOnce) {
  ChatServer server([](int, const Request&, Response& response) {
    response.status = 429;
    response.set_header("Retry-After", "3600");
    response.set_content(R"({"error": {"message": "slow down"}})", "application/json");
  });
  StillClock clock;
  OpenAiChatModel model(OptionsFor(server.url()), clock);
  const std::string error = ErrorOf(&model);
  ExpectHas(error, "slow down");
  ExpectHas(error, "3600 s");
  EXPECT_EQ(server.bodies().size(), 1u);
  EXPECT_TRUE(clock.sleeps.empty());
}

TEST(OpenAiChatModel, OtherRefusalsEndAtOnceWithTheServersWords) {
  const auto error_of = [](int status, const std::string& body) {
    ChatServer server(Always(status, body));
    StillClock clock;
    OpenAiChatModel model(OptionsFor(server.url()), clock);
    const std::string error = ErrorOf(&model);
    EXPECT_EQ(server.bodies().size(), 1u) << status;
    return error;
  };
  ExpectHas(error_of(404, R"({"error": {"message": "model 'tiny' not found"}})"),
            "model 'tiny' not found");
  ExpectHas(error_of(404, R"({"object": "error", "message": "no such model"})"), "no such model");
  ExpectHas(error_of(422, R"({"detail": [{"msg": "field required"}]})"), "field required");
  ExpectHas(error_of(413, "too long"), "status 413: too long");
  ExpectHas(error_of(401, ""), "SIMWRIGHT_LLM_KEY");
  ExpectHas(error_of(400, R"({"error": ")" + std::string(5000, 'x') + "\"}"), "xxx...");
  ExpectHas(error_of(429, R"({"error": {"message": "no money", "code": "insufficient_quota"}})"),
            "no money");
  // Gateways put errors under status 200.
  ExpectHas(error_of(200, R"({"error": {"message": "no credits", "code": 402}})"),
            "status 402: no credits");
}

TEST(OpenAiChatModel, WhatIsNoChatServerIsNamed) {
  const auto error_of = [](const std::string& body, const std::string& type) {
    ChatServer server(Always(200, body, type));
    StillClock clock;
    OpenAiChatModel model(OptionsFor(server.url()), clock);
    const std::string error = ErrorOf(&model);
    EXPECT_EQ(server.bodies().size(), 1u);
    return error;
  };
  ExpectHas(error_of("<html><h1>Sign in</h1></html>", "text/html"), "HTML");
  ExpectHas(error_of("Ollama is running", "text/plain"), "Ollama is running");
  ExpectHas(error_of(R"({"models": []})", "application/json"), "without choices");
  ExpectHas(error_of("[1, 2]", "application/json"), "without choices");
  ExpectHas(error_of(std::string(100000, '['), "application/json"), "deeper");
}

TEST(OpenAiChatModel, AWrongContentTypeIsNoFault) {
  ChatServer server(Always(200, GoodBody("fine"), "text/plain"));
  OpenAiChatModel model(OptionsFor(server.url()));
  EXPECT_EQ(model.Ask(Question("hello")).text, "fine");
}

TEST(OpenAiChatModel, CutOffAnswersAreAskedAgain) {
  const std::string body = GoodBody("fine");
  for (const std::string& cut : {body.substr(0, body.size() / 2), std::string()}) {
    ChatServer server(
        Once([&](Response& response) { response.set_content(cut, "application/json"); }));
    StillClock clock;
    OpenAiChatModel model(OptionsFor(server.url()), clock);
    const ChatAnswer answer = model.Ask(Question("hello"));
    EXPECT_EQ(answer.text, "fine");
    EXPECT_EQ(answer.attempts, 2);
  }
}

TEST(OpenAiChatModel, ConnectionsThatBreakAreMadeAgain) {
  for (const std::string& reply :
       {std::string(), std::string("HTTP/1.1 200 OK\r\nContent-Length: 500\r\n\r\n{\"choices\""),
        std::string("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n5\r\n{\"cho")}) {
    RawServer server(reply);
    StillClock clock;
    ChatModelOptions options = OptionsFor(server.url());
    options.max_attempts = 3;
    OpenAiChatModel model(options, clock);
    ExpectHas(ErrorOf(&model), "3 times in a row");
    EXPECT_EQ(server.connections(), 3) << reply;
    EXPECT_EQ(clock.sleeps.size(), 2u);
    EXPECT_EQ(model.usage().attempts, 3);
    EXPECT_EQ(model.usage().answers, 0);
  }
}

TEST(OpenAiChatModel, WhatSpeaksNoHttpIsNamed) {
  RawServer server("220 mail ready\r\n");
  OpenAiChatModel model(OptionsFor(server.url()));
  ExpectHas(ErrorOf(&model), "does not speak HTTP");
  EXPECT_EQ(server.connections(), 1);
}

TEST(OpenAiChatModel, NoServerIsNamed) {
  std::string url;
  {
    RawServer gone("");
    url = gone.url();
  }
  StillClock clock;
  ChatModelOptions options = OptionsFor(url);
  options.max_attempts = 2;
  OpenAiChatModel model(options, clock);
  ExpectHas(ErrorOf(&model), "is the server running");
  EXPECT_EQ(clock.sleeps.size(), 1u);
}

TEST(OpenAiChatModel, FiftyMegabytesAreCutOff) {
  constexpr std::size_t kTotal = 50u << 20, kPiece = 1u << 16;
  std::atomic<std::size_t> sent = 0;
  ChatServer server([&](int, const Request&, Response& response) {
    response.set_content_provider(kTotal, "application/json",
                                  [&](std::size_t, std::size_t, httplib::DataSink& sink) {
                                    const std::string piece(kPiece, ' ');
                                    if (!sink.write(piece.data(), piece.size())) return false;
                                    sent += kPiece;
                                    return true;
                                  });
  });
  StillClock clock;
  OpenAiChatModel model(OptionsFor(server.url()), clock);
  ExpectHas(ErrorOf(&model), "larger than 8388608 bytes");
  EXPECT_EQ(server.bodies().size(), 1u);
  EXPECT_LT(sent.load(), kTotal);
}

TEST(OpenAiChatModel, AnAnswerJustWithinTheLimitIsTaken) {
  const std::string body = GoodBody("fine");
  ChatServer server(Always(200, body));
  ChatModelOptions options = OptionsFor(server.url());
  options.max_answer_bytes = body.size();
  EXPECT_EQ(OpenAiChatModel(options).Ask(Question("hello")).text, "fine");
  options.max_answer_bytes = body.size() - 1;
  OpenAiChatModel model(options);
  ExpectHas(ErrorOf(&model), "larger");
}

// Silent until the client disconnects, so that the client's limits decide and not the test's clock.
void WaitWhile(const ChatServer* server, const std::atomic<bool>& done) {
  while (!done && !server->stopping()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

TEST(OpenAiChatModel, TooSlowAnAnswerEndsAtTheTotalTime) {
  std::atomic<bool> done = false;
  std::unique_ptr<ChatServer> server;
  server = std::make_unique<ChatServer>(
      [&](int, const Request&, Response&) { WaitWhile(server.get(), done); });
  StillClock clock;
  ChatModelOptions options = OptionsFor(server->url());
  options.total_timeout = 0.05;
  OpenAiChatModel model(options, clock);
  ExpectHas(ErrorOf(&model), "no complete answer in time");
  done = true;
  EXPECT_EQ(server->bodies().size(), 1u);
}

TEST(OpenAiChatModel, AnAnswerThatFallsSilentIsAskedAgain) {
  std::atomic<bool> done = false;
  std::unique_ptr<ChatServer> server;
  server = std::make_unique<ChatServer>([&](int number, const Request&, Response& response) {
    if (number > 0) return response.set_content(GoodBody("fine"), "application/json");
    response.set_content_provider(1000, "application/json",
                                  [&](std::size_t offset, std::size_t, httplib::DataSink& sink) {
                                    if (offset == 0) return sink.write("{", 1);
                                    WaitWhile(server.get(), done);
                                    return false;
                                  });
  });
  StillClock clock;
  ChatModelOptions options = OptionsFor(server->url());
  options.stall_timeout = 0.05;
  OpenAiChatModel model(options, clock);
  const ChatAnswer answer = model.Ask(Question("hello"));
  done = true;
  EXPECT_EQ(answer.attempts, 2);
  EXPECT_EQ(clock.sleeps.size(), 1u);
}

TEST(OpenAiChatModel, CancelEndsTheTransferAndTheWait) {
  std::unique_ptr<ChatServer> server;
  StillClock clock;
  server = std::make_unique<ChatServer>([&](int, const Request&, Response&) {
    clock.cancelled = true;  // simulates Ctrl-C once the question is sent
    WaitWhile(server.get(), false);
  });
  OpenAiChatModel model(OptionsFor(server->url()), clock);
  EXPECT_THROW(model.Ask(Question("hello")), core::Cancelled);
  EXPECT_EQ(server->bodies().size(), 1u);

  ChatServer busy(Always(503, ""));
  StillClock waiting;
  waiting.cancel_in_sleep = true;
  OpenAiChatModel patient(OptionsFor(busy.url()), waiting);
  EXPECT_THROW(patient.Ask(Question("hello")), core::Cancelled);
  EXPECT_EQ(busy.bodies().size(), 1u);
  EXPECT_EQ(waiting.sleeps.size(), 1u);
}

// The real clock: Ctrl-C is reported by core/progress.h.
TEST(OpenAiChatModelDeathTest, CtrlCIsNoticedBeforeAnythingIsSent) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        core::RequestCancel();
        SystemClock().Sleep(3600.0);  // returns at once
        try {
          OpenAiChatModel(OptionsFor("http://127.0.0.1:1/v1")).Ask(Question("hello"));
        } catch (const core::Cancelled&) {
          std::exit(3);
        }
        std::exit(4);
      },
      ::testing::ExitedWithCode(3), "");
}

TEST(OpenAiChatModel, WhatTheServerRefusesIsLeftOutFromThenOn) {
  ChatServer server([](int, const Request& request, Response& response) {
    const nlohmann::json body = nlohmann::json::parse(request.body);
    const auto refuse = [&](const std::string& message) {
      response.status = 400;
      response.set_content(nlohmann::json{{"error", {{"message", message}}}}.dump(),
                           "application/json");
    };
    if (body.contains("response_format")) return refuse("response_format is not supported");
    if (body.contains("max_tokens")) return refuse("use 'max_completion_tokens' instead");
    if (body.contains("temperature")) return refuse("Unsupported value: 'temperature'");
    response.set_content(GoodBody("{}"), "application/json");
  });
  StillClock clock;
  OpenAiChatModel model(OptionsFor(server.url()), clock);
  ChatRequest request = Question("hello");
  request.json = true;
  request.max_tokens = 50;
  request.temperature = 0.0;
  EXPECT_EQ(model.Ask(request).attempts, 4);
  EXPECT_TRUE(clock.sleeps.empty());
  EXPECT_EQ(server.body(3)["max_completion_tokens"], 50);
  EXPECT_EQ(model.TakeFindings().size(), 3u);
  EXPECT_TRUE(model.TakeFindings().empty());
  EXPECT_EQ(model.Ask(request).attempts, 1);
}

TEST(OpenAiChatModel, ARefusalOfWhatWasNotSentEndsAtOnce) {
  ChatServer server(Always(400, R"({"error": {"message": "response_format is odd"}})"));
  OpenAiChatModel model(OptionsFor(server.url()));
  ExpectHas(ErrorOf(&model), "response_format is odd");
  EXPECT_EQ(server.bodies().size(), 1u);
}

TEST(OpenAiChatModel, UsageAddsUpWithItsCost) {
  ChatServer server(Always(200, GoodBody("fine", 1000, 500)));
  ChatModelOptions options = OptionsFor(server.url());
  OpenAiChatModel free(options);
  free.Ask(Question("hello"));
  EXPECT_FALSE(free.usage().cost.has_value());
  options.input_price = 2.0;
  options.output_price = 8.0;
  OpenAiChatModel model(options);
  for (int i = 0; i < 3; ++i) model.Ask(Question("hello"));
  EXPECT_EQ(model.usage().answers, 3);
  EXPECT_EQ(model.usage().tokens.input, 3000);
  EXPECT_EQ(model.usage().tokens.output, 1500);
  EXPECT_DOUBLE_EQ(*model.usage().cost, 3 * (1000 * 2.0 + 500 * 8.0) / 1e6);
}

}  // namespace
}  // namespace simwright::llm
