// The key is sent only to its own server and appears nowhere else.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/log.h"
#include "llm/openai_chat_model.h"

#include "exchanges.h"  // last: see there

namespace simwright::llm {
namespace {

using httplib::Request;
using httplib::Response;

TEST(KeySafety, TheKeyIsInNoAnswerErrorOrFinding) {
  const std::string key = kKey;
  ChatServer echo(Always(200, GoodBody("your key is " + key + ", begins " + key.substr(0, 14))));
  OpenAiChatModel model(OptionsFor(echo.url()));
  EXPECT_EQ(model.Ask(Question("hello")).text, "your key is [redacted], begins [redacted]");
  for (const int status : {200, 401, 403}) {
    ChatServer refusing(
        Always(status, R"({"error": {"message": "Bearer )" + key + R"( is no good key"}})"));
    OpenAiChatModel refused(OptionsFor(refusing.url()));
    ExpectHas(ErrorOf(&refused), "[redacted] is no good key");
  }
  // Truncating the quote must not leave half of the key.
  for (std::size_t lead = 270; lead < 310; ++lead) {
    ChatServer long_winded(Always(403, std::string(lead, 'x') + key));
    OpenAiChatModel refused(OptionsFor(long_winded.url()));
    EXPECT_EQ(ErrorOf(&refused).find("sk-test"), std::string::npos);
  }
  // A key in the question would end up in the transcript.
  ErrorOf(&model, Question("my key is " + key));
  EXPECT_EQ(echo.bodies().size(), 1u);
}

TEST(KeySafety, TheKeyIsInNoLogLine) {
  std::string log;
  core::SetLogLevel(core::LogLevel::kTrace);
  core::SetLogSink([&log](const core::LogLine& line) { log += std::string(line.text) + "\n"; });
  ChatServer busy(Once([](Response& response) {
    response.status = 503;
    response.set_content(std::string(R"({"error": {"message": "busy with )") + kKey + R"("}})",
                         "application/json");
  }));
  StillClock clock;
  OpenAiChatModel model(OptionsFor(busy.url()), clock);
  EXPECT_EQ(model.Ask(Question("hello")).text, "fine");
  core::SetLogSink({});
  core::SetLogLevel(core::LogLevel::kOff);
  ExpectHas(log, "(test question): asking tiny\n");
  ExpectHas(log, "status 503: busy with [redacted]; the next request follows in ");
  ExpectHas(log, "answered after 2 requests, 7 tokens\n");
  EXPECT_EQ(log.find("sk-test"), std::string::npos) << log;
}

TEST(KeySafety, RedirectsStayWithTheServerTheKeyIsFor) {
  ChatServer elsewhere(Always(200, GoodBody("stolen")));
  ChatServer away([&](int, const Request&, Response& response) {
    response.set_redirect(elsewhere.url() + "/chat/completions?key=hidden", 307);
  });
  OpenAiChatModel model(OptionsFor(away.url()));
  const std::string error = ErrorOf(&model);
  ExpectHas(error, "redirects to http://127.0.0.1:" + std::to_string(elsewhere.port()));
  EXPECT_EQ(error.find("hidden"), std::string::npos);
  EXPECT_TRUE(elsewhere.bodies().empty());

  ChatServer within([](int, const Request& request, Response& response) {
    if (request.path == "/v1/chat/completions") return response.set_redirect("/new/place", 308);
    response.set_content(GoodBody("fine"), "application/json");
  });
  OpenAiChatModel moved(OptionsFor(within.url()));
  EXPECT_EQ(moved.Ask(Question("hello")).attempts, 2);
  EXPECT_EQ(moved.Ask(Question("hello")).attempts, 1);  // it remembers
  EXPECT_EQ(within.authorizations()[1], std::string("Bearer ") + kKey);

  ChatServer circle([](int, const Request& request, Response& response) {
    response.set_redirect(request.path + "x", 307);
  });
  OpenAiChatModel lost(OptionsFor(circle.url()));
  ExpectHas(ErrorOf(&lost), "more than 3 times");
  EXPECT_EQ(circle.bodies().size(), 4u);

  ChatServer local([](int, const Request&, Response& response) {
    response.set_redirect("file:///etc/passwd", 307);
  });
  OpenAiChatModel curious(OptionsFor(local.url()));
  ExpectHas(ErrorOf(&curious), "not the server that the key is for");
}

}  // namespace
}  // namespace simwright::llm
