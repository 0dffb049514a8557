#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "core/error.h"

#include "chat_server.h"  // last: see there

namespace simwright::llm {

inline ChatServer::Handler Always(int status, const std::string& body,
                                  const std::string& type = "application/json") {
  return [=](int, const httplib::Request&, httplib::Response& response) {
    response.status = status;
    response.set_content(body, type);
  };
}

// Answers the first request with `first`, later ones with a good answer.
inline ChatServer::Handler Once(const std::function<void(httplib::Response&)>& first) {
  return [=](int number, const httplib::Request&, httplib::Response& response) {
    if (number == 0) {
      first(response);
    } else {
      response.set_content(GoodBody("fine"), "application/json");
    }
  };
}

// Returns the error of a question that must fail.
inline std::string ErrorOf(ChatModel* model, const ChatRequest& request = Question("hello")) {
  try {
    const ChatAnswer answer = model->Ask(request);
    ADD_FAILURE() << "answered: " << answer.text;
  } catch (const core::Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find("0123456789ab"), std::string::npos) << text;  // of the key
    EXPECT_LT(text.size(), 700u) << text;
    return text;
  }
  return "";
}

inline void ExpectHas(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
}

}  // namespace simwright::llm
