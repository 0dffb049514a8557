#include "llm/response_reader.h"

#include <gtest/gtest.h>

#include "llm/json_text.h"
#include "llm/request_body.h"

#include "chat_server.h"  // last: see there

namespace simwright::llm {
namespace {

using Kind = ReadResponse::Kind;

TEST(ResponseReader, ReadsWhatServersSend) {
  EXPECT_EQ(ReadChatResponse(GoodBody("a")).answer.text, "a");
  // Content in parts; an old completion's text; a null content (a tool was called).
  const auto text = [](const std::string& choice) {
    const ReadResponse read = ReadChatResponse(R"({"choices":[)" + choice + "]}");
    EXPECT_EQ(read.kind, Kind::kAnswer) << choice;
    return read.answer.text;
  };
  EXPECT_EQ(text(R"({"message":{"content":[{"type":"text","text":"a"},{"text":"b"}]}})"), "ab");
  EXPECT_EQ(text(R"({"text":"old"})"), "old");
  EXPECT_EQ(text(R"({"message":{"content":null}})"), "");
  const ReadResponse refusal =
      ReadChatResponse(R"({"choices":[{"message":{"content":null,"refusal":"no"}}]})");
  EXPECT_EQ(refusal.kind, Kind::kError);
  EXPECT_EQ(refusal.message, "the model refuses: no");
  EXPECT_EQ(ReadChatResponse(R"({"choices":[{"message":{}}]})").kind, Kind::kNoResponse);
  EXPECT_EQ(ReadChatResponse(R"({"choices":[]})").kind, Kind::kNoResponse);
  EXPECT_EQ(ReadChatResponse(R"({"choices":[7]})").kind, Kind::kNoResponse);
}

TEST(ResponseReader, EveryPrefixOfAnAnswerIsTruncated) {
  const std::string body = GoodBody("some text \"quoted\" \u00fc");
  for (std::size_t length = 0; length < body.size(); ++length) {
    EXPECT_EQ(ReadChatResponse(body.substr(0, length)).kind, Kind::kTruncated) << length;
  }
}

TEST(ResponseReader, TokenCountsAreBelievedWithinReason) {
  const auto tokens = [](const std::string& count) {
    return ReadChatResponse(R"({"choices":[{"text":"a"}],"usage":{"prompt_tokens":)" + count + "}}")
        .answer.tokens.input;
  };
  EXPECT_EQ(tokens("12"), 12);
  EXPECT_EQ(tokens("12.0"), 12);
  EXPECT_EQ(tokens("-3"), 0);
  EXPECT_EQ(tokens("1e300"), 0);
  EXPECT_EQ(tokens("\"12\""), 0);
  EXPECT_EQ(tokens("null"), 0);
}

TEST(ResponseReader, ReasoningIsNoPartOfTheAnswer) {
  EXPECT_EQ(WithoutReasoning("\n<think>\nhm\n</think>\n\n300 g"), "300 g");
  EXPECT_EQ(WithoutReasoning("300 g <think>"), "300 g <think>");
  EXPECT_EQ(WithoutReasoning("<think> cut off"), "");
  EXPECT_EQ(WithoutReasoning("<think></think>"), "");
}

TEST(RequestBody, TextThatIsNoUtf8IsSentAsReplacements) {
  const nlohmann::json json = nlohmann::json::parse(RequestBody(Question("a\xff"
                                                                         "b"),
                                                                "", {}));
  EXPECT_EQ(json["messages"][0]["content"],
            "a\ufffd"
            "b");
}

TEST(JsonText, IsFoundInProse) {
  const auto found = [](const std::string& text) {
    std::string all;
    for (const nlohmann::json& json : JsonInText(text)) all += json.dump() + ";";
    return all;
  };
  EXPECT_EQ(found("Sure!\n```json\n{\"a\": [1, 2,], // one\n \"b\": \"x,}\",}\n```\nDone."),
            R"({"a":[1,2],"b":"x,}"};)");
  EXPECT_EQ(found(R"({"a":1} and [2] and {"b":"}\\"})"), R"({"a":1};[2];{"b":"}\\"};)");
  EXPECT_EQ(found("a {b} [c] {\"d\":1}"), R"({"d":1};)");
  EXPECT_EQ(found("a { {\"d\":1}"), R"({"d":1};)");
  EXPECT_EQ(found("none 1 \"x\""), "");
  EXPECT_EQ(found(std::string(1 << 20, '{')), "");
  EXPECT_EQ(found(std::string(100, '[') + std::string(100, ']')).size(), 2u * 64 + 1);
}

}  // namespace
}  // namespace simwright::llm
