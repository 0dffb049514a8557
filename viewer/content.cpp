#include "viewer/content.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "core/content_hash.h"
#include "core/error.h"

namespace simwright::viewer {
namespace fs = std::filesystem;

core::OrderedJson Content::Bodies(int world) {
  const core::OrderedJson& entry = document_.manifest["worlds"][static_cast<std::size_t>(world)];
  return entry.contains("bodies") ? entry["bodies"] : core::OrderedJson::array();
}

Timeline Content::Replay(int) {
  throw core::Error("nothing can be replayed here");
}

core::OrderedJson Content::Charts() {
  const core::OrderedJson& manifest = document_.manifest;
  return manifest.contains("charts") ? manifest["charts"] : core::OrderedJson::array();
}

namespace {

std::string FileState(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  const auto time = fs::last_write_time(file, error).time_since_epoch().count();
  return file.string() + "\n" + (error ? "missing" : std::to_string(size)) + " " +
         std::to_string(time) + "\n";
}

}  // namespace

std::string FingerprintOf(const std::string& path,
                          const std::function<bool(const std::string&)>& skipped, int most) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return core::ContentHash(FileState(path));
  std::vector<std::string> states;
  fs::recursive_directory_iterator entries(path, fs::directory_options::skip_permission_denied,
                                           error);
  for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
    std::error_code fault;
    if (!entries->is_regular_file(fault)) continue;
    if (skipped && skipped(entries->path().filename().string())) continue;
    states.push_back(FileState(entries->path()));
    if (static_cast<int>(states.size()) >= most) break;
  }
  std::sort(states.begin(), states.end());
  std::string text;
  for (const std::string& state : states) text += state;
  return core::ContentHash(text);
}

}  // namespace simwright::viewer
