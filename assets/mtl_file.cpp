#include "assets/mtl_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

namespace simwright::assets {
namespace {

bool IsMtlSpace(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

std::string_view TrimmedMtlLine(std::string_view text) {
  while (!text.empty() && IsMtlSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsMtlSpace(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view TakeMtlWord(std::string_view* rest) {
  *rest = TrimmedMtlLine(*rest);
  size_t end = 0;
  while (end < rest->size() && !IsMtlSpace((*rest)[end])) ++end;
  const std::string_view word = rest->substr(0, end);
  rest->remove_prefix(end);
  *rest = TrimmedMtlLine(*rest);
  return word;
}

std::string LowerKeyword(std::string_view word) {
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::optional<float> Number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  float value = 0.0f;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

// Returns up to `most` numbers from the front of `rest`.
std::vector<float> TakeNumbers(std::string_view* rest, size_t most) {
  std::vector<float> numbers;
  while (numbers.size() < most) {
    std::string_view ahead = *rest;
    const std::optional<float> number = Number(TakeMtlWord(&ahead));
    if (!number) break;
    numbers.push_back(*number);
    *rest = ahead;
  }
  return numbers;
}

struct TextureStatement {
  std::string file;
  Eigen::Vector2f scale{1.0f, 1.0f}, offset{0.0f, 0.0f};
  bool clamp = false;
  int channel = 0;
  float strength = 1.0f;
  std::set<std::string> unread;
};

// Parses "[-option values]... name": the name is the rest, including spaces.
TextureStatement ReadTextureStatement(std::string_view rest) {
  TextureStatement statement;
  while (rest.starts_with('-')) {
    std::string_view ahead = rest;
    const std::string option = LowerKeyword(TakeMtlWord(&ahead));
    const auto two = [&](Eigen::Vector2f* target) {
      const std::vector<float> numbers = TakeNumbers(&ahead, 3);
      for (size_t k = 0; k < std::min<size_t>(2, numbers.size()); ++k) (*target)[k] = numbers[k];
    };
    if (option == "-s") {
      two(&statement.scale);
    } else if (option == "-o") {
      two(&statement.offset);
    } else if (option == "-clamp") {
      statement.clamp = LowerKeyword(TakeMtlWord(&ahead)) == "on";
    } else if (option == "-t") {
      TakeNumbers(&ahead, 3);
    } else if (option == "-mm") {
      const std::vector<float> range = TakeNumbers(&ahead, 2);
      if (range != std::vector<float>{0.0f, 1.0f}) statement.unread.insert("-mm");
    } else if (option == "-imfchan") {
      const std::string channel = LowerKeyword(TakeMtlWord(&ahead));
      statement.channel = channel == "g" ? 1 : channel == "b" ? 2 : 0;
    } else if (option == "-bm") {
      const std::vector<float> strength = TakeNumbers(&ahead, 1);
      if (!strength.empty()) statement.strength = strength[0];
    } else if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-type") {
      TakeMtlWord(&ahead);
    } else if (option == "-boost" || option == "-texres") {
      TakeNumbers(&ahead, 1);
    } else {
      break;  // a file whose name begins with '-'
    }
    rest = ahead;
  }
  statement.file = TrimmedMtlLine(rest);
  return statement;
}

class MtlReader {
 public:
  void Read(std::string_view line) {
    const std::string keyword = LowerKeyword(TakeMtlWord(&line));
    if (keyword == "newmtl") {
      Finish();
      current_.emplace();
      current_->name = line;
    } else if (current_) {
      ReadStatement(keyword, line);
    }
  }
  std::vector<MtlMaterial> Take() {
    Finish();
    return std::move(materials_);
  }

 private:
  void ReadStatement(const std::string& keyword, std::string_view rest) {
    static const std::set<std::string_view> kLook{
        "map_bump", "bump", "map_ks", "map_ke", "map_d",  "map_ns",      "disp",
        "decal",    "refl", "map_kn", "map_ps", "map_tr", "map_opacity", "map_rma"};
    if (keyword == "kd") {
      ReadDiffuse(rest);
    } else if (keyword == "d" || keyword == "tr") {
      if (LowerKeyword(rest).starts_with("-halo")) TakeMtlWord(&rest);
      const std::vector<float> value = TakeNumbers(&rest, 1);
      if (!value.empty()) (keyword == "d" ? dissolve_ : transparency_) = value[0];
    } else if (keyword == "map_kd" || keyword == "map_ka") {
      (keyword == "map_kd" ? diffuse_map_ : ambient_map_) = ReadTextureStatement(rest);
    } else if (keyword == "pm" || keyword == "pr") {
      const std::vector<float> value = TakeNumbers(&rest, 1);
      if (value.empty()) return;
      auto& share = keyword == "pm" ? current_->metallic : current_->roughness;
      share = std::clamp(value[0], 0.0f, 1.0f);
    } else if (keyword == "map_pm" || keyword == "map_pr" || keyword == "norm" ||
               keyword == "map_norm") {
      look_maps_[keyword == "map_norm" ? "norm" : keyword] = ReadTextureStatement(rest);
    } else if (kLook.contains(keyword)) {
      current_->unread.insert(keyword);
    }
  }

  void ReadDiffuse(std::string_view rest) {
    if (LowerKeyword(rest).starts_with("spectral") || LowerKeyword(rest).starts_with("xyz")) {
      current_->unread.insert("kd spectral or xyz");
      return;
    }
    const std::vector<float> values = TakeNumbers(&rest, 3);
    if (values.empty()) return;
    for (size_t k = 0; k < 3; ++k) {
      current_->diffuse[static_cast<int>(k)] =
          std::clamp(values[std::min(k, values.size() - 1)], 0.0f, 1.0f);
    }
    current_->has_diffuse = true;
  }

  void Finish() {
    if (!current_) return;
    MtlMaterial& material = *current_;
    if (dissolve_) {
      material.opacity = *dissolve_;
    } else if (transparency_) {
      material.opacity = 1.0f - *transparency_;
    }
    material.opacity = std::clamp(material.opacity, 0.0f, 1.0f);
    const auto& map = diffuse_map_ && !diffuse_map_->file.empty() ? diffuse_map_ : ambient_map_;
    if (map && !map->file.empty()) {
      material.texture = map->file;
      material.uv_scale = map->scale;
      material.uv_offset = map->offset;
      material.clamp = map->clamp;
      material.unread.insert(map->unread.begin(), map->unread.end());
    }
    PlaceLookMaps(&material);
    const auto same = std::find_if(materials_.begin(), materials_.end(),
                                   [&](const auto& m) { return m.name == material.name; });
    if (same != materials_.end()) {
      *same = material;
    } else {
      materials_.push_back(material);
    }
    current_.reset();
    dissolve_.reset();
    transparency_.reset();
    diffuse_map_.reset();
    ambient_map_.reset();
    look_maps_.clear();
  }

  // Takes the maps that lie as the texture does, or without one as the first map: a face has one
  // set of coordinates. The others are named as unread.
  void PlaceLookMaps(MtlMaterial* material) {
    bool placed = !material->texture.empty();
    for (const auto& [keyword, statement] : look_maps_) {
      if (statement.file.empty()) continue;
      const bool same =
          statement.scale == material->uv_scale && statement.offset == material->uv_offset;
      if (placed && !same) {
        material->unread.insert(keyword);
        continue;
      }
      if (!placed) {
        material->uv_scale = statement.scale;
        material->uv_offset = statement.offset;
        material->clamp = statement.clamp;
        placed = true;
      }
      MtlMap& map = keyword == "map_pm"   ? material->metallic_map
                    : keyword == "map_pr" ? material->roughness_map
                                          : material->normal_map;
      map = {statement.file, statement.channel, statement.strength};
      material->unread.insert(statement.unread.begin(), statement.unread.end());
    }
  }

  std::vector<MtlMaterial> materials_;
  std::optional<MtlMaterial> current_;
  std::optional<float> dissolve_, transparency_;
  std::optional<TextureStatement> diffuse_map_, ambient_map_;
  std::map<std::string, TextureStatement> look_maps_;  // map_pm, map_pr, norm
};

}  // namespace

std::vector<MtlMaterial> ReadMtl(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  MtlReader reader;
  while (!text.empty()) {
    // Old Macintosh files end lines with a carriage return alone.
    const size_t end = std::min(text.find_first_of("\n\r"), text.size());
    std::string_view line = TrimmedMtlLine(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    // A '#' begins a comment only as a separate word, because file names may contain it.
    if (!line.starts_with('#')) reader.Read(line);
  }
  return reader.Take();
}

}  // namespace simwright::assets
