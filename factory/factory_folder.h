#pragma once

#include <filesystem>
#include <string>

namespace simwright::factory {

// The places of a factory's folder.
struct FactoryFolder {
  std::filesystem::path root;

  std::filesystem::path plan() const { return root / "plan.json"; }
  std::filesystem::path assets() const { return root / "assets"; }
  std::filesystem::path records() const { return root / "done"; }
  std::filesystem::path asset_record(const std::string& name) const {
    return records() / (name + ".json");
  }
  std::filesystem::path task_record(int part) const {
    return records() / ("tasks_" + Number(part) + ".json");
  }
  std::filesystem::path task_part(int part) const {
    return root / "parts" / ("tasks_" + Number(part) + ".json");
  }
  std::filesystem::path tasks() const { return root / "tasks.json"; }
  std::filesystem::path page() const { return root / "index.html"; }

 private:
  static std::string Number(int part) {
    const std::string digits = std::to_string(part);
    return std::string(digits.size() < 5 ? 5 - digits.size() : 0, '0') + digits;
  }
};

}  // namespace simwright::factory
