#include "factory/factory_record.h"

#include <cstdint>
#include <utility>

#include "core/error.h"
#include "core/json.h"

namespace simwright::factory {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMostRecordBytes = 4u << 20;
constexpr char kDamagedRemedy[] = "delete the file: the factory then makes its part again";

}  // namespace

std::string AssetRecordText(const AssetRecord& record) {
  core::OrderedJson json;
  json["name"] = record.name;
  json["source"] = record.source;
  json["category"] = record.category;
  json["folder"] = record.folder;
  json["variants"] = record.variants;
  json["failures"] = core::OrderedJson::array();
  for (const FactoryFailure& failure : record.failures) {
    json["failures"].push_back({{"reason", failure.reason}, {"changed", failure.changed}});
  }
  json["findings"] = core::OrderedJson::array();
  for (const core::Finding& finding : record.findings) {
    json["findings"].push_back({{"code", finding.code}, {"sentence", finding.sentence}});
  }
  json["seconds"] = record.seconds;
  json["cpu_seconds"] = record.cpu_seconds;
  return core::JsonText(json, core::InvalidUtf8::kReplace);
}

std::string TaskPartText(const TaskPartRecord& record) {
  core::OrderedJson json;
  json["part"] = record.part;
  json["asked"] = record.asked;
  json["made"] = record.made;
  json["assets"] = record.assets;
  json["reason"] = record.reason;
  json["seconds"] = record.seconds;
  json["cpu_seconds"] = record.cpu_seconds;
  return core::JsonText(json, core::InvalidUtf8::kReplace);
}

std::optional<AssetRecord> ReadAssetRecord(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  const core::JsonDocument document =
      core::JsonDocument::Read(file, kMostRecordBytes, kDamagedRemedy);
  const core::JsonField root = document.root();
  AssetRecord record;
  record.name = root["name"].Text();
  record.source = root["source"].Text();
  record.category = root["category"].Text();
  record.folder = root["folder"].Text();
  record.variants = root["variants"].Texts();
  for (const core::JsonField& failure : root["failures"].Elements()) {
    record.failures.push_back({failure["reason"].Text(), failure["changed"].Text()});
  }
  for (const core::JsonField& finding : root["findings"].Elements()) {
    record.findings.push_back({finding["code"].Text(), core::Severity::kWarning, record.name,
                               finding["sentence"].Text(), 0.0});
  }
  record.seconds = root["seconds"].NumberWithin(0.0);
  record.cpu_seconds = root["cpu_seconds"].NumberWithin(0.0);
  return record;
}

std::optional<TaskPartRecord> ReadTaskPart(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  const core::JsonDocument document =
      core::JsonDocument::Read(file, kMostRecordBytes, kDamagedRemedy);
  const core::JsonField root = document.root();
  TaskPartRecord record;
  record.part = root["part"].Int(0);
  record.asked = root["asked"].Int(0);
  record.made = root["made"].Int(0);
  record.assets = root["assets"].Texts();
  record.reason = root["reason"].Text();
  record.seconds = root["seconds"].NumberWithin(0.0);
  record.cpu_seconds = root["cpu_seconds"].NumberWithin(0.0);
  return record;
}

}  // namespace simwright::factory
