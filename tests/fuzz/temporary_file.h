#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace simwright::fuzz {

// A file of one fuzzing process, alone in its folder, written anew for each input.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name) {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "simwright_fuzz_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) std::abort();
    folder_ = pattern;
    path_ = folder_ / name;
  }
  ~TemporaryFile() {
    std::error_code code;
    std::filesystem::remove_all(folder_, code);
  }

  const std::filesystem::path& Write(const void* data, std::size_t size) const {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    if (file == nullptr) std::abort();
    if (std::fwrite(data, 1, size, file) != size) std::abort();
    std::fclose(file);
    return path_;
  }

 private:
  std::filesystem::path folder_, path_;
};

}  // namespace simwright::fuzz
