#include "lift_quality_sheet.h"

#include <algorithm>
#include <cstdio>

namespace simwright::bench {
namespace fs = std::filesystem;
namespace {

constexpr int kSide = 140;

}  // namespace

QualitySheet::QualitySheet(const fs::path& file, bool resume) : file_(file) {
  if (file.empty()) return;
  strips_ = file;
  strips_ += ".strips";
  fs::create_directories(strips_);
  if (resume) return;
  for (const auto& entry : fs::directory_iterator(strips_)) {
    if (entry.path().extension() == ".png") fs::remove(entry.path());
  }
}

fs::path QualitySheet::StripFile(size_t object) const {
  char name[32];
  std::snprintf(name, sizeof(name), "%03zu.png", object);
  return strips_ / name;
}

bool QualitySheet::Has(size_t object) const {
  return fs::exists(StripFile(object));
}

void QualitySheet::Add(size_t object, const core::Image& input,
                       const std::vector<core::Image>& ours,
                       const std::vector<core::Image>& truth) const {
  std::vector<core::Image> pictures = {core::Resize(input, kSide, kSide)};
  for (const auto* views : {&ours, &truth}) {
    for (const core::Image& view : *views) pictures.push_back(core::Resize(view, kSide, kSide));
  }
  core::WritePng(StripFile(object),
                 core::ContactSheet(pictures, static_cast<int>(pictures.size())));
}

void QualitySheet::Write(size_t limit) const {
  if (!wanted()) return;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(strips_)) {
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  }
  if (files.empty()) return;
  std::sort(files.begin(), files.end());
  std::vector<core::Image> strips;
  const size_t count = std::min(limit, files.size());
  for (size_t i = 0; i < count; ++i) {
    strips.push_back(core::ReadImage(files[i * files.size() / count]));
  }
  core::WritePng(file_, core::ContactSheet(strips, 1));
}

}  // namespace simwright::bench
