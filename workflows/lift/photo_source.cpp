#include "workflows/lift/photo_source.h"

#include "core/files.h"
#include "core/image.h"

namespace simwright::workflows {
namespace {

constexpr std::uint64_t kMaxPhotoBytes = 1ull << 30;

}  // namespace

capture::CaptureSource SourceOf(const std::vector<std::filesystem::path>& photos) {
  capture::CaptureSource source;
  for (const std::filesystem::path& path : photos) {
    source.photos.push_back({path.filename().string(),
                             core::ExifFocalLength35mm(core::ReadFile(path, kMaxPhotoBytes))});
  }
  source.read = [&photos](int index) {
    return core::ReadImage(photos[static_cast<std::size_t>(index)]);
  };
  return source;
}

std::string NamedOr(const std::string& source, const std::vector<std::filesystem::path>& photos) {
  return source.empty() ? std::to_string(photos.size()) + " photos" : source;
}

}  // namespace simwright::workflows
