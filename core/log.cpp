#include "core/log.h"

#include <spdlog/logger.h>
#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/sinks/base_sink.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <utility>

#include "core/error.h"

namespace simwright::core {
namespace {

constexpr std::array<const char*, 6> kLogLevelNames = {"trace", "debug", "info",
                                                       "warn",  "error", "off"};

// The levels of spdlog are ours, except that it has one more below `off`.
static_assert(static_cast<int>(LogLevel::kTrace) == SPDLOG_LEVEL_TRACE);
static_assert(static_cast<int>(LogLevel::kError) == SPDLOG_LEVEL_ERROR);

// Passes lines to a function of the library's user.
class FunctionSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit FunctionSink(LogSink sink) : sink_(std::move(sink)) {}

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    sink_({static_cast<LogLevel>(message.level),
           {message.logger_name.data(), message.logger_name.size()},
           {message.payload.data(), message.payload.size()}});
  }
  void flush_() override {}

 private:
  LogSink sink_;
};

// Returns the sink that writes "[12:34:56.789] [info] [assets] TEXT" to stderr, in colour on a
// terminal, where it first clears the progress line.
spdlog::sink_ptr StderrSink() {
  auto sink = std::make_shared<spdlog::sinks::ansicolor_stderr_sink_mt>();
  const std::string clear = isatty(STDERR_FILENO) ? "\r\033[K" : "";
  sink->set_pattern(clear + "[%H:%M:%S.%e] [%^%l%$] [%n] %v");
  return sink;
}

// The current sink and its mutex.
struct SinkHolder {
  std::mutex mutex;
  spdlog::sink_ptr sink = StderrSink();
};

// Returns the holder, which is never destroyed: other static objects may log when the program ends.
SinkHolder& Holder() {
  static auto* const holder = new SinkHolder;
  return *holder;
}

std::string LevelNames() {
  std::string names = kLogLevelNames[0];
  for (std::size_t i = 1; i < kLogLevelNames.size(); ++i) {
    names += i + 1 < kLogLevelNames.size() ? ", " : " or ";
    names += kLogLevelNames[i];
  }
  return names;
}

// Sets the level to that of SIMWRIGHT_LOG. A wrong name logs warnings, of which this is the first.
bool ReadEnvironment() {
  const char* name = std::getenv("SIMWRIGHT_LOG");
  if (name == nullptr || *name == '\0') return false;
  try {
    SetLogLevel(LogLevelNamed(name));
  } catch (const Error& error) {
    SetLogLevel(LogLevel::kWarn);
    Log(LogLevel::kWarn, "core", "SIMWRIGHT_LOG: ", error.what());
  }
  return true;
}

}  // namespace

constinit std::atomic<LogLevel> lowest_log_level{LogLevel::kOff};

namespace {

[[maybe_unused]] const bool environment_sets_level = ReadEnvironment();

}  // namespace

const char* NameOf(LogLevel level) {
  return kLogLevelNames[static_cast<std::size_t>(level)];
}

LogLevel LogLevelNamed(const std::string& name) {
  for (std::size_t i = 0; i < kLogLevelNames.size(); ++i) {
    if (name == kLogLevelNames[i]) return static_cast<LogLevel>(i);
  }
  throw Error("is not a log level", name, "use " + LevelNames());
}

void SetLogLevel(LogLevel level) {
  lowest_log_level.store(level, std::memory_order_relaxed);
}

LogLevel CurrentLogLevel() {
  return lowest_log_level.load(std::memory_order_relaxed);
}

void SetLogSink(LogSink sink) {
  spdlog::sink_ptr next = sink ? std::make_shared<FunctionSink>(std::move(sink)) : StderrSink();
  SinkHolder& holder = Holder();
  const std::lock_guard lock(holder.mutex);
  holder.sink = std::move(next);
}

void WriteLog(LogLevel level, std::string_view module, std::string_view text) {
  if (level == LogLevel::kOff) return;
  std::string line(text);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  spdlog::sink_ptr sink;
  {
    SinkHolder& holder = Holder();
    const std::lock_guard lock(holder.mutex);
    sink = holder.sink;
  }
  spdlog::logger logger(std::string(module), std::move(sink));
  logger.set_level(spdlog::level::trace);
  logger.log(static_cast<spdlog::level::level_enum>(level), spdlog::string_view_t(line));
}

}  // namespace simwright::core
