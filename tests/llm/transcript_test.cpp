// Record, replay and the cache: the same answers again, without a server.
#include "llm/transcript.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "llm/answer_cache.h"
#include "llm/make_chat_model.h"
#include "llm/request_key.h"

#include "chat_server.h"  // last: see there

namespace simwright::llm {
namespace {
namespace fs = std::filesystem;

// Numbers its answers, and includes the key in each like a server that echoes it.
ChatServer::Handler Counting() {
  return [](int number, const httplib::Request&, httplib::Response& response) {
    response.set_content(GoodBody("answer " + std::to_string(number) + " for " + kKey),
                         "application/json");
  };
}

class Transcript : public ::testing::Test {
 protected:
  std::string Read(const std::string& name) const { return core::ReadFile(folder_.path() / name); }
  fs::path Write(const std::string& name, const std::string& text) const {
    core::WriteFile(folder_.path() / name, text);
    return folder_.path() / name;
  }
  std::string ErrorOf(const std::function<void()>& act) const {
    try {
      act();
    } catch (const core::Error& error) {
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return "";
  }
  static void ExpectHas(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
  }
  static std::string Line(const std::string& task, const ChatRequest& request,
                          const std::string& text) {
    TranscriptEntry entry{0, task, "tiny", CanonicalRequest(request), {}};
    entry.answer.text = text;
    return TranscriptLine(entry);
  }

  core::TemporaryFolder folder_;
};

TEST_F(Transcript, WhatIsRecordedIsReplayedInOrder) {
  ChatModelOptions options;
  std::vector<std::string> said;
  {
    ChatServer server(Counting());
    options = OptionsFor(server.url());
    options.record = folder_.path() / "t.jsonl";
    const std::unique_ptr<ChatModel> model = MakeChatModel(options);
    EXPECT_FALSE(fs::exists(options.record));  // nothing answered, nothing written
    ChatRequest pictured = Question("one");
    pictured.messages[0].images.push_back({"image/png", "bytes"});
    for (const ChatRequest& request :
         {Question("one"), Question("two"), Question("one"), pictured}) {
      said.push_back(model->Ask(request).text);
    }
    EXPECT_THROW(MakeChatModel(options), core::Error);  // it would be lost
    options.replace_record = true;
    EXPECT_NO_THROW(MakeChatModel(options));
  }
  EXPECT_EQ(Read("t.jsonl").find("0123456789ab"), std::string::npos);

  ChatModelOptions replay;
  replay.replay = options.record;
  const std::unique_ptr<ChatModel> model = MakeChatModel(replay);
  EXPECT_EQ(model->name(), "tiny");
  ChatRequest other_task = Question("one");
  other_task.task = "another label";  // no part of the request
  EXPECT_EQ(model->Ask(Question("two")).text, said[1]);
  EXPECT_EQ(model->Ask(other_task).text, said[0]);
  const ChatAnswer second = model->Ask(Question("one"));
  EXPECT_EQ(second.text, said[2]);
  EXPECT_TRUE(second.from_cache);
  EXPECT_EQ(second.attempts, 0);
  EXPECT_EQ(second.finish_reason, "stop");
  EXPECT_EQ(second.tokens.input, 11);
  EXPECT_EQ(model->usage().answers, 3);
  EXPECT_EQ(model->usage().from_cache, 3);
  EXPECT_EQ(model->usage().tokens.input, 0);
  const std::string error = ErrorOf([&] { model->Ask(Question("one")); });
  ExpectHas(error, "holds 2 answers");
  ExpectHas(error, "'one'");
}

TEST_F(Transcript, AMissingRequestIsNamedWithTheNearest) {
  const ChatRequest mug = Question("How heavy is a red mug in grams?");
  const fs::path file = Write("t.jsonl", TranscriptHead() + Line("a", Question("Hello"), "x") +
                                             Line("physics of mug", mug, "y"));
  ReplayChatModel model(file);
  ChatRequest asked = Question("How heavy is a red cup in grams?");
  asked.task = "physics of cup";
  const std::string error = ErrorOf([&] { model.Ask(asked); });
  ExpectHas(error, "physics of cup, 'How heavy is a red cup in grams?'");
  ExpectHas(error, core::ContentHash(CanonicalRequest(asked)).substr(0, 8));
  ExpectHas(error, "line 3 (physics of mug");
  ExpectHas(error, "'mug in grams?");
  asked = mug;
  asked.seed = 5;
  ExpectHas(ErrorOf([&] { model.Ask(asked); }), "its settings or images differ");
}

TEST_F(Transcript, DamagedLinesAreNamed) {
  const std::string good = TranscriptHead() + Line("a", Question("Hello"), "x");
  const std::string line = Line("b", Question("Hi"), "y");
  const auto error_of = [&](const std::string& text) {
    return ErrorOf([&] { ReadTranscript(text, "t.jsonl"); });
  };
  EXPECT_EQ(ReadTranscript(good + "\n\r\n" + line, "t").size(), 2u);
  EXPECT_EQ(ReadTranscript(good + "\n\r\n" + line, "t")[1].line, 5);
  for (std::size_t length = 1; length + 1 < line.size(); length += 7) {
    ExpectHas(error_of(good + line.substr(0, length)), "t.jsonl line 3");
  }
  ExpectHas(error_of(""), "empty");
  ExpectHas(error_of(line), "t.jsonl line 1: is not a transcript");
  ExpectHas(error_of("{\"transcript\":\"simwright-llm\",\"version\":99}\n"), "version");
  ExpectHas(error_of(good + "{\"request\":{}}\n"), "line 3: the line has no answer");
  ExpectHas(error_of(good + "{\"answer\":{\"text\":\"x\"}}\n"), "line 3: the line has no request");
  std::string changed = line;
  changed.replace(changed.find("Hi"), 2, "Ho");
  ExpectHas(error_of(good + changed), "line 3: the request was changed");
  ExpectHas(ErrorOf([&] { ReplayChatModel model(folder_.path() / "none"); }), "no such file");
}

TEST_F(Transcript, AFolderMustBeThere) {
  ChatModelOptions options = OptionsFor("http://localhost:1");
  options.record = folder_.path() / "none" / "t.jsonl";
  EXPECT_THROW(MakeChatModel(options), core::Error);
  options.record = folder_.path();
  options.replace_record = true;
  EXPECT_THROW(MakeChatModel(options), core::Error);
}

TEST(RequestKey, EverythingThatChangesTheAnswerIsInTheKey) {
  const ChatRequest base = Question("Hello");
  std::vector<ChatRequest> others(7, base);
  others[0].messages[0].text += " ";
  others[1].messages[0].role = Role::kSystem;
  others[2].messages[0].images.push_back({"image/png", "a"});
  others[3].temperature = 0.0;
  others[4].max_tokens = 10;
  others[5].seed = 0;
  others[6].json = true;
  for (const ChatRequest& other : others) {
    EXPECT_NE(CanonicalRequest(other), CanonicalRequest(base));
  }
  ChatRequest other_image = others[2];
  other_image.messages[0].images[0].bytes = "b";
  EXPECT_NE(CanonicalRequest(other_image), CanonicalRequest(others[2]));
  ChatRequest other_task = base;
  other_task.task = "x";
  EXPECT_EQ(CanonicalRequest(other_task), CanonicalRequest(base));
}

using Cache = Transcript;

TEST_F(Cache, AnEqualRequestIsSentOnce) {
  ChatServer server(Counting());
  ChatModelOptions options = OptionsFor(server.url());
  options.cache = folder_.path() / "deep" / "cache";
  const std::unique_ptr<ChatModel> model = MakeChatModel(options);
  const ChatAnswer first = model->Ask(Question("one"));
  const ChatAnswer again = model->Ask(Question("one"));
  EXPECT_FALSE(first.from_cache);
  EXPECT_TRUE(again.from_cache);
  EXPECT_EQ(again.attempts, 0);
  EXPECT_EQ(again.text, first.text);
  EXPECT_EQ(model->usage().answers, 2);
  EXPECT_EQ(model->usage().from_cache, 1);
  EXPECT_EQ(model->usage().tokens.input, 11);
  // Another key or address gives the same question; another model or seed does not.
  options.key = "another-key";
  EXPECT_TRUE(MakeChatModel(options)->Ask(Question("one")).from_cache);
  options.key = kKey;
  ChatRequest seeded = Question("one");
  seeded.seed = 2;
  EXPECT_FALSE(MakeChatModel(options)->Ask(seeded).from_cache);
  options.model = "large";
  EXPECT_FALSE(MakeChatModel(options)->Ask(Question("one")).from_cache);
  for (const auto& entry : fs::directory_iterator(options.cache)) {
    const std::string text = core::ReadFile(entry.path());
    EXPECT_EQ(text.find("0123456789ab"), std::string::npos) << text;
    EXPECT_EQ(text.find("127.0.0.1"), std::string::npos) << text;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(options.cache), {}), 3);
}

TEST_F(Cache, DamagedEntriesAreAskedAnew) {
  ChatServer server(Counting());
  ChatModelOptions options = OptionsFor(server.url());
  options.cache = folder_.path() / "cache";
  MakeChatModel(options)->Ask(Question("one"));
  const fs::path file = fs::directory_iterator(options.cache)->path();
  const std::string whole = core::ReadFile(file);
  for (const std::string& damaged :
       {std::string(), whole.substr(0, whole.size() / 2), std::string("[]"),
        std::string("{\"content\":1,\"answer\":2}")}) {
    core::WriteFile(file, damaged);
    const std::unique_ptr<ChatModel> model = MakeChatModel(options);
    EXPECT_FALSE(model->Ask(Question("one")).from_cache) << damaged;
    const core::Findings findings = model->TakeFindings();
    // An entry of another request is not damage.
    EXPECT_EQ(findings.size(), damaged.rfind("{\"content\":1", 0) == 0 ? 0u : 1u) << damaged;
    for (const core::Finding& finding : findings) EXPECT_EQ(finding.code, "llm-cache-damaged");
    EXPECT_TRUE(model->Ask(Question("one")).from_cache);
  }
}

TEST_F(Cache, CutOffAnswersAreNotKept) {
  ChatServer server([](int, const httplib::Request&, httplib::Response& response) {
    nlohmann::json body = nlohmann::json::parse(GoodBody("half an ans"));
    body["choices"][0]["finish_reason"] = "length";
    response.set_content(body.dump(), "application/json");
  });
  ChatModelOptions options = OptionsFor(server.url());
  options.cache = folder_.path() / "cache";
  const std::unique_ptr<ChatModel> model = MakeChatModel(options);
  model->Ask(Question("one"));
  EXPECT_FALSE(model->Ask(Question("one")).from_cache);
  EXPECT_EQ(server.bodies().size(), 2u);
}

TEST_F(Cache, AFolderThatCannotBeMadeIsRefused) {
  ChatModelOptions options = OptionsFor("http://localhost:1");
  options.cache = Write("file", "") / "cache";
  EXPECT_THROW(MakeChatModel(options), core::Error);
}

}  // namespace
}  // namespace simwright::llm
