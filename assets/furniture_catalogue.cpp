#include "assets/furniture_catalogue.h"

#include <zip.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "core/foreign_content.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr zip_uint64_t kMaxEntryBytes = 512ull << 20;
constexpr zip_int64_t kMaxEntries = 20'000;

using Properties = std::map<int, std::map<std::string, std::string>>;

// Decodes Java properties: "key#N=value", latin-1 with \uXXXX escapes, '#' and '!' start comments.
std::string UnescapedText(const std::string& text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 >= text.size()) {
      result += text[i];
    } else if (text[i + 1] == 'u' && i + 5 < text.size()) {
      const long code = std::strtol(text.substr(i + 2, 4).c_str(), nullptr, 16);
      result += code < 0x80 ? static_cast<char>(code) : '_';
      i += 5;
    } else {
      result += text[++i];
    }
  }
  return result;
}

Properties ParseProperties(const std::string& text) {
  Properties properties;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    const size_t equals = line.find('=');
    const size_t hash = line.find('#');
    if (equals == std::string::npos || hash == std::string::npos || hash == 0 || hash > equals) {
      continue;
    }
    const int index = std::atoi(line.substr(hash + 1, equals - hash - 1).c_str());
    properties[index][line.substr(0, hash)] = UnescapedText(line.substr(equals + 1));
  }
  return properties;
}

std::string WithoutLeadingSlash(std::string entry) {
  while (!entry.empty() && entry[0] == '/') entry.erase(0, 1);
  return entry;
}

bool LeavesFolder(const std::string& entry) {
  const fs::path path = fs::path(entry).lexically_normal();
  return entry.empty() || entry[0] == '/' || entry.find('\\') != std::string::npos ||
         (!path.empty() && *path.begin() == "..");
}

CataloguePiece PieceFrom(int index, std::map<std::string, std::string> values) {
  CataloguePiece piece;
  piece.id = values["id"].empty() ? "#" + std::to_string(index) : values["id"];
  piece.name = values["name"];
  piece.category = values["category"];
  piece.creator = values["creator"];
  piece.license = values["license"];
  piece.model = WithoutLeadingSlash(values["model"]);
  const char* const kSizes[] = {"width", "depth", "height"};
  for (int k = 0; k < 3; ++k) piece.size_m[k] = 0.01 * std::atof(values[kSizes[k]].c_str());
  std::istringstream rotation(values["modelRotation"]);
  Eigen::Matrix3d m;
  bool complete = true;
  for (int i = 0; i < 9; ++i) complete = complete && static_cast<bool>(rotation >> m(i / 3, i % 3));
  if (complete) piece.model_rotation = m;
  return piece;
}

// Throws for a file that is not a zip, naming its content (a Git LFS pointer, a web page).
void RequireZip(const fs::path& path) {
  std::array<char, 1024> bytes{};
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), static_cast<size_t>(in.gcount()));
  const auto foreign = core::FindForeignContent(head);
  if (!foreign || head.starts_with("PK")) return;
  throw core::Error(foreign->what, path.string(), foreign->remedy);
}

}  // namespace

struct FurnitureCatalogue::Zip {
  zip_t* archive = nullptr;
  std::vector<std::string> names;
  mutable std::mutex mutex;  // libzip's archives are not thread-safe
  ~Zip() {
    if (archive != nullptr) zip_discard(archive);
  }

  std::string Read(zip_uint64_t index, const std::string& where) const {
    const std::lock_guard lock(mutex);
    zip_stat_t stat;
    if (zip_stat_index(archive, index, 0, &stat) != 0 || !(stat.valid & ZIP_STAT_SIZE)) {
      throw core::Error("an entry of the catalogue is damaged", where);
    }
    if (stat.size > kMaxEntryBytes) {
      throw core::Error("an entry of the catalogue unpacks to more than 512 MiB", where);
    }
    zip_file_t* file = zip_fopen_index(archive, index, 0);
    if (file == nullptr) throw core::Error("an entry of the catalogue is damaged", where);
    std::string bytes(stat.size, '\0');
    const zip_int64_t count = zip_fread(file, bytes.data(), stat.size);
    const int closed = zip_fclose(file);
    if (count != static_cast<zip_int64_t>(stat.size) || closed != 0) {
      throw core::Error("an entry of the catalogue is damaged", where);
    }
    return bytes;
  }
};

FurnitureCatalogue::FurnitureCatalogue(const fs::path& path)
    : zip_(std::make_unique<Zip>()), path_(path) {
  if (!fs::exists(path)) throw core::Error("no such file", path.string());
  RequireZip(path);
  int code = 0;
  zip_->archive = zip_open(path.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &code);
  if (zip_->archive == nullptr) {
    throw core::Error("this is not a furniture catalogue (a zip)", path.string());
  }
  const zip_int64_t count = zip_get_num_entries(zip_->archive, 0);
  if (count > kMaxEntries) throw core::Error("the catalogue has too many entries", path.string());
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(zip_->archive, static_cast<zip_uint64_t>(i), 0);
    zip_->names.emplace_back(name == nullptr ? "" : name);
    if (LeavesFolder(zip_->names.back())) {
      throw core::Error(
          "an entry of the catalogue leads outside its folder: '" + zip_->names.back() + "'",
          path.string(), "do not use this file");
    }
  }
  const auto entry =
      std::find(zip_->names.begin(), zip_->names.end(), "PluginFurnitureCatalog.properties");
  if (entry == zip_->names.end()) {
    throw core::Error("holds no PluginFurnitureCatalog.properties", path.string(),
                      "use a .sh3f catalogue of Sweet Home 3D");
  }
  const auto at = static_cast<zip_uint64_t>(entry - zip_->names.begin());
  for (auto& [index, values] : ParseProperties(zip_->Read(at, path.string()))) {
    CataloguePiece piece = PieceFrom(index, std::move(values));
    if (!piece.model.empty()) pieces_.push_back(std::move(piece));
  }
}

FurnitureCatalogue::~FurnitureCatalogue() = default;

fs::path FurnitureCatalogue::Extract(const CataloguePiece& piece, const fs::path& folder) const {
  const std::string directory = fs::path(piece.model).parent_path().string();
  bool found = false;
  for (size_t i = 0; i < zip_->names.size(); ++i) {
    const fs::path entry = zip_->names[i];
    const bool is_model = entry == piece.model;
    const bool beside = !directory.empty() && entry.parent_path() == directory;
    if ((!is_model && !beside) || entry.filename().empty()) continue;
    const std::string bytes = zip_->Read(i, path_.string() + ":" + entry.string());
    core::WriteFile(folder / entry.filename(), bytes);
    found = found || is_model;
  }
  if (!found) {
    throw core::Error("the catalogue names a model that it does not contain", piece.model);
  }
  return folder / fs::path(piece.model).filename();
}

}  // namespace simwright::assets
