#include "core/json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"

namespace simwright::core {
namespace {

// Returns the message of the core::Error that `read` throws; empty if it throws none.
template <typename Read>
std::string MessageOf(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string ParseMessage(const std::string& text) {
  return MessageOf([&] { ParseJson(text, "f.json"); });
}

// Returns the message of reading the member "a" of `text`.
template <typename Read>
std::string FieldMessage(const std::string& text, const Read& read) {
  return MessageOf([&] {
    const JsonDocument document(text, "f.json");
    read(document.root()["a"]);
  });
}

std::string Brackets(std::size_t levels) {
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST(ParseJson, NamesLineAndColumnOfAFault) {
  EXPECT_EQ(ParseMessage("{\n  \"a\": 1,\n  \"b\": x\n}"),
            "f.json: the JSON is invalid at line 3, column 8 (correct it there)");
  EXPECT_EQ(ParseMessage("[1,]"),
            "f.json: the JSON is invalid at line 1, column 4 (correct it there)");
  EXPECT_EQ(ParseMessage("[1]\n\n]"),
            "f.json: the JSON is invalid at line 3, column 1 (correct it there)");
  EXPECT_EQ(ParseMessage("[1,\n 2"),
            "f.json: the JSON ends too early, at line 2, column 3 (the file is truncated, write it "
            "again)");
  EXPECT_EQ(ParseMessage(" \n"), "f.json: is empty, where JSON was expected");
  EXPECT_EQ(ParseMessage("[\"a\xff\"]").rfind("f.json: the JSON is invalid at line 1", 0), 0u);
}

TEST(ParseJson, EveryPrefixOfADocumentEndsTooEarly) {
  const std::string whole = R"({"a": [1.5, true, null], "b": {"c": "d\"e"}})";
  EXPECT_EQ(ParseMessage(whole), "");
  for (std::size_t length = 1; length < whole.size(); ++length) {
    EXPECT_NE(ParseMessage(whole.substr(0, length)).find("ends too early"), std::string::npos)
        << whole.substr(0, length);
  }
}

TEST(ParseJson, RefusesWhatIsNoFiniteNumber) {
  for (const char* number : {"NaN", "nan", "Infinity", "-Infinity", "inf", "0x10", ".5", "+1"}) {
    EXPECT_NE(ParseMessage("[" + std::string(number) + "]").find("is invalid at line 1, column"),
              std::string::npos)
        << number;
  }
  EXPECT_EQ(
      ParseMessage("[1,\n   1e999]"),
      "f.json: the JSON has a number that is too large at line 2, column 4 (correct it there)");
  EXPECT_EQ(ParseMessage("[-1e999]").find("f.json: the JSON has a number that is too large"), 0u);
  const Json extremes = ParseJson("[1.7976931348623157e308, 5e-324, 18446744073709551615]", "f");
  EXPECT_EQ(extremes[0].get<double>(), std::numeric_limits<double>::max());
  EXPECT_EQ(extremes[1].get<double>(), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(extremes[2].get<std::uint64_t>(), std::numeric_limits<std::uint64_t>::max());
}

TEST(ParseJson, BoundsTheNesting) {
  EXPECT_EQ(ParseMessage(Brackets(64)), "");
  EXPECT_EQ(ParseMessage(Brackets(65)),
            "f.json: the JSON is nested deeper than 64 levels at line 1, column 65");
  EXPECT_NE(ParseMessage(std::string(1 << 20, '[')).find("nested deeper"), std::string::npos);
  EXPECT_NE(ParseMessage(std::string(64, '[') + "}" + std::string(64, '[')).find("is invalid"),
            std::string::npos);
  // Brackets in strings do not nest.
  EXPECT_EQ(ParseMessage("[\"\\\"" + std::string(100, '[') + "\"]"), "");
  std::string objects;
  for (int i = 0; i < 65; ++i) objects += "{\"a\":";
  EXPECT_NE(ParseMessage(objects + "1" + std::string(65, '}')).find("nested deeper"),
            std::string::npos);
}

TEST(ParseJson, TheRemedyOfTheCallerReplacesTheUsualOne) {
  EXPECT_EQ(MessageOf([] { ParseJson("[", "f.json", "train again"); }),
            "f.json: the JSON ends too early, at line 1, column 2 (train again)");
}

TEST(ParseJson, OrderedJsonKeepsTheOrderOfMembers) {
  EXPECT_EQ(JsonLine(ParseOrderedJson(R"({"b": 1, "a": 2})", "f")), R"({"b":1,"a":2})");
  EXPECT_EQ(JsonLine(ParseJson(R"({"b": 1, "a": 2})", "f")), R"({"a":2,"b":1})");
}

TEST(TryParseJson, DistinguishesDepthFromOtherFaults) {
  const auto is_too_deep = [](const std::string& text) {
    bool too_deep = false;
    EXPECT_FALSE(TryParseJson(text, false, &too_deep)) << text.substr(0, 80);
    return too_deep;
  };
  EXPECT_TRUE(is_too_deep(Brackets(65)));
  EXPECT_FALSE(is_too_deep(std::string(1000, '{')));  // the second bracket is no key
  EXPECT_FALSE(is_too_deep("<" + Brackets(65)));
  EXPECT_FALSE(is_too_deep("[1"));
  EXPECT_TRUE(TryParseJson("[1]"));
}

TEST(TryParseJson, AcceptsCommentsOnRequest) {
  const std::string text = "[1, // \" [\n 2 /* ] \" */]";
  EXPECT_FALSE(TryParseJson(text));
  ASSERT_TRUE(TryParseJson(text, true));
  EXPECT_EQ(*TryParseJson(text, true), Json::array({1, 2}));
  // A quote in a comment hides no nesting.
  EXPECT_FALSE(TryParseJson("/* \" */" + Brackets(65), true));
  EXPECT_TRUE(TryParseJson("/* \" */" + Brackets(64), true));
}

TEST(JsonText, WritesTheFewestDigitsThatReadBack) {
  EXPECT_EQ(JsonLine(Json::array({0.1, 1.0, 1e-7, 1e300, -0.0, 3})),
            "[0.1,1.0,1e-07,1e+300,-0.0,3]");
  EXPECT_EQ(JsonText(OrderedJson{{"b", 1.5}, {"a", {1, 2}}}),
            "{\n  \"b\": 1.5,\n  \"a\": [\n    1,\n    2\n  ]\n}\n");
  EXPECT_EQ(JsonText(Json{{"a", 1}}, InvalidUtf8::kReplace, 1), "{\n \"a\": 1\n}\n");
  EXPECT_EQ(JsonLine(Json::array({std::nan("")})), "[null]");
}

TEST(JsonText, RefusesOrReplacesWhatIsNoUtf8) {
  EXPECT_THROW(JsonText(Json{{"a", "\xff"}}), Error);
  EXPECT_EQ(JsonLine(Json{{"a", "\xff"}}, InvalidUtf8::kReplace), "{\"a\":\"\ufffd\"}");
}

TEST(JsonMembers, OfForeignJsonMayBeMissing) {
  const Json json = ParseJson(R"({"text": "x", "number": 2, "huge": 1e308})", "f");
  EXPECT_EQ(TextMember(json, "text"), "x");
  EXPECT_EQ(TextMember(json, "number"), "");
  EXPECT_EQ(TextMember(json, "none"), "");
  EXPECT_EQ(NumberMember(json, "number", -1.0), 2.0);
  EXPECT_EQ(NumberMember(json, "text", -1.0), -1.0);
  EXPECT_EQ(FindMember(json, "none"), nullptr);
  EXPECT_EQ(FindMember(Json::array({1, 2}), "none"), nullptr);
  EXPECT_EQ(FindMember(json, "number"), &json["number"]);
}

TEST(JsonField, ReadsEachType) {
  const JsonDocument document(
      R"({"flag": true, "text": "t", "number": 2, "half": 0.5, "list": [1, 2.5], "names": ["a"],
          "big": 18446744073709551615, "null": null})",
      "f.json");
  const JsonField root = document.root();
  EXPECT_TRUE(root["flag"].Flag());
  EXPECT_EQ(root["text"].Text(), "t");
  EXPECT_EQ(root["number"].Number(), 2.0);
  EXPECT_EQ(root["number"].Int(), 2);
  EXPECT_EQ(root["number"].Integer(), 2);
  EXPECT_EQ(root["half"].PositiveNumber(), 0.5);
  EXPECT_EQ(root["half"].NumberWithin(0.0, 1.0), 0.5);
  EXPECT_EQ(root["big"].Unsigned(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(root["list"].Numbers(), (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(root["list"].Vector<2>(), Eigen::Vector2d(1.0, 2.5));
  EXPECT_EQ(root["names"].Texts(), std::vector<std::string>{"a"});
  EXPECT_TRUE(root["null"].IsNull());
  EXPECT_TRUE(root.Has("null"));
  EXPECT_FALSE(root.Has("none"));
  EXPECT_EQ(root.NumberOr("half", 9.0), 0.5);
  EXPECT_EQ(root.NumberOr("none", 9.0), 9.0);
  EXPECT_EQ(root.IntOr("none", 9), 9);
  EXPECT_EQ(root.TextOr("none", "n"), "n");
  EXPECT_TRUE(root.FlagOr("none", true));
  EXPECT_EQ(root.Members().size(), 8u);
}

TEST(JsonField, NamesThePathTheTypeAndTheValue) {
  const JsonDocument document(R"({"objects": [{"mass": 1}, {"mass": "x"}]})", "scene.json");
  const std::vector<JsonField> objects = document.root()["objects"].Elements();
  EXPECT_EQ(objects[0]["mass"].PositiveNumber(), 1.0);
  EXPECT_EQ(MessageOf([&] { objects[1]["mass"].PositiveNumber(); }),
            "scene.json: objects[1].mass: must be a number above 0, is \"x\"");
  EXPECT_EQ(MessageOf([&] { objects[1]["size"].Number(); }),
            "scene.json: objects[1]: 'size' is missing (add it)");
  EXPECT_EQ(MessageOf([&] { objects[0].RequireMembers({"size"}, {"mass"}); }),
            "scene.json: objects[0]: 'size' is missing (add it)");
  EXPECT_EQ(MessageOf([&] { objects[0].RequireMembers({}, {"size"}); }),
            "scene.json: objects[0]: 'mass' is not a known member (remove it)");
}

TEST(JsonField, RefusesWrongTypes) {
  const auto number = [](const JsonField& field) { field.Number(); };
  const auto integer = [](const JsonField& field) { field.Integer(); };
  const auto small = [](const JsonField& field) { field.Int(0, 10); };
  const auto within = [](const JsonField& field) { field.NumberWithin(0.0, 1.0); };
  const auto numbers = [](const JsonField& field) { field.Numbers(); };
  const auto pair = [](const JsonField& field) { field.Vector<2>(); };
  EXPECT_EQ(FieldMessage(R"({"a": null})", number), "f.json: a: must be a number, is null");
  EXPECT_EQ(FieldMessage(R"({"a": [1]})", number), "f.json: a: must be a number, is [1]");
  EXPECT_EQ(FieldMessage(R"({"a": {"b": 1}})", number),
            "f.json: a: must be a number, is an object");
  EXPECT_EQ(FieldMessage(R"({"a": 1.5})", integer), "f.json: a: must be an integer, is 1.5");
  EXPECT_EQ(FieldMessage(R"({"a": 18446744073709551615})", integer),
            "f.json: a: must be an integer, is 18446744073709551615");
  for (const char* wrong : {"-1", "11", "18446744073709551615", "-9223372036854775808"}) {
    EXPECT_EQ(FieldMessage("{\"a\": " + std::string(wrong) + "}", small),
              "f.json: a: must be an integer from 0 to 10, is " + std::string(wrong));
  }
  EXPECT_EQ(FieldMessage(R"({"a": 1.25})", within),
            "f.json: a: must be a number from 0.0 to 1.0, is 1.25");
  EXPECT_EQ(FieldMessage(R"({"a": -1})", [](const JsonField& field) { field.Unsigned(); }),
            "f.json: a: must be an integer of at least 0, is -1");
  EXPECT_EQ(FieldMessage(R"({"a": 0})", [](const JsonField& field) { field.NumberWithin(2.0); }),
            "f.json: a: must be a number of at least 2.0, is 0");
  EXPECT_EQ(FieldMessage(R"({"a": [1, "b"]})", numbers),
            "f.json: a[1]: must be a number, is \"b\"");
  EXPECT_EQ(FieldMessage(R"({"a": [1, 2, 3]})", pair),
            "f.json: a: must be an array of 2 numbers, is [1,2,3]");
  EXPECT_EQ(FieldMessage(R"({"a": 1})", [](const JsonField& field) { field.Flag(); }),
            "f.json: a: must be true or false, is 1");
  EXPECT_EQ(FieldMessage(R"({"a": 1})", [](const JsonField& field) { field.Text(); }),
            "f.json: a: must be a string, is 1");
  EXPECT_EQ(FieldMessage(R"({"a": 1})", [](const JsonField& field) { field.Elements(); }),
            "f.json: a: must be an array, is 1");
  EXPECT_EQ(FieldMessage(R"({"a": 1})", [](const JsonField& field) { field.Members(); }),
            "f.json: a: must be an object, is 1");
  EXPECT_EQ(FieldMessage(R"({"a": 1})", [](const JsonField& field) { field["b"]; }),
            "f.json: a: must be an object, is 1");
}

TEST(JsonField, ShortensWhatItShows) {
  const std::string text = "{\"a\": \"" + std::string(1000, 'x') + "\"}";
  const std::string message = FieldMessage(text, [](const JsonField& field) { field.Number(); });
  EXPECT_LT(message.size(), 120u);
  EXPECT_NE(message.find("xxx...\""), std::string::npos) << message;
  EXPECT_NE(FieldMessage(text, [](const JsonField& field) { field.Name(); }).find("200 bytes"),
            std::string::npos);
  const std::string key = "{\"a\": {\"" + std::string(1000, 'k') + "\": 1}}";
  EXPECT_LT(FieldMessage(key, [](const JsonField& field) { field.RequireMembers({}); }).size(),
            120u);
}

TEST(JsonDocument, EndsEveryMessageWithItsRemedy) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "run.json";
  WriteFile(file, R"({"format": 1, "more": 2})");
  const JsonDocument document = JsonDocument::Read(file, 1 << 10, "train again");
  EXPECT_EQ(MessageOf([&] { document.root()["seed"].Unsigned(); }),
            file.string() + ": 'seed' is missing (train again)");
  EXPECT_EQ(MessageOf([&] { document.root().RequireMembers({"format"}); }),
            file.string() + ": 'more' is not a known member (train again)");
  EXPECT_THROW(JsonDocument::Read(file, 4), Error);
  EXPECT_THROW(JsonDocument::Read(folder.path() / "none.json", 1 << 10), Error);
}

TEST(FindingJson, BothArraysAreReadBack) {
  const Findings findings = {{"code", Severity::kInfo, "place", "sentence", 1.5, "remedy"},
                             {"other", Severity::kError, "", "again", -2.0}};
  for (const OrderedJson& list : {StoredFindingsJson(findings), FindingsJson(findings)}) {
    const JsonDocument document(JsonLine(list), "f.json");
    const Findings read = FindingsFrom(document.root());
    ASSERT_EQ(read.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(read[i].code, findings[i].code);
      EXPECT_EQ(read[i].severity, findings[i].severity);
      EXPECT_EQ(read[i].place, findings[i].place);
      EXPECT_EQ(read[i].sentence, findings[i].sentence);
      EXPECT_EQ(read[i].figure, findings[i].figure);
      EXPECT_EQ(read[i].remedy, findings[i].remedy);
    }
  }
  EXPECT_EQ(JsonLine(StoredFindingsJson({findings[1]})),
            R"([{"code":"other","severity":"error","place":"","sentence":"again","figure":-2.0}])");
}

}  // namespace
}  // namespace simwright::core
