// `physics` with a language model: queried once, then replayed without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "core/files.h"
#include "program.h"
#include "tests/llm/chat_server.h"  // last: see there

namespace simwright {
namespace {
namespace fs = std::filesystem;

class PhysicsCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"SIMWRIGHT_LLM_URL", "SIMWRIGHT_LLM_MODEL", "OPENAI_API_KEY"}) {
      unsetenv(name);
    }
    setenv("SIMWRIGHT_LLM_KEY", llm::kKey, 1);
  }
  void TearDown() override { unsetenv("SIMWRIGHT_LLM_KEY"); }

  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  static std::unique_ptr<llm::ChatServer> ServerOf(const std::string& text) {
    return std::make_unique<llm::ChatServer>(
        [text](int, const httplib::Request&, httplib::Response& response) {
          response.set_content(llm::GoodBody(text), "application/json");
        });
  }
  static nlohmann::json JsonOf(const std::string& arguments) {
    const Outcome outcome = RunProgram(arguments + " --json");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return nlohmann::json::parse(outcome.text, nullptr, false);
  }
  // One line "error: ...", exit 1.
  static void ExpectRefused(const std::string& arguments, const std::string& word) {
    const Outcome outcome = RunProgram(arguments + " --quiet");
    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(word), std::string::npos) << outcome.text;
    EXPECT_EQ(outcome.text.find("0123456789ab"), std::string::npos) << outcome.text;
  }

  core::TemporaryFolder folder_;
};

constexpr const char* kMug =
    "object: mug\nmass in grams: 300-350\n"
    "length, width, height in centimeters: 11-12, 8-9, 9-10\nmaterial: porcelain";

TEST_F(PhysicsCommand, IsRecordedAndReplayed) {
  const std::string file = Path("mug.jsonl");
  std::unique_ptr<llm::ChatServer> server = ServerOf(kMug);
  const nlohmann::json asked = JsonOf("physics --category mug --llm " + server->url() +
                                      " --llm-model tiny --record " + file);
  EXPECT_EQ(server->bodies().size(), 1u);
  EXPECT_EQ(server->authorizations()[0], std::string("Bearer ") + llm::kKey);
  server.reset();
  EXPECT_DOUBLE_EQ(asked["mass_kg"]["min"].get<double>(), 0.300);
  EXPECT_DOUBLE_EQ(asked["mass_kg"]["max"].get<double>(), 0.350);
  EXPECT_DOUBLE_EQ(asked["height_m"]["min"].get<double>(), 0.09);
  EXPECT_NE(asked["sources"]["mass"].get<std::string>().find("narrowed by the language model tiny"),
            std::string::npos);
  EXPECT_EQ(core::ReadFile(file).find("0123456789ab"), std::string::npos);
  EXPECT_EQ(JsonOf("physics --category mug --replay " + file), asked);
  ExpectRefused("physics --category plate --replay " + file, "physics of plate");
  ExpectRefused("physics --category mug --llm http://localhost:1 --record " + file, "--force");
}

TEST_F(PhysicsCommand, AKindThatNobodyKnowsIsAskedFor) {
  std::unique_ptr<llm::ChatServer> server =
      ServerOf("Mass: 900-1200 g\nDimensions: 11-13 x 11-13 x 35-43 cm\nMaterial: glass");
  const nlohmann::json json =
      JsonOf("physics --category zorbelflux --llm " + server->url() + " --llm-cache " + Path("c"));
  EXPECT_EQ(json["category"], "zorbelflux");
  EXPECT_DOUBLE_EQ(json["mass_kg"]["max"].get<double>(), 1.2);
  EXPECT_EQ(json["material"], "glass");
  EXPECT_EQ(json["fill"], "hollow");
  // From the cache the second time.
  JsonOf("physics --category zorbelflux --llm " + server->url() + " --llm-cache " + Path("c"));
  EXPECT_EQ(server->bodies().size(), 1u);
  const Outcome outcome =
      RunProgram("physics --category zorbelflux --llm " + server->url() + " --llm-price 2 8");
  EXPECT_NE(outcome.text.find("1 requests"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("cost 7.8e-05"), std::string::npos) << outcome.text;
}

TEST_F(PhysicsCommand, WhatCannotBeUsedIsRefused) {
  std::unique_ptr<llm::ChatServer> heavy =
      ServerOf("mass: 40 kg\nlength, width, height: 8, 8, 10 cm");
  ExpectRefused("physics --category zorbelflux --llm " + heavy->url(), "kg/m3");
  std::unique_ptr<llm::ChatServer> silent = ServerOf("I would rather not say.");
  ExpectRefused("physics --category zorbelflux --llm " + silent->url(), "lacks");
  EXPECT_EQ(silent->bodies().size(), 2u);
  ExpectRefused("physics --category mug --llm env", "SIMWRIGHT_LLM_URL");
  ExpectRefused("physics --category mug --llm ftp://host", "http");
  ExpectRefused("physics --category mug --replay " + Path("none"), "no such file");
  ExpectRefused("physics --llm http://localhost:1", "nothing to look up");
  EXPECT_EQ(RunProgram("physics --category mug --llm x --replay y").code, 2);
  EXPECT_EQ(RunProgram("physics --category mug --record y").code, 2);
}

}  // namespace
}  // namespace simwright
