#include "llm/chat_model_options.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "core/error.h"
#include "llm/make_chat_model.h"
#include "llm/redaction.h"

#include "chat_server.h"  // last: see there

namespace simwright::llm {
namespace {

TEST(ChatModelOptions, DefaultsAreValidWithAServer) {
  std::string error;
  EXPECT_FALSE(ChatModelOptions().IsValid(&error));
  EXPECT_EQ(error, "no server is given");
  EXPECT_TRUE(OptionsFor("http://localhost:8080").IsValid(&error)) << error;
  EXPECT_TRUE(OptionsFor("http://localhost:8080").IsValid(nullptr));
  ChatModelOptions replay;
  replay.replay = "answers.jsonl";
  EXPECT_TRUE(replay.IsValid(&error)) << error;
}

TEST(ChatModelOptions, EveryBadValueIsRefusedWithoutTheKey) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(ChatModelOptions*)>> faults = {
      [](auto* o) { o->url = "localhost:8080"; },
      [](auto* o) { o->url = "ftp://host/v1"; },
      [](auto* o) { o->url = "file:///etc/passwd"; },
      [](auto* o) { o->url = "http://"; },
      [](auto* o) { o->url = std::string("http://user:") + kKey + "@"; },
      [](auto* o) { o->key = std::string(kKey) + "\r\nX-Other: 1"; },
      [](auto* o) { o->key = std::string(kKey) + " "; },
      [](auto* o) { o->model = "a\nb"; },
      [](auto* o) { o->connect_timeout = 0.0; },
      [=](auto* o) { o->total_timeout = nan; },
      [](auto* o) { o->stall_timeout = -1.0; },
      [](auto* o) { o->max_answer_bytes = 0; },
      [](auto* o) { o->max_attempts = 0; },
      [](auto* o) { o->max_redirects = -1; },
      [](auto* o) { o->longest_wait = 0.5 * o->first_wait; },
      [](auto* o) { o->longest_retry_after = -1.0; },
      [](auto* o) { o->input_price = 1.0; },
      [=](auto* o) { o->input_price = o->output_price = nan; },
      [](auto* o) { o->record = o->replay = "f"; },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    ChatModelOptions options = OptionsFor("http://localhost:8080");
    faults[i](&options);
    std::string error;
    EXPECT_FALSE(options.IsValid(&error)) << i;
    EXPECT_FALSE(error.empty()) << i;
    EXPECT_EQ(error.find("0123456789ab"), std::string::npos) << error;
    EXPECT_THROW(MakeChatModel(options), core::Error) << i;
  }
}

TEST(ChatModelOptions, AddressesAreUnderstood) {
  const auto address = [](const std::string& url) { return ResolveEndpoint(url).address; };
  EXPECT_EQ(address("http://localhost:8080"), "http://localhost:8080/v1/chat/completions");
  EXPECT_EQ(address("http://localhost:8080/"), "http://localhost:8080/v1/chat/completions");
  EXPECT_EQ(address("http://localhost:8080/v1/"), "http://localhost:8080/v1/chat/completions");
  EXPECT_EQ(address("https://h/api/v2"), "https://h/api/v2/chat/completions");
  EXPECT_EQ(address("https://h/x/chat/completions"), "https://h/x/chat/completions");
  EXPECT_EQ(address("https://h/a?api-version=3#top"), "https://h/a/chat/completions?api-version=3");
  const Endpoint endpoint = ResolveEndpoint("http://me:pass%21word@Example.org:81/v1?key=hidden");
  EXPECT_EQ(endpoint.shown, "http://example.org:81/v1/chat/completions");
  EXPECT_EQ(endpoint.password, "pass!word");
  EXPECT_EQ(endpoint.origin, "http://example.org:81");
  EXPECT_FALSE(endpoint.loopback);
  EXPECT_TRUE(ResolveEndpoint("http://127.0.0.1:1").loopback);
  EXPECT_TRUE(ResolveEndpoint("http://[::1]:1").loopback);
  EXPECT_TRUE(ResolveEndpoint("http://LOCALHOST").loopback);
}

TEST(ChatModelOptions, TheEnvironmentFillsWhatIsOpen) {
  std::map<std::string, std::string> variables = {{"SIMWRIGHT_LLM_URL", "http://localhost:1/v1"},
                                                  {"SIMWRIGHT_LLM_MODEL", "m"},
                                                  {"OPENAI_API_KEY", "openai"}};
  const auto variable = [&](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  };
  const ChatModelOptions local = WithEnvironment({}, variable);
  EXPECT_EQ(local.url, "http://localhost:1/v1");
  EXPECT_EQ(local.model, "m");
  EXPECT_EQ(local.key, "");  // OpenAI's key is for OpenAI
  const auto key_for = [&](const std::string& url, const std::string& key = "") {
    ChatModelOptions given;
    given.url = url;
    given.key = key;
    return WithEnvironment(given, variable).key;
  };
  EXPECT_EQ(key_for("https://api.openai.com/v1"), "openai");
  EXPECT_EQ(key_for("https://API.openai.com/v1"), "openai");
  EXPECT_EQ(key_for("http://api.openai.com/v1"), "");
  EXPECT_EQ(key_for("https://api.openai.com.evil.org/v1"), "");
  EXPECT_EQ(key_for("https://api.openai.com@evil.org/v1"), "");
  variables["SIMWRIGHT_LLM_KEY"] = "own";
  EXPECT_EQ(key_for("https://api.openai.com/v1"), "own");
  EXPECT_EQ(key_for("http://localhost:1/v1"), "own");
  EXPECT_EQ(key_for("http://localhost:1/v1", "flag"), "flag");
}

TEST(Redaction, SecretsGoWholeAndInPart) {
  const std::vector<std::string> secrets = {kKey, "pass!word"};
  EXPECT_EQ(Redact("no secret", secrets), "no secret");
  EXPECT_EQ(Redact(std::string("a") + kKey + "b pass!word", secrets), "a[redacted]b [redacted]");
  EXPECT_EQ(Redact("sk-test-0123 sk-test-012", secrets), "[redacted] sk-test-012");
  EXPECT_EQ(Redact(std::string(kKey) + kKey, secrets), "[redacted]");
  ChatModelOptions placeholder = OptionsFor("http://localhost");
  placeholder.key = "EMPTY";
  EXPECT_TRUE(Secrets(placeholder).empty());
  EXPECT_EQ(Secrets(OptionsFor("http://me:pass%21word@h")), secrets);
}

TEST(Redaction, ShortenedKeepsWholeCharacters) {
  EXPECT_EQ(Shortened("short", 5), "short");
  EXPECT_EQ(Shortened("a\nb\tc", 9), "a b c");
  EXPECT_EQ(Shortened("abc\u00fcd", 4), "abc...");
  EXPECT_EQ(Shortened("abc\u00fcd", 5), "abc\u00fc...");
}

TEST(ChatModelOptions, AKeyInTheClearIsReported) {
  const auto findings = [](const std::string& url) {
    return MakeChatModel(OptionsFor(url))->TakeFindings();
  };
  EXPECT_TRUE(findings("http://localhost:8080").empty());
  EXPECT_TRUE(findings("https://example.org").empty());
  ASSERT_EQ(findings("http://example.org").size(), 1u);
  EXPECT_EQ(findings("http://example.org")[0].code, "llm-key-in-clear");
}

}  // namespace
}  // namespace simwright::llm
