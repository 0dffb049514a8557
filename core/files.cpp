#include "core/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <random>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "core/error.h"

namespace simwright::core {
namespace fs = std::filesystem;
namespace {

// Returns a random word. Processes on several machines, or in several containers, may have the same
// number and write into the same folder.
std::string RandomWord() {
  std::random_device device;
  std::ostringstream word;
  word << std::hex << device();
  return word.str();
}

// Returns a sibling name of `path` that no other process or thread uses.
fs::path SiblingName(const fs::path& path, const char* purpose) {
  static std::atomic<int> counter{0};
  static const std::string word = RandomWord();
  return path.parent_path() /
         ("." + path.filename().string() + "." + purpose + "-" + std::to_string(getpid()) + "-" +
          word + "-" + std::to_string(counter++));
}

fs::path Normalised(const fs::path& path) {
  fs::path absolute = fs::absolute(path).lexically_normal();
  // "dir/" has an empty file name: use the folder itself.
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

// Returns true if `path` is `folder` or below it; both without links.
bool IsWithin(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

// Returns why a folder may not be replaced as an output; empty if it may.
std::string FaultOfReplacing(const fs::path& folder) {
  std::error_code code;
  const fs::path real = fs::weakly_canonical(folder, code);
  const auto contains = [&](const fs::path& path) {
    return IsWithin(fs::weakly_canonical(path, code), real);
  };
  if (contains(fs::current_path(code))) return "the current folder is this one or in it";
  const char* const home = std::getenv("HOME");
  const bool has_home = home != nullptr && *home != '\0';
  if (has_home && contains(home)) return "the home folder is this one or in it";
  if (fs::exists(real / ".git", code)) return "this folder is a repository";
  return "";
}

[[noreturn]] void ThrowErrno(const std::string& what, const fs::path& path) {
  const int code = errno;
  throw Error(what + ": " + std::strerror(code), path.string(),
              code == ENOSPC ? "free some space and run it again"
                             : "check that the place exists and may be written");
}

}  // namespace

std::string ReadFile(const fs::path& path, std::uint64_t limit) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) throw Error("no such file", path.string());
  if (!fs::is_regular_file(status)) throw Error("this is not a file", path.string());
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) ThrowErrno("cannot open", path);
  std::string bytes;
  const std::uintmax_t expected = fs::file_size(path, code);
  if (!code && expected > limit) {
    close(file);
    throw Error("the file is larger than " + std::to_string(limit >> 20) + " MiB", path.string());
  }
  if (!code) bytes.reserve(expected);
  char buffer[1 << 16];
  for (;;) {
    const ssize_t count = read(file, buffer, sizeof(buffer));
    if (count == 0) break;
    if (count < 0) {
      if (errno == EINTR) continue;
      close(file);
      ThrowErrno("cannot read", path);
    }
    bytes.append(buffer, static_cast<size_t>(count));
    if (bytes.size() > limit) {
      close(file);
      throw Error("the file is larger than " + std::to_string(limit >> 20) + " MiB", path.string());
    }
  }
  close(file);
  return bytes;
}

void WriteFile(const fs::path& path, std::string_view bytes) {
  const fs::path beside = SiblingName(Normalised(path), "part");
  const int file = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file < 0) ThrowErrno("cannot write", path);
  const auto fail = [&] {
    const int code = errno;
    close(file);
    unlink(beside.c_str());
    errno = code;
    ThrowErrno("cannot write", path);
  };
  while (!bytes.empty()) {
    const ssize_t count = write(file, bytes.data(), bytes.size());
    if (count < 0) {
      if (errno == EINTR) continue;
      fail();
    }
    bytes.remove_prefix(static_cast<size_t>(count));
  }
  if (close(file) != 0 || rename(beside.c_str(), path.c_str()) != 0) {
    const int code = errno;
    unlink(beside.c_str());
    errno = code;
    ThrowErrno("cannot write", path);
  }
}

StagedFile::StagedFile(const fs::path& target)
    : target_(Normalised(target)), staging_(SiblingName(target_, "part")) {}

StagedFile::~StagedFile() {
  std::error_code code;
  fs::remove(staging_, code);
}

void StagedFile::Commit() {
  if (rename(staging_.c_str(), target_.c_str()) != 0) ThrowErrno("cannot write", target_);
}

fs::path ResolveInside(const fs::path& root, const fs::path& relative) {
  const fs::path real_root = fs::weakly_canonical(root);
  const fs::path resolved = fs::weakly_canonical(real_root / relative);
  if (!IsWithin(resolved, real_root)) {
    throw Error("the path leads outside " + root.string(), relative.string(),
                "only files inside that folder are read");
  }
  return resolved;
}

void RequireReplaceable(const fs::path& folder) {
  const std::string fault = FaultOfReplacing(Normalised(folder));
  if (fault.empty()) return;
  throw Error(fault + " and is not replaced", folder.string(), "choose another place");
}

StagedFolder::StagedFolder(const fs::path& target, bool force)
    : target_(Normalised(target)), force_(force) {
  std::error_code code;
  if (fs::exists(target_, code)) {
    if (!force) {
      throw Error("the output exists already", target.string(),
                  "choose another place or replace it with --force");
    }
    if (!fs::is_directory(target_)) throw Error("this is not a folder", target.string());
    RequireReplaceable(target_);
  }
  for (fs::path parent = target_.parent_path(); !fs::exists(parent, code);
       parent = parent.parent_path()) {
    created_parent_ = parent;
  }
  fs::create_directories(target_.parent_path(), code);
  staging_ = SiblingName(target_, "part");
  if (code || !fs::create_directory(staging_, code)) {
    const std::string reason = code.message();
    if (!created_parent_.empty()) fs::remove_all(created_parent_, code);
    throw Error("cannot create the output folder: " + reason, target.string(),
                "check that the place exists and may be written");
  }
}

StagedFolder::~StagedFolder() {
  if (committed_) return;
  std::error_code code;
  fs::remove_all(staging_, code);
  // Remove only folders that this object created, and only if they are still empty.
  if (!created_parent_.empty()) {
    for (fs::path parent = target_.parent_path(); fs::is_empty(parent, code) && !code;
         parent = parent.parent_path()) {
      fs::remove(parent, code);
      if (parent == created_parent_) break;
    }
  }
}

void StagedFolder::Commit() {
  std::error_code code;
  fs::path old;
  if (fs::exists(target_)) {
    if (!force_) {
      throw Error("the output exists already", target_.string(),
                  "choose another place or replace it with --force");
    }
    old = SiblingName(target_, "old");
    fs::rename(target_, old, code);
    if (code) throw Error("cannot replace: " + code.message(), target_.string());
  }
  fs::rename(staging_, target_, code);
  if (code) {
    const std::string reason = code.message();
    if (!old.empty()) fs::rename(old, target_, code);
    throw Error("cannot move the result into place: " + reason, target_.string());
  }
  committed_ = true;
  if (!old.empty()) fs::remove_all(old, code);
}

void RemoveStagingLeftovers(const fs::path& folder) {
  std::vector<fs::path> leftovers;
  std::error_code code;
  for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end;
       at.increment(code)) {
    const std::string name = at->path().filename().string();
    if (name.front() != '.' || name.find(".part-") == std::string::npos) continue;
    leftovers.push_back(at->path());
    at.disable_recursion_pending();
  }
  for (const fs::path& path : leftovers) fs::remove_all(path, code);
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "simwright_XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) ThrowErrno("cannot create a temporary folder", pattern);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code code;
  fs::remove_all(path_, code);
}

}  // namespace simwright::core
