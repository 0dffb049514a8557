#pragma once

#include <atomic>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>

namespace simwright::core {

// The importance of a log line. As a bound, kOff logs nothing.
enum class LogLevel { kTrace, kDebug, kInfo, kWarn, kError, kOff };

// Returns "trace", "debug", "info", "warn", "error" or "off", and the inverse, which throws
// core::Error, listing them, for another name.
const char* NameOf(LogLevel level);
LogLevel LogLevelNamed(const std::string& name);

// One line of the log.
struct LogLine {
  LogLevel level = LogLevel::kInfo;
  std::string_view module;  // the module that wrote it, such as "assets"
  std::string_view text;    // without line breaks
};
using LogSink = std::function<void(const LogLine&)>;

// Sets the lowest level that is logged. At the start it is that of the environment variable
// SIMWRIGHT_LOG, or kOff. Thread-safe.
void SetLogLevel(LogLevel level);
LogLevel CurrentLogLevel();

// Passes all lines to `sink`; an empty function restores the default, which writes them to stderr.
// One thread at a time calls the sink; it must not log. An exception of the sink does not reach the
// code that logs. Thread-safe.
void SetLogSink(LogSink sink);

// The lowest level that is logged; private to this file.
extern std::atomic<LogLevel> lowest_log_level;

// Returns true if lines of `level` are logged.
inline bool IsLogged(LogLevel level) {
  return level >= lowest_log_level.load(std::memory_order_relaxed) && level != LogLevel::kOff;
}

// Writes a line whether or not its level is logged. Control characters become blanks.
void WriteLog(LogLevel level, std::string_view module, std::string_view text);

// Writes the pieces, joined as a stream prints them, as one line if `level` is logged:
//   Log(LogLevel::kInfo, "assets", "read ", folder, ": ", count, " parts");
// If it is not, this costs one comparison. Thread-safe.
template <typename... Pieces>
void Log(LogLevel level, std::string_view module, const Pieces&... pieces) {
  if (!IsLogged(level)) return;
  std::ostringstream text;
  (text << ... << pieces);
  WriteLog(level, module, text.str());
}

}  // namespace simwright::core
