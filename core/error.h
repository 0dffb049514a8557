#pragma once

#include <stdexcept>
#include <string>

namespace simwright::core {

// An error that a person can act on: what went wrong, where, and what to do about it. `what()` is
// one line, "WHERE: WHAT (REMEDY)", which may follow "error: ".
class Error : public std::runtime_error {
 public:
  // `what`   the fault, e.g. "the file is empty".
  // `where`  the file, element or value concerned; may be empty.
  // `remedy` what the reader can do; may be empty.
  // Line breaks in any of them are turned into spaces, so that the message stays one line.
  Error(const std::string& what, const std::string& where = "", const std::string& remedy = "");

  const std::string& where() const { return where_; }

 private:
  std::string where_;
};

// Thrown by `CheckCancelled` after Ctrl-C; it unwinds to the command line, which cleans up.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace simwright::core
